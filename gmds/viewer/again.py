"""A pair matched again: with landmarks placed by hand, and without repeating what was marked as wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from geodesics import GeodesicDistance, SurfacePoints, embedded, farthest_point_sampling
from geodesics.arrays import Bools, Floats, Integers
from gmds.correspondence import Correspondence
from gmds.landmarks.soft import TOLERANCE, SoftLandmarks
from gmds.matching.pipeline import match

ANCHORS = 24  # points of the old map that hold the rest, where a region of it is marked as wrong; set by hand
APART = 0.05  # root areas between them and landmarks, and by which a map has to move what was wrong: the field's radius
AWAY = 0.2  # root areas between them and what is painted, as people paint the middle of what is wrong; set by hand
AGREEING = 0.75  # of them that a candidate has to leave within 2 * APART of where the old map sends them; set by hand

Pairs = tuple[SurfacePoints, SurfacePoints]


def matched_again(
    old: Correspondence,
    pairs: Pairs | None,
    wrong: Bools,
    *,
    tolerance: float = 0.0,
    progress: Callable[[str, float], None] | None = None,
) -> Correspondence:
    """The map with these landmarks; where a region of the old one is wrong, what is not is held softly.

    Of the maps that are found then, the first is taken that sends the region elsewhere; the old one is not among them.
    """
    asked = old.meta.get("parameters", {})
    options = {name: asked[name] for name in ("orientation", "parts") if isinstance(asked.get(name), str)}
    held = held_points(old, pairs, wrong) if wrong.any() else np.empty(0, dtype=np.int64)
    landmarks = _landmarks(old, pairs, held, tolerance)
    answer = match(old.source, old.target, landmarks=landmarks, progress=progress, **_known(options))
    if wrong.any() and (pairs is None or not _within(pairs[0], wrong)):
        return elsewhere(answer, old, wrong, held)
    return answer


def _known(options: dict[str, Any]) -> dict[str, Any]:
    """The options of `match` that a map says it was made with, and that `match` takes."""
    allowed = {"orientation": ("preserve", "reverse", "any", "auto"), "parts": ("auto", "neither")}
    return {name: value for name, value in options.items() if value in allowed[name]}


def held_points(old: Correspondence, pairs: Pairs | None, wrong: Bools) -> Integers:
    """Vertices far from each other, from the region and from landmarks, at which the old map is taken to be right."""
    root = np.sqrt(old.source.area)
    spread = GeodesicDistance(embedded(old.source))
    free = old.valid & ~wrong & ~(old.confidence < 0.5)
    near = np.flatnonzero(wrong)[:: max(wrong.sum() // 200, 1)]
    free &= spread.field(SurfacePoints.at_vertices(old.source, near)).min(axis=0) > AWAY * root
    if pairs is not None:
        free &= spread.field(pairs[0]).min(axis=0) > APART * root
        gaps = old.points.positions[:, None] - pairs[1].positions
        free &= np.linalg.norm(gaps, axis=2).min(axis=1) > APART * np.sqrt(old.target.area)
    chosen = farthest_point_sampling(spread, min(4 * ANCHORS, old.source.n_vertices))
    return chosen[free[chosen]][:ANCHORS]


def _landmarks(old: Correspondence, pairs: Pairs | None, held: Integers, tolerance: float) -> SoftLandmarks | None:
    """Those placed by hand, then those of the old map; the first hold as they are told to, the others softly."""
    own = 0 if pairs is None else len(pairs[0])
    if own + len(held) == 0:
        return None
    sides = []
    for i, mesh in enumerate((old.source, old.target)):
        points = SurfacePoints.at_vertices(mesh, held) if i == 0 else old.points[held]
        face, weights = [points.face], [points.barycentric]
        if pairs is not None:
            face, weights = [pairs[i].face, *face], [pairs[i].barycentric, *weights]
        sides.append(SurfacePoints(mesh, np.concatenate(face), np.concatenate(weights)))
    return SoftLandmarks((sides[0], sides[1]), np.repeat([tolerance, TOLERANCE], [own, len(held)]))


def _within(points: SurfacePoints, region: Bools) -> bool:
    """Whether one of the points is in a region of vertices."""
    return bool(region[points.nearest_vertices()].any())


def elsewhere(answer: Correspondence, old: Correspondence, wrong: Bools, held: Integers) -> Correspondence:
    """The answer, or the first of its candidates, that sends the region elsewhere than the old map, and `held` not."""
    rows, root = np.flatnonzero(wrong & old.valid), np.sqrt(old.target.area)

    def gap(points: SurfacePoints, where: Integers) -> Floats:
        return np.asarray(np.linalg.norm(points.positions[where] - old.points.positions[where], axis=1)) / root

    def fits(points: SurfacePoints) -> bool:
        agrees = not len(held) or (gap(points, held) < 2 * APART).mean() >= AGREEING
        return bool(agrees and len(rows) and np.median(gap(points, rows)) > APART)

    if fits(answer.points):
        return answer
    notes = list(answer.meta.get("notes", ()))
    for other in answer.candidates:
        if fits(other.points):
            meta = {
                **answer.meta,
                "notes": [*notes, "a candidate, taken as it sends elsewhere what was marked as wrong"],
            }
            return Correspondence.from_points(answer.source, other.points, valid=answer.valid, meta=meta)
    note = "no map was found that sends elsewhere what is marked as wrong: place landmarks there"
    return replace(answer, meta={**answer.meta, "notes": [*notes, note]})
