"""What callers give as counts and as numbers: checked before anything is computed of them."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics._validation import as_array
from geodesics.arrays import Floats
from geodesics.errors import BadArgument, BadDtype


def is_whole(value: Any) -> bool:
    """Whether something counts: an integer of Python or numpy, and no truth value."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def whole_number(value: Any, name: str, least: int, most: int | None = None, of: str = "") -> int:
    """A count from `least` to `most`, which is what there is `of` something; `BadArgument` (E604) for anything else."""
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if number < least or (most is not None and number > most):
        limits = f"at least {least}" if most is None else f"from {least} to {most}{of and f', {of}'}"
        raise BadArgument(f"{name} must be {limits}, and a whole number, not {value!r:.40}")
    return number


def real_number(value: Any, name: str, least: float = -np.inf) -> float:
    """A finite number, at least so large; `BadArgument` (E604) for anything else."""
    try:
        number = float(value) if np.ndim(value) == 0 and not isinstance(value, (str, bytes)) else np.nan
    except (TypeError, ValueError):
        number = np.nan
    if not (np.isfinite(number) and number >= least):
        limits = "a finite number" if least == -np.inf else f"a finite number >= {least:g}"
        raise BadArgument(f"{name} must be {limits}, not {value!r:.40}")
    return number


def real_numbers(values: ArrayLike | Any, name: str) -> Floats:
    """Values as float64, of any shape and not always finite.

    Raises `BadDtype` (E107) where they are no real numbers, `BadShape` (E108) for ragged lists, `TypeError` for text.
    """
    raw = as_array(values, name)
    if raw.dtype.kind not in "fiub":
        raise BadDtype(f"{name} must be real numbers, not {raw.dtype}")
    return np.asarray(raw, dtype=np.float64)
