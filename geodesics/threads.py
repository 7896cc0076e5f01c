"""Linear algebra on one thread, and independent work on several.

Threads of BLAS make small products slower, and the last digits depend on their number. On two shared cores OpenBLAS
took three to five times the CPU time of one thread to match two meshes.
"""

from __future__ import annotations

import functools
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from geodesics.moved_paths import names_moved

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
    if spare() == 1 or len(given) < 2:
        return [_told(result, i, given, progress) for i, result in enumerate(map(function, given), start=1)]
    pool = _pool(threads())
    running = [pool.submit(function, one) for one in given]
    try:
        return [_told(one.result(), i, given, progress) for i, one in enumerate(running, start=1)]
    except BaseException:
        for one in running:
            one.cancel()
        wait(running)
        raise


def both(first: Callable[[], R], second: Callable[[], S]) -> tuple[R, S]:
    """What two functions return: the second on another thread, if one is to spare, while this one calls the first."""
    if spare() == 1:
        return first(), second()
    other = _pool(threads()).submit(second)
    try:
        return first(), other.result()
    except BaseException:
        other.cancel()
        wait([other])
        raise


def spare() -> int:
    """How many threads what is called here may use: one, on a thread of `side_by_side`."""
    return 1 if getattr(_own, "busy", False) else threads()


def _told(result: R, number: int, of: list[Any], progress: Callable[[float], None] | None) -> R:
    if progress is not None:
        progress(number / len(of))
    return result


@functools.cache
def _pool(count: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, thread_name_prefix="geodesics", initializer=_make_busy)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # the child has none of its threads


def _make_busy() -> None:
    _own.busy = True


__getattr__ = names_moved(__name__, ("geodesics.caching",))
