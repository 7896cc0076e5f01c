"""Results that are computed once per (immutable) object."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])


def memoized(function: F) -> F:
    """Keep `function(obj)` on `obj` itself: objects never change, so results never go stale."""
    key = f"_memo_{function.__module__}.{function.__qualname__}"

    @functools.wraps(function)
    def wrapper(obj: Any) -> Any:
        if key not in obj.__dict__:
            obj.__dict__[key] = function(obj)
        return obj.__dict__[key]

    return wrapper  # type: ignore[return-value]
