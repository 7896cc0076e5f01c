"""Specimens whose meshes are in other units than the rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geodesics.arrays import Floats

UNITS = 8.0  # times: a little below 10, by which neighbouring units of length differ


def in_other_units(names: Sequence[str], sizes: Floats) -> dict[str, float]:
    """Of specimens whose sizes (n,), lengths, differ from the median as units do: by how many times, by name.

    Examples
    --------
    >>> in_other_units(["a", "b", "c"], np.array([1.0, 1.2, 1000.0]))
    {'c': 833.3333333333334}
    """
    times = sizes / np.median(sizes)
    return {name: float(x) for name, x in zip(names, times, strict=True) if abs(np.log10(x)) >= np.log10(UNITS)}
