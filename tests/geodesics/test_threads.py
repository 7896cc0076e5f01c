"""Matching runs BLAS on one thread, restores the number of threads, and gives the same whatever it is."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import scipy.linalg
from places import ROOT
from threadpoolctl import threadpool_info, threadpool_limits

from geodesics.caching import cached_property
from geodesics.threads import both, on_one_blas_thread, one_blas_thread, side_by_side, spare
from geodesics.threads import threads as allowed


def threads() -> set[int]:
    scipy.linalg.inv(np.eye(2))
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def test_one_thread_inside_and_the_former_number_after() -> None:
    with threadpool_limits(2, user_api="blas"):
        before = threads()
        with one_blas_thread():
            assert threads() == {1}
            with one_blas_thread():
                assert threads() == {1}
            assert threads() == {1}
        assert threads() == before


def test_threads_come_back_after_an_error() -> None:
    @on_one_blas_thread
    def fails() -> None:
        assert threads() == {1}
        raise KeyError

    with threadpool_limits(2, user_api="blas"):
        before = threads()
        with pytest.raises(KeyError):
            fails()
        assert threads() == before


def test_a_map_does_not_depend_on_the_number_of_threads() -> None:
    code = (
        "import sys; sys.path.insert(0, 'tests/support')\n"
        "from generated_shapes import bumpy_sphere, moved\nimport gmds\n"
        "answer = gmds.match(bumpy_sphere(3), moved(bumpy_sphere(3, height=0.2)))\n"
        "sys.stdout.buffer.write(answer.points.face.tobytes() + answer.points.barycentric.tobytes())\n"
    )
    digests = set()
    for count in ("1", "2"):
        variables = dict.fromkeys(
            ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "GMDS_THREADS"), count
        )
        done = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, **variables, "PYTHONHASHSEED": count},
            cwd=ROOT,
            capture_output=True,
            check=True,
        )
        digests.add(hashlib.sha256(done.stdout).hexdigest())
    assert len(digests) == 1


@pytest.mark.parametrize("count", ["1", "3"])
def test_side_by_side_keeps_the_order_and_the_errors(monkeypatch: pytest.MonkeyPatch, count: str) -> None:
    monkeypatch.setenv("GMDS_THREADS", count)
    assert allowed() == int(count)
    assert side_by_side(lambda x: x * x, range(20)) == [x * x for x in range(20)]
    assert side_by_side(str, []) == []
    told: list[float] = []
    side_by_side(str, range(4), told.append)
    assert told == [0.25, 0.5, 0.75, 1.0]
    with pytest.raises(ZeroDivisionError):
        side_by_side(lambda x: 1 // x, [1, 0, 2])


def test_a_number_of_threads_that_is_none_is_not_heeded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GMDS_THREADS", raising=False)
    default = allowed()
    for word in ("0", "-2", "many", ""):
        monkeypatch.setenv("GMDS_THREADS", word)
        assert allowed() == default >= 1


class Both:
    """Its property is done when two objects are at it at the same time."""

    barrier = threading.Barrier(2)

    def __init__(self) -> None:
        self.times = 0

    @cached_property
    def met(self) -> int:
        """Computed once."""
        self.times += 1
        return self.barrier.wait(timeout=20)


def test_cached_properties_of_two_objects_are_computed_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GMDS_THREADS", "2")
    both = [Both(), Both()]
    assert sorted(side_by_side(lambda one: one.met, both)) == [0, 1]
    assert [one.met for one in both] == [vars(one)["met"] for one in both]
    assert [one.times for one in both] == [1, 1]
    assert Both.met.__doc__ == "Computed once."


@pytest.mark.parametrize("count", ["1", "2"])
def test_what_progress_raises_ends_the_work(monkeypatch: pytest.MonkeyPatch, count: str) -> None:
    monkeypatch.setenv("GMDS_THREADS", count)
    done: list[int] = []

    def work(number: int) -> None:
        time.sleep(0.02)
        done.append(number)

    def stop(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        side_by_side(work, range(100), stop)
    assert len(done) < 20


def test_threads_have_no_threads_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GMDS_THREADS", "3")

    def who(_: int) -> int:
        time.sleep(0.01)
        return threading.get_ident()

    inside = side_by_side(lambda i: {threading.get_ident(), *side_by_side(who, range(6))}, range(6))
    assert all(len(seen) == 1 for seen in inside) and len(set.union(*inside)) == 3
    assert len(set(side_by_side(who, range(6)))) == 3  # the caller may use them again


@pytest.mark.parametrize("count", ["1", "2"])
def test_two_functions_are_called_at_the_same_time_where_a_thread_is_to_spare(
    monkeypatch: pytest.MonkeyPatch, count: str
) -> None:
    monkeypatch.setenv("GMDS_THREADS", count)
    barrier = threading.Barrier(int(count))

    def fails() -> int:
        barrier.wait(timeout=20)
        raise KeyError

    def meets() -> int:
        barrier.wait(timeout=20)
        return spare()

    assert both(meets, meets) == (int(count), 1)  # the other thread has no others to spare
    for two in ((fails, meets), (meets, fails)):
        with pytest.raises(KeyError):
            both(*two)
        barrier.reset()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_process_that_was_forked_has_threads_of_its_own() -> None:
    code = (
        "import os\nfrom geodesics.threads import side_by_side\n"
        "side_by_side(abs, [1, -2])\n"
        "child = os.fork()\n"
        "if child == 0:\n    os._exit(0 if side_by_side(abs, [1, -2]) == [1, 2] else 1)\n"
        "os._exit(os.waitpid(child, 0)[1])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "GMDS_THREADS": "2"}, cwd=ROOT, timeout=60)
    assert done.returncode == 0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_process_that_was_forked_does_not_wait_for_a_lock_of_another_thread() -> None:
    code = (
        "import os, threading\nfrom geodesics import threads\n"
        "threads._lock.acquire()\n"
        "threads._running = 1\n"  # as if another thread had been about to set the number of BLAS threads
        "child = os.fork()\n"
        "if child == 0:\n"
        "    with threads.one_blas_thread():\n        os._exit(threads._running != 1)\n"
        "os._exit(os.waitpid(child, 0)[1])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, timeout=60)
    assert done.returncode == 0


@pytest.mark.parametrize("before", ["side_by_side(abs, [1, -2])", "pass"], ids=["threads-kept", "none-yet"])
def test_a_thread_that_outlives_the_script_does_its_work(before: str) -> None:
    code = (
        "import threading, time\nfrom geodesics.threads import both, side_by_side\n"
        f"{before}\n"
        "def late():\n"
        "    threading.main_thread().join()\n    time.sleep(0.2)\n"
        "    print(side_by_side(abs, [1, -2]), both(int, str), flush=True)\n"
        "threading.Thread(target=late).start()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "GMDS_THREADS": "2"},
        cwd=ROOT,
        timeout=60,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "[1, 2] (0, '')\n", "")
