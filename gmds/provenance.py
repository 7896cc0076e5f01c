"""With what a map was made: versions, functions and objects in words."""

from __future__ import annotations

import functools
import platform
import re
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

from gmds._version import __version__


def versions() -> dict[str, str]:
    """What computed the numbers."""
    return {"gmds": __version__, "python": platform.python_version(), **_numeric()}


@functools.cache
def _numeric() -> dict[str, str]:
    """Of the packages that compute: looked up once, as that takes 10 ms."""
    return {name: version(name) for name in ("numpy", "scipy", "numba")}


def method_in_words(distance: Callable[..., Any] | None, loss: Any) -> dict[str, str | None]:
    """The distance and the loss of a match, as its parameters name them; None for the distance that is the default."""
    return {"distance": None if distance is None else in_words(distance), "loss": in_words(loss)}


def in_words(thing: Any) -> str:
    """A function by its module and name, a partial one with its arguments, an object by its `repr`.

    Never with an address, which would be another in every process.
    """
    if isinstance(thing, functools.partial):
        named = (f"{key}={in_words(value)}" for key, value in sorted(thing.keywords.items()))
        return f"{in_words(thing.func)}({', '.join([*map(in_words, thing.args), *named])})"
    if hasattr(thing, "__qualname__"):
        return f"{thing.__module__}.{thing.__qualname__}"
    return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(thing))


def is_lasting(thing: Any) -> bool:
    """Whether the words for a thing mean the same in another process: no lambda, no function inside a function."""
    return not re.search(r"<(lambda|locals)>|^<", in_words(thing))
