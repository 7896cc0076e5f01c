"""Unknown names of options, and the nearest known one in the message."""

from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable, Iterable
from typing import ParamSpec, TypeVar

from gmds.errors import UnknownKey

P = ParamSpec("P")
R = TypeVar("R")


def check_keys(given: Iterable[str], allowed: Iterable[str], place: str) -> None:
    """`UnknownKey` (E601) for the first name in `given` that is not `allowed`, with the nearest that is."""
    allowed = list(allowed)
    for name in given:
        if name not in allowed:
            raise UnknownKey(f"{place} has no key {name!r}{did_you_mean(name, allowed)}")


def did_you_mean(name: str, allowed: Iterable[str]) -> str:
    """The end of an error sentence: the nearest allowed name, or all of them."""
    allowed = list(allowed)
    near = difflib.get_close_matches(name, allowed, n=1)
    return f"; did you mean {near[0]!r}?" if near else f"; there are {', '.join(allowed)}"


def suggest_keywords(function: Callable[P, R]) -> Callable[P, R]:
    """`function`, whose `TypeError` for an unknown keyword names the nearest one that exists."""
    keywords = [p.name for p in inspect.signature(function).parameters.values() if p.kind != p.VAR_KEYWORD]

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        for name in kwargs:
            if name not in keywords:
                raise TypeError(f"{function.__name__}() has no argument {name!r}{did_you_mean(name, keywords)}")
        return function(*args, **kwargs)

    return checked
