"""gmds batch as a process of its own: interrupted it ends at once, killed it leaves nothing that the next run minds."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import batches
import pytest

import gmds
from geodesics import write_mesh
from gmds.batch import consecutive, local_client, match_collection
from gmds.batch import workers as engine
from gmds.batch.starting import local_cluster

dask = pytest.importorskip("dask", reason="the extra `batch` is not installed")
pytest.importorskip("distributed", reason="the extra `batch` is not installed")

CODE = (
    "import signal, sys\n"
    "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # a parent in the background ignores it
    "from gmds.cli import main\n"
    "main(sys.argv[1:])"
)


@pytest.fixture(scope="module")
def meshes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("meshes")
    for name, mesh in batches.collection().items():
        write_mesh(mesh, folder / f"{name}.ply")
    return folder


@pytest.fixture(scope="module")
def undisturbed(meshes: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    out = tmp_path_factory.mktemp("done")
    with local_client(2) as client:
        assert not match_collection(meshes, out, pairs=consecutive, client=client).failed
    return batches.tree(out)


def begun(meshes: Path, out: Path, there: Callable[[int], Any] | None = None) -> subprocess.Popen[str]:
    """A batch in a process group of its own, from when its first map, or what is asked for, is `there`."""
    arguments = ["batch", meshes, "-o", out, "--pairs", "consecutive", "--workers", 2]
    child = subprocess.Popen(
        [sys.executable, "-c", CODE, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    until = time.monotonic() + 120
    seen = there or (lambda _: list(out.glob("pairs/*.npz")))
    while not seen(child.pid) and child.poll() is None and time.monotonic() < until:
        time.sleep(0.05)
    return child


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_what_is_done_is_kept(
    number: signal.Signals, meshes: Path, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    with begun(meshes, tmp_path) as child:
        started = time.monotonic()
        # Ctrl-C in a terminal reaches the workers as well
        (os.killpg if number == signal.SIGINT else os.kill)(child.pid, number)
        try:
            output, errors = child.communicate(timeout=60)
        finally:
            child.kill()
        seconds = time.monotonic() - started
    if number == signal.SIGKILL:
        time.sleep(0.5)  # the workers notice
    else:
        assert child.returncode == 130, errors
        assert seconds < 10  # 1 when nothing else runs
        assert errors.splitlines()[-1] == "gmds: interrupted" and output == ""  # after what the log says every 10 s
        assert "missing" in (tmp_path / "summary.csv").read_text()
    kept = batches.tree(tmp_path)
    assert all(undisturbed[name] == kept[name] for name in kept if name.startswith(("pairs", "shapes")))
    with local_client(1) as client:
        again = match_collection(meshes, tmp_path, pairs=consecutive, client=client)
    assert any(pair.kept for pair in again.pairs)
    assert batches.tree(tmp_path) == undisturbed and not list(tmp_path.glob("*/.*"))


def test_an_interrupt_while_workers_start_is_one_line(meshes: Path, tmp_path: Path) -> None:
    psutil = pytest.importorskip("psutil")
    with begun(meshes, tmp_path, lambda pid: psutil.Process(pid).children(recursive=True)[2:]) as child:
        time.sleep(0.3)
        os.killpg(child.pid, signal.SIGINT)
        try:
            output, errors = child.communicate(timeout=60)
        finally:
            child.kill()
    assert child.returncode == 130 and output == ""
    assert errors.split("\n")[-2] == "gmds: interrupted" and "Traceback" not in errors, errors


def test_workers_that_are_killed_as_they_start_are_replaced(
    meshes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine, "LOST_AFTER", 3)
    monkeypatch.setattr(engine, "LOOK_EVERY", 0.5)
    monkeypatch.setattr(engine, "local_cluster", local_cluster)  # its workers are spawned: slowly enough to be killed
    with dask.config.set({"distributed.worker.multiprocessing-method": "spawn"}), local_client(1) as client:
        (first,) = batches.worker_pids(client)
        os.kill(first, signal.SIGKILL)
        until = time.monotonic() + 60
        while time.monotonic() < until:
            if young := set(batches.worker_pids(client)) - {first}:
                os.kill(young.pop(), signal.SIGKILL)
                break
            time.sleep(0.01)
        assert not match_collection(meshes, tmp_path, pairs=[("s0", "s1")], client=client).failed
