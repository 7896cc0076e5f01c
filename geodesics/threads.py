"""Linear algebra on one thread, and independent work on several.

Threads of BLAS make small products slower, and the last digits depend on their number. On two shared cores those of
OpenBLAS took three to five times the CPU time of one to match two meshes.
"""

from __future__ import annotations

import functools
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from typing import Any, Generic, ParamSpec, Self, TypeVar, overload

from threadpoolctl import threadpool_limits

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
    """The function of each item, in their order, on `threads()` threads; what is returned does not depend on these.

    Inside such a function there are no further threads. `progress(share)` is called on the calling thread as results
    come in. What it raises, and what the function does, ends the work: items that were not begun are not.
    """
    given, results = list(items), []
    count = 1 if getattr(_own, "busy", False) else min(threads(), len(given))
    with ThreadPoolExecutor(count, initializer=_make_busy) if count > 1 else nullcontext() as pool:
        try:
            for result in map(function, given) if pool is None else pool.map(function, given):
                results.append(result)
                if progress is not None:
                    progress(len(results) / len(given))
        except BaseException:
            if pool is not None:
                pool.shutdown(wait=False, cancel_futures=True)
            raise
    return results


def _make_busy() -> None:
    _own.busy = True


class cached_property(Generic[T]):
    """`functools.cached_property`, which before Python 3.12 lets one thread in at a time, whatever the object.

    Two threads that ask the same object at once may both compute; either result is kept.
    """

    def __init__(self, function: Callable[[Any], T]) -> None:
        self.function = function
        self.__doc__ = function.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...

    @overload
    def __get__(self, instance: object, owner: type) -> T: ...

    def __get__(self, instance: object | None, owner: type) -> T | Self:
        if instance is None:
            return self
        return instance.__dict__.setdefault(self.name, self.function(instance))  # type: ignore[no-any-return]
