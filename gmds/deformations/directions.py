"""Directions in space."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.errors import BadArgument


def unit(direction: ArrayLike) -> Floats:
    """A direction (3,) with length 1; `ValueError` for what is none."""
    d = np.asarray(direction, dtype=np.float64)
    length = np.linalg.norm(d)
    if d.shape != (3,) or not (np.isfinite(length) and length > 0):
        raise BadArgument(f"a direction is three numbers that are not all 0, not {d.tolist()}")
    return np.asarray(d / length)


def camera_axes(towards: Floats) -> Floats:
    """Rotation (3, 3) with rows right, up and towards the viewer, who is in that direction (3,)."""
    right = np.cross(np.eye(3)[np.abs(towards).argmin()], towards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards])
