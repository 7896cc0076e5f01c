"""The rows of a map, one for each vertex of its source: what they must be, and what a file holds of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.errors import MapError
from gmds.maps.candidate_rows import candidate_members, candidates_of
from gmds.maps.point_map import MatchStatus, PointMap

OF_THE_FILE = ("format", "version", "source", "target", "status")  # members of its meta that are not the map's


def check_rows(answer: PointMap) -> None:
    """Raise `MapError` when a row is missing, lies on another mesh than the target, or its distortion is not finite.

    Or when its confidence is no probability: NaN, for a map that nobody rated, everywhere or nowhere.
    """
    n = answer.source.n_vertices
    if answer.points.mesh is not answer.target:
        raise MapError("the points lie on another mesh than the target; make them with SurfacePoints(target, ...)")
    for name, rows in (
        ("points", len(answer.points)),
        ("valid", len(answer.valid)),
        ("distortion", len(answer.distortion)),
        ("confidence", len(answer.confidence)),
    ):
        if rows != n:
            raise MapError(f"{name} has {rows} rows; the source has {n} vertices and a map one row for each")
    bad = np.flatnonzero(~np.isfinite(answer.distortion))
    if len(bad):
        raise MapError(f"the distortion of row {bad[0]} is not finite ({len(bad)} such rows)")
    unknown = np.isnan(answer.confidence)
    wrong = ~unknown & ~((answer.confidence >= 0) & (answer.confidence <= 1))
    bad = np.flatnonzero(wrong | (unknown & ~unknown.all()))
    if len(bad):
        raise MapError(f"the confidence of row {bad[0]} is {answer.confidence[bad[0]]}, no probability from 0 to 1")


def frozen_rows(answer: PointMap) -> dict[str, NDArray[Any]]:
    """Copies of what a map says of each row, (n,), that cannot be written to."""
    types = {"valid": np.bool_, "distortion": np.float64, "confidence": np.float64}
    rows: dict[str, NDArray[Any]] = {
        name: np.array(getattr(answer, name), dtype=dtype).reshape(-1) for name, dtype in types.items()
    }
    for array in rows.values():
        array.setflags(write=False)
    return rows


def members(answer: PointMap) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
    """What a map file (`gmds.maps.npz_format`) holds of a map: arrays by the names of its members, and meta."""
    points = answer.points
    arrays = {"face": points.face, "barycentric": points.barycentric, "vertex": points.nearest_vertices()}
    rated = {} if np.isnan(answer.confidence).all() else {"confidence": answer.confidence}
    told = {**answer.meta, "status": answer.status.name}
    rows = {**arrays, "valid": answer.valid, "distortion": answer.distortion, **rated}
    return {**rows, **candidate_members(answer.candidates)}, told


def attributes(target: Mesh, arrays: Mapping[str, NDArray[Any]], told: Mapping[str, Any]) -> dict[str, Any]:
    """What `members` were made of: the attributes of a map, but for its meshes."""
    status = MatchStatus.__members__.get(str(told.get("status")), MatchStatus.UNRATED)
    return {
        "points": SurfacePoints(target, arrays["face"], arrays["barycentric"]),
        **{name: arrays[name] for name in ("valid", "distortion", "confidence") if name in arrays},
        "status": status,
        "candidates": candidates_of(target, arrays),
        "meta": {key: value for key, value in told.items() if key not in OF_THE_FILE},
    }
