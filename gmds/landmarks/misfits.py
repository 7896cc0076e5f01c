"""Landmarks that do not fit the map around them: one on the hip of one surface and on the foot of the other.

A map has to meet a hard landmark, right or wrong, and is torn to it where that is wrong. What lies around the landmark,
but not close to it, still goes where it belongs, and moved along with that as a solid the landmark would as well.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.one_ring import one_ring_areas
from geodesics.topology.edge_paths import edge_distances
from gmds.maps.overlap import area_share
from gmds.maps.point_map import PointMap
from gmds.registration.similarity import nearest_similarity

# Root areas of the source around a landmark between which vertices count as what is around it, and root areas of the
# target beyond which a landmark does not fit that: on 74 pairs for development those of right maps that are right, or
# off by up to 0.03, are 0.12 away at the most, and wrong ones, unless all of the map goes with them, 0.137 at the least
# (benchmarks/results/notes.md, "Wrong landmarks").
AROUND = (0.06, 0.2)
MISFIT = 0.12
FEWEST = 6  # vertices around a landmark, below which nothing is said: a bound, a similarity needs three
NUMBERS = 4_000_000  # distances at a time: a bound, so that memory is


def misfits(answer: PointMap, on_source: SurfacePoints, on_target: SurfacePoints) -> Floats:
    """How far landmarks (k,) are from where what is around them goes, in root areas of the target.

    What is around one are the vertices at a distance `AROUND` from it along edges of the source, so that what only
    touches it does not count; where it goes, the similarity nearest to the map of them, weighted by area, which sends
    the landmark of the source to some distance from that on the target. NaN where there are too few vertices.

    Of a map that reverses orientation, as its evidence says, that similarity mirrors. Of parts, areas are those of what
    is mapped: the vertices that are `valid`, and their images.
    """
    side = np.array([-1.0 if answer.meta.get("evidence", {}).get("orientation", 1.0) < 0 else 1.0, 1.0, 1.0])
    places, images, marks = side * answer.source.vertices, answer.points.positions, side * on_source.positions
    areas = np.where(answer.valid, one_ring_areas(answer.source), 0.0)
    unit, size = _root_areas(answer)
    rings = surroundings(answer.source, on_source.nearest_vertices(), areas, unit)
    sent = carried_along(rings, places, images, areas, marks)
    return np.asarray(np.linalg.norm(sent - on_target.positions, axis=1) / size, dtype=np.float64)


def surroundings(mesh: Mesh, starts: Integers, areas: Floats, unit: float) -> list[Integers]:
    """What is around vertices (k,) of a mesh: the vertices at a distance `AROUND` from each, in `unit`, with area."""
    rings: list[Integers] = []
    step = max(1, NUMBERS // mesh.n_vertices)
    for start in range(0, len(starts), step):
        for distance in edge_distances(mesh, starts[start : start + step], AROUND[1] * unit):
            near = (distance > AROUND[0] * unit) & (distance < AROUND[1] * unit) & (areas > 0)
            rings.append(np.flatnonzero(near))
    return rings


def carried_along(rings: list[Integers], places: Floats, images: Floats, areas: Floats, marks: Floats) -> Floats:
    """Where points (k, 3) go along with the vertices around each, moved from `places` (n, 3) to `images` (n, 3).

    By the nearest similarity of these, weighted by their areas (n,); NaN where they are fewer than `FEWEST`.
    """
    result = np.full((len(rings), 3), np.nan)
    for row, near in enumerate(rings):
        if len(near) >= FEWEST:
            result[row] = _sent(places[near], images[near], areas[near], marks[row])
    return result


def named(rows: Integers, gaps: Floats, called: Sequence[str]) -> str:
    """Those of the landmarks (k,) in words, as they are called, with their gaps (k,)."""
    return ", ".join(f"{called[row]} by {gaps[row]:.2f}" for row in rows)


def _root_areas(answer: PointMap) -> tuple[float, float]:
    """The roots of the areas of both surfaces, or of what is mapped of them where not all of it is."""
    here, there = answer.source.area, answer.target.area
    used = np.bincount(answer.source.faces.ravel(), minlength=answer.source.n_vertices) > 0
    if not answer.valid[used].all():
        here *= area_share(answer.source, answer.valid)
        reached = np.zeros(answer.target.n_vertices, dtype=bool)
        reached[answer.points.nearest_vertices()[answer.valid]] = True
        there *= area_share(answer.target, reached)
    return float(np.sqrt(here)), float(np.sqrt(there))


def _sent(places: Floats, images: Floats, areas: Floats, landmark: Floats) -> Floats:
    """Where the nearest similarity of places (p, 3) to their images sends a landmark (3,)."""
    return nearest_similarity(places, images, areas / areas.sum()).moved(landmark[None])[0]
