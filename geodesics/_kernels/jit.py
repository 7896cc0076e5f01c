"""How kernels are compiled: lazily, without the interpreter lock, and kept on disk where that is possible."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import numba
from numba.core import event

F = TypeVar("F", bound=Callable[..., Any])

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}  # numpy: no check before every division


def njit(function: F) -> F:
    """`numba.njit(cache=True, nogil=True)`, without the cache where no directory for it can be written."""
    return _compiled(function, **OPTIONS)


def uncounted(function: F) -> F:
    """As `njit`, for kernels that make no arrays: without counting references to arrays, in a sixth less time."""
    try:
        return _compiled(function, _nrt=False, **OPTIONS)
    except (KeyError, TypeError):  # a private option of numba, which may disappear
        return _compiled(function, **OPTIONS)


def inlined(function: F) -> F:
    """For helpers that take arrays: inlined, as a call counts references to each array and is 6 times slower."""
    return numba.njit(inline="always", **OPTIONS)(function)  # type: ignore[no-any-return]


def summing(function: F) -> F:
    """As `njit`, for long sums: terms may be added in any order, and so several at a time."""
    return _compiled(function, fastmath={"reassoc", "nsz", "contract"}, **OPTIONS)


def _compiled(function: F, **options: Any) -> F:
    try:
        return numba.njit(cache=True, **options)(function)  # type: ignore[no-any-return]
    except RuntimeError:  # numba: "cannot cache function: no locator available"
        return numba.njit(**options)(function)  # type: ignore[no-any-return]


def cache_folder() -> str | None:
    """Where compiled kernels are kept; None where no directory for them can be written."""
    path: str | None = njit(_probe).stats.cache_path  # type: ignore[attr-defined]
    return path


def _probe() -> None:
    """Never called: numba would keep it where it keeps the kernels of this folder."""


@contextmanager
def reporting_compilation(report: Callable[[bool], None]) -> Iterator[None]:
    """In the block, `report(True)` when a kernel begins to be compiled, not read from disk; then `report(False)`."""

    class Listener(event.Listener):  # type: ignore[misc]
        depth = 0  # kernels compile the kernels that they call

        def on_start(self, event: Any) -> None:
            self.depth += 1
            if self.depth == 1:
                report(True)

        def on_end(self, event: Any) -> None:
            self.depth -= 1
            if self.depth == 0:
                report(False)

    with event.install_listener("numba:compile", Listener()):
        yield
