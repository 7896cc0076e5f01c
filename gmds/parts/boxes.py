"""A box of cells around a simplified surface that name the closest vertex: it is found at once, to within a cell."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics.arrays import Floats
from geodesics.caching import memoized
from gmds.registration.deformable import DeformableMesh

CELLS = 40  # along the longest side of the box; set by hand
MARGIN = 0.25  # root areas of the box around the surface; set by hand


class Box(NamedTuple):
    """The closest vertex of each of its `cells` (a, b, c), the corner `low` (3,) of the first, and their `step`."""

    cells: NDArray[np.int32]
    low: Floats
    step: float


@memoized
def box_around(mesh: DeformableMesh, count: int) -> Box:
    """The box around a surface, `count` cells long."""
    places = mesh.mesh.vertices[mesh.usable]
    low, high = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    step = float((high - low).max() / count)
    counts = np.ceil((high - low) / step).astype(np.int64) + 1
    centres = low + step * np.moveaxis(np.indices(counts), 0, -1)
    near = mesh.usable[cKDTree(places).query(centres.reshape(-1, 3))[1]]
    return Box(near.reshape(centres.shape[:3]).astype(np.int32), low, step)
