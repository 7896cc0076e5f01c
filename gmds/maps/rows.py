"""What every map must be: a row for each vertex of its source, on its target."""

from __future__ import annotations

import numpy as np

from gmds.errors import MapError
from gmds.maps.point_map import PointMap


def check_rows(answer: PointMap) -> None:
    """Raise `MapError` when a row is missing, lies on another mesh than the target, or its distortion is not finite."""
    n = answer.source.n_vertices
    if answer.points.mesh is not answer.target:
        raise MapError("the points lie on another mesh than the target; make them with SurfacePoints(target, ...)")
    for name, rows in (
        ("points", len(answer.points)),
        ("valid", len(answer.valid)),
        ("distortion", len(answer.distortion)),
    ):
        if rows != n:
            raise MapError(f"{name} has {rows} rows; the source has {n} vertices and a map one row for each")
    bad = np.flatnonzero(~np.isfinite(answer.distortion))
    if len(bad):
        raise MapError(f"the distortion of row {bad[0]} is not finite ({len(bad)} such rows)")
