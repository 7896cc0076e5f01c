"""What the page shows: both surfaces, every map with its way back, and the values that colours stand for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from gmds.evaluation import error_curve
from gmds.maps.images import preimage
from gmds.maps.overlap import reach
from gmds.maps.point_map import Candidate, MatchStatus, PointMap
from gmds.pictures.colours import MISSING, nearest_known, position_colours, shown_range, value_colours
from gmds.report.drawing import Drawing
from gmds.report.packing import levels, small

Both = tuple[Drawing, Drawing]

BARS = 40  # of a histogram; set by hand
THRESHOLDS = np.linspace(0, 0.25, 51)  # errors, over the root of the area: the range in which the field draws curves
UNMATCHED_COLOUR = (0.93, 0.60, 0.20)  # sRGB, orange: without a counterpart
MATCHED_COLOUR = (0.28, 0.47, 0.72)  # sRGB, blue: with one
MATCH = (
    "A point and its partner on the other surface have the same colour. Look for a part that has the colour of "
    "another part, a left leg that of a right leg, say: there the map is wrong."
)
VALID = "Which points of either surface have a partner. Those without are on a part that the other surface lacks."
DISTORTION = (
    "By what share lengths around a point change. Where one animal has a longer neck than the other, they have to."
)
DOUBT = (
    "How likely a point is off the truth by more than 0.05 of the root of the area of the target, 1 less the "
    "confidence: yellow is where to look first."
)
ERROR = (
    "How far a point is sent from its true place, along the target, over the square root of its area: dark blue is "
    "right, yellow is wrong."
)
SPARSE = " The truth is known at {} points; all others have the colour of the nearest of them."


def content(answer: PointMap, errors: Floats | None, drawn: Both, names: Sequence[str]) -> dict[str, Any]:
    """All that the script of the page reads.

    `errors` (k, n): of the map and of its candidates, as far as they are known, NaN where the truth is not.
    """
    maps = _maps(answer)
    rows: list[Floats | None] = [None] * len(maps) if errors is None else [*errors, *[None] * (len(maps) - len(errors))]
    fields = [_fields(one, row) for one, row in zip(maps, rows, strict=True)]
    modes = _modes(fields[0], len(answer.source.vertices))
    tops = {mode["key"]: mode["high"] for mode in modes if "high" in mode}
    colours = position_colours(answer.target.vertices)
    return {
        "surfaces": [_surface(one, name) for one, name in zip(drawn, names, strict=True)],
        "modes": modes,
        "maps": [
            {"name": name, "note": note, **_map(one, drawn, colours, values, tops)}
            for (name, note), one, values in zip(_names(answer), maps, fields, strict=True)
        ],
        "colours": levels(colours[drawn[1].origin]),
        "ramp": levels(value_colours(np.linspace(0, 1, 128), 0, 1)),
        "missing": levels(np.array(MISSING)).tolist(),
        "thresholds": THRESHOLDS.tolist(),
    }


class _CandidateMap(NamedTuple):
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


def _maps(answer: PointMap) -> list[PointMap]:
    """The map itself, then each of its candidates as a map of its own, of which no distortion is known."""
    unrated, status, meta = np.zeros(len(answer.valid)), MatchStatus.UNRATED, answer.meta
    unknown = np.full(len(unrated), np.nan)
    others = (
        _CandidateMap(answer.source, answer.target, one.points, answer.valid, unrated, unknown, status, (), meta)
        for one in answer.candidates
    )
    return [answer, *others]


def _names(answer: PointMap) -> list[tuple[str, str]]:
    """A name and a sentence for the map and for each of its candidates."""
    names = [("Best map", "")]
    for i, one in enumerate(answer.candidates, start=1):
        kind = "mirrored" if one.orientation < -0.2 else "not mirrored" if one.orientation > 0.2 else "partly mirrored"
        names.append((f"Candidate {i}, {kind}", "Counterparts are taken to be those of the best map."))
    return names


def _fields(one: PointMap, errors: Floats | None) -> dict[str, Floats]:
    """What is known per source vertex (n,) of a map; NaN where it is not."""
    fields = {}
    if not np.isnan(one.confidence).all():
        fields["doubt"] = np.where(one.valid, 1 - one.confidence, np.nan)
    if np.ptp(one.distortion) > 0:
        fields["distortion"] = np.where(one.valid, one.distortion, np.nan)
    if errors is not None and np.isfinite(errors).any():
        fields["error"] = np.where(np.isfinite(errors), errors, np.nan)
    return fields


def _modes(fields: Mapping[str, Floats], n_vertices: int) -> list[dict[str, Any]]:
    """The ways of colouring: what they are called, what they mean, and the range of what they show."""
    modes: list[dict[str, Any]] = [{"key": "match", "label": "Matching colours", "help": MATCH}]
    for key, label, meaning, axis in (
        ("doubt", "Doubt", DOUBT, "doubt: probability of being off by more than 0.05 √area"),
        ("distortion", "Distortion", DISTORTION, "distortion: relative error of lengths"),
        ("error", "Error", ERROR, "error: distance from the true point / √area"),
    ):
        if key in fields:
            known = fields[key][np.isfinite(fields[key])]
            top = 1.0 if key == "doubt" else shown_range(known)[1] or float(known.max()) or 1.0
            sparse = SPARSE.format(f"{len(known):,}") if key == "error" and len(known) < n_vertices // 2 else ""
            counted = "points" if sparse else "vertices"
            about = {"key": key, "label": label, "help": meaning + sparse, "axis": axis, "counted": counted}
            modes.append({**about, "high": top, "beyond": bool((known > top).any())})
    swatches = levels(np.array([UNMATCHED_COLOUR, MATCHED_COLOUR])).tolist()
    judged = sum(key in fields for key in ("doubt", "distortion"))
    modes.insert(1 + judged, {"key": "valid", "label": "Counterparts", "help": VALID, "swatches": swatches})
    return modes


def _surface(drawn: Drawing, name: str) -> dict[str, Any]:
    faces, origin = small(drawn.faces), small(drawn.origin)
    return {"name": name, "vertices": drawn.placed(drawn.vertices), "faces": faces, "origin": origin}


def _map(
    one: PointMap, drawn: Both, target_colours: Floats, fields: Mapping[str, Floats], tops: Mapping[str, float]
) -> dict[str, Any]:
    """Where each drawn vertex goes, there and back, and what the colours of the surfaces stand for."""
    (ours, theirs), (here, there) = drawn, (drawn[0].origin, drawn[1].origin)
    points, gap = preimage(one, there)
    reached = (gap < reach(one)) & np.isin(there, one.target.faces)
    colours = one.points.interpolate(target_colours)
    colours[~one.valid] = MISSING
    values: dict[str, list[NDArray[Any]]] = {"valid": [one.valid[here].astype(np.uint8), reached.astype(np.uint8)]}
    for key in fields:
        full = nearest_known(one.source, fields[key]) if key == "error" else fields[key]
        back = np.where(reached, points.interpolate(full), np.nan)
        values[key] = [full[here].astype("<f4"), back.astype("<f4")]
    return {
        "there": _images(one.points[here], one.valid[here], theirs),
        "back": _images(points, reached, ours),
        "colours": levels(colours[here]),
        "values": values,
        "histograms": {key: _histogram(fields[key], tops[key]) for key in fields if key in tops},
        "curve": _curve(fields["error"]) if "error" in fields else None,
    }


def _histogram(values: Floats, top: float) -> list[int]:
    return np.histogram(values[np.isfinite(values)].clip(0, top), BARS, (0, top))[0].tolist()


def _curve(errors: Floats) -> list[float]:
    return error_curve(errors[np.isfinite(errors)], THRESHOLDS).tolist()


def _images(points: SurfacePoints, found: Bools, onto: Drawing) -> dict[str, Any]:
    return {
        "face": small(points.face),
        "vertex": small(points.nearest_vertices()),
        "weights": np.rint(points.barycentric * 65535).astype("<u2"),
        "position": np.rint((onto.placed(points.positions) + 0.5).clip(0, 1) * 65535).astype("<u2"),
        "found": found.astype(np.uint8),
    }
