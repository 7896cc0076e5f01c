"""Linear algebra on one thread, and independent work on several.

Threads of BLAS make small products slower, and the last digits depend on their number. On two shared cores OpenBLAS
took three to five times the CPU time of one thread to match two meshes.
"""

from __future__ import annotations

import functools
import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, wait
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from geodesics.moved_paths import names_moved

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor

P = ParamSpec("P")
R = TypeVar("R")
S = TypeVar("S")
T = TypeVar("T")

_own = threading.local()
_lock = threading.Lock()
_running = 0
_limits: threadpool_limits | None = None


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """BLAS on one thread inside the block; the former number returns when the last such block of the process ends."""
    global _running, _limits
    with _lock:
        _running += 1
        if _running == 1:
            _limits = threadpool_limits(1, user_api="blas")
    try:
        yield
    finally:
        with _lock:
            _running -= 1
            if _running == 0 and _limits is not None:
                _limits.restore_original_limits()


def on_one_blas_thread(function: Callable[P, R]) -> Callable[P, R]:
    """The function, run inside `one_blas_thread`."""

    @functools.wraps(function)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        with one_blas_thread():
            return function(*args, **kwargs)

    return limited


def threads() -> int:
    """How many threads may be used: the environment variable GMDS_THREADS, or else the processors of this process."""
    given = os.environ.get("GMDS_THREADS", "")
    if given.isdigit() and int(given) > 0:
        return int(given)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def side_by_side(
    function: Callable[[S], R], items: Iterable[S], progress: Callable[[float], None] | None = None
) -> list[R]:
    """The function of each item, in their order, on `threads()` threads; results do not depend on their number.

    A function that runs on one of these threads uses no others. `progress(share)` is called on the calling thread as
    results arrive. An exception, of the function or of `progress`, ends the work, and items that have not begun are
    left out. The threads are kept: starting two takes as long as a search for 700 closest points.
    """
    given = list(items)
    running = [] if len(given) < 2 else _begun([functools.partial(function, one) for one in given])
    results = (one.result() for one in running) if running else map(function, given)
    try:
        return [_told(result, i, given, progress) for i, result in enumerate(results, start=1)]
    except BaseException:
        _ended(running)
        raise


def both(first: Callable[[], R], second: Callable[[], S]) -> tuple[R, S]:
    """What two functions return: the second on another thread, if one is to spare, while this one calls the first."""
    other = _begun([second])
    try:
        return first(), other[0].result() if other else second()
    except BaseException:
        _ended(other)
        raise


def spare() -> int:
    """How many threads what is called here may use: one, on a thread of `side_by_side`."""
    return 1 if getattr(_own, "busy", False) else threads()


def _told(result: R, number: int, of: list[Any], progress: Callable[[float], None] | None) -> R:
    if progress is not None:
        progress(number / len(of))
    return result


def _begun(calls: Sequence[Callable[[], R]]) -> list[Future[R]]:
    """The calls, begun on other threads; none where there are none to spare, or where Python is about to end."""
    if spare() == 1:
        return []
    running: list[Future[R]] = []
    try:
        for call in calls:
            running.append(_pool(threads()).submit(call))
    except RuntimeError:  # after the main thread has ended no thread can be started, but what runs may go on
        _ended(running)
        return []
    return running


def _ended(running: Sequence[Future[Any]]) -> None:
    """Waits for what runs, and leaves out what has not begun."""
    for one in running:
        one.cancel()
    wait(running)


@functools.cache
def _pool(count: int) -> ThreadPoolExecutor:
    from concurrent.futures import ThreadPoolExecutor  # cannot be imported where Python is about to end

    return ThreadPoolExecutor(count, thread_name_prefix="geodesics", initializer=_make_busy)


def _after_fork() -> None:
    """A child has none of the threads, and a lock that one of them held is never let go there."""
    global _lock, _running, _limits
    _lock, _running, _limits = threading.Lock(), 0, None
    _pool.cache_clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def _make_busy() -> None:
    _own.busy = True


__getattr__ = names_moved(__name__, ("geodesics.caching",))
