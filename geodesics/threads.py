"""Linear algebra on one thread: threads make small products slower, and the last digits depend on their number.

On two shared cores the threads of OpenBLAS took three to five times the CPU time of one to match two meshes.
"""

from __future__ import annotations

import functools
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

P = ParamSpec("P")
R = TypeVar("R")
S = TypeVar("S")

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


def side_by_side(function: Callable[[S], R], items: Iterable[S]) -> list[R]:
    """The function of each item, in their order, on `threads()` threads; what is returned does not depend on these."""
    given = list(items)
    count = min(threads(), len(given))
    if count < 2:
        return [function(item) for item in given]
    with ThreadPoolExecutor(count) as pool:
        return list(pool.map(function, given))
