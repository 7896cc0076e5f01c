"""What a map was made with: its landmarks, by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats
from gmds.maps.point_map import PointMap

NamedPair = tuple[str, ArrayLike | None, ArrayLike | None]  # a landmark: its place on the source and on the target


def landmarks_of(answer: PointMap) -> list[NamedPair]:
    """The landmarks that a map was made with, by name or else by number: where they are on both meshes."""
    made = answer.meta.get("parameters", {}).get("landmarks")
    if not isinstance(made, Mapping):
        return []
    try:
        sides = [_positions(made[side], mesh) for side, mesh in (("source", answer.source), ("target", answer.target))]
    except (KeyError, TypeError, ValueError):  # a map of somebody else
        return []
    count = min(map(len, sides))
    given = made.get("names", answer.meta.get("landmark_names"))  # the latter of the first, which hands have placed
    names = list(map(str, given))[:count] if isinstance(given, list) else [str(i + 1) for i in range(count)]
    return list(zip(names, *(side[: len(names)] for side in sides), strict=True))


def _positions(made: Mapping[str, Any], mesh: Mesh) -> Floats:
    """Where points of a mesh are that a map says it was made with."""
    return SurfacePoints(mesh, np.array(made["face"], dtype=np.int64), np.array(made["barycentric"])).positions
