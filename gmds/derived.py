"""What is computed from one surface alone is computed once, however many it is matched with."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TypeVar

from gmds.surface import Surface

R = TypeVar("R")


def derived_once(function: Callable[[Surface], R]) -> Callable[[Surface], R]:
    """The function of a surface, with its result kept in `surface.derived` under the name of the function."""
    name = function.__name__

    @functools.wraps(function)
    def kept(surface: Surface) -> R:
        if name not in surface.derived:
            surface.derived[name] = function(surface)
        result: R = surface.derived[name]
        return result

    return kept
