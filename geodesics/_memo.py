"""Results that are computed once per (immutable) object."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

F = TypeVar("F", bound=Callable[..., Any])


def memoized(function: F) -> F:
    """Keep `function(obj)` on `obj` itself: objects never change, so results never go stale.

    Arrays in the result are made read-only, because every later caller is handed the same ones. The result lives as
    long as the object; two threads may both compute it, and then both see the one that was kept.
    """
    key = f"_memo_{function.__module__}.{function.__qualname__}"

    @functools.wraps(function)
    def wrapper(obj: Any) -> Any:
        if key not in obj.__dict__:
            return obj.__dict__.setdefault(key, _frozen(function(obj)))
        return obj.__dict__[key]

    return wrapper  # type: ignore[return-value]


def _frozen(result: Any) -> Any:
    for array in result if isinstance(result, tuple) else (result,):
        if isinstance(array, np.ndarray):
            array.setflags(write=False)
    return result
