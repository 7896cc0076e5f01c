"""Landmarks as the page shows them: names, and where they are drawn on both surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from geodesics import SurfacePoints
from gmds.maps.point_map import PointMap
from gmds.report.drawing import Drawing

Both = tuple[Drawing, Drawing]
NamedPair = tuple[str, ArrayLike | None, ArrayLike | None]  # a landmark: its place on the source and on the target


def landmarks_of(answer: PointMap) -> list[NamedPair]:
    """The landmarks that a map was made with, by number: where they are on both meshes."""
    made = answer.meta.get("parameters", {}).get("landmarks")
    if not isinstance(made, Mapping):
        return []
    sides = []
    for side, mesh in (("source", answer.source), ("target", answer.target)):
        face, weights = made[side]["face"], made[side]["barycentric"]
        sides.append(SurfacePoints(mesh, np.array(face, dtype=np.int64), np.array(weights)).positions)
    return [(str(i + 1), *pair) for i, pair in enumerate(zip(*sides, strict=True))]


def places(at: Sequence[ArrayLike | None], drawn: Both) -> list[list[float] | None]:
    """Where a landmark is drawn on either surface; None where it has no place."""
    return [
        None if one is None else of_side.placed(np.asarray(one)).tolist()
        for one, of_side in zip(at, drawn, strict=True)
    ]
