"""What is computed once per (immutable) object: results of functions, and properties."""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable
from typing import Any, Generic, Self, TypeVar, overload

import numpy as np

T = TypeVar("T")

F = TypeVar("F", bound=Callable[..., Any])


def memoized(function: F) -> F:
    """Keep `function(obj)`, or `function(obj, key)` for each key, on `obj`, which never changes: nothing goes stale.

    Arrays in the result are made read-only, because every later caller is handed the same ones. The result lives as
    long as the object; two threads may both compute it, and then both see the one that was kept.
    """
    key = _key(function)

    @functools.wraps(function)
    def wrapper(obj: Any, *arguments: Hashable) -> Any:
        if arguments:
            kept = obj.__dict__.setdefault(key, {})
            if arguments not in kept:
                return kept.setdefault(arguments, _frozen(function(obj, *arguments)))
            return kept[arguments]
        if key not in obj.__dict__:
            return obj.__dict__.setdefault(key, _frozen(function(obj)))
        return obj.__dict__[key]

    return wrapper  # type: ignore[return-value]


def keep(function: Callable[..., T], obj: Any, result: T, *arguments: Hashable) -> None:
    """Have the `memoized` function return `result` for `obj`: what was read from a file is not computed again."""
    if arguments:
        obj.__dict__.setdefault(_key(function), {})[arguments] = _frozen(result)
    else:
        obj.__dict__[_key(function)] = _frozen(result)


def _key(function: Callable[..., Any]) -> str:
    return f"_memo_{function.__module__}.{function.__qualname__}"


def _frozen(result: Any) -> Any:
    for array in result if isinstance(result, tuple) else (result,):
        if isinstance(array, np.ndarray):
            array.setflags(write=False)
    return result


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
