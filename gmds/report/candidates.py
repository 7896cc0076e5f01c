"""The candidates of a map as maps of their own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from gmds.maps.point_map import Candidate, MatchStatus, PointMap


class CandidateMap(NamedTuple):
    """A candidate as a map of its own."""

    source: Mesh
    target: Mesh
    points: SurfacePoints
    valid: Bools
    distortion: Floats
    confidence: Floats
    status: MatchStatus
    candidates: tuple[Candidate, ...]
    meta: Mapping[str, Any]

    def vertex_map(self) -> Integers:
        return self.points.nearest_vertices()


def maps_of(answer: PointMap) -> list[PointMap]:
    """The map itself, then each of its candidates as a map of its own, of which no distortion is known."""
    unrated, status, meta = np.zeros(len(answer.valid)), MatchStatus.UNRATED, answer.meta
    unknown = np.full(len(unrated), np.nan)
    others = (
        CandidateMap(answer.source, answer.target, one.points, answer.valid, unrated, unknown, status, (), meta)
        for one in answer.candidates
    )
    return [answer, *others]
