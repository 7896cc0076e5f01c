"""What the page shows: both surfaces, every map with its way back, and the values that colours stand for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats
from gmds.evaluation import error_curve
from gmds.maps.growth import growth_of
from gmds.maps.images import preimage
from gmds.maps.made_with import NamedPair, landmarks_of
from gmds.maps.overlap import reach
from gmds.maps.point_map import PointMap
from gmds.maps.words import WORDS
from gmds.pictures.colours import (
    MISSING,
    diverging_colours,
    few_known,
    nearest_known,
    shown_range,
    symmetric_reach,
    value_colours,
)
from gmds.pictures.matching_colours import matching_colours
from gmds.pictures.scales import FINE, SIGNED, TOPS
from gmds.report.candidates import maps_of
from gmds.report.drawing import Drawing
from gmds.report.landmarks import Both, places
from gmds.report.modes import modes
from gmds.report.packing import levels, small
from gmds.report.told import told

BARS = 40  # of a histogram; set by hand
THRESHOLDS = np.linspace(0, 0.25, 51)  # errors, over the root of the area: the range in which the field draws curves


def content(
    answer: PointMap,
    errors: Floats | None,
    drawn: Both,
    names: Sequence[str],
    landmarks: Sequence[NamedPair] | None = None,
    later: Sequence[str] = (),
) -> dict[str, Any]:
    """All that the script of the page reads.

    `errors` (k, n): of the map and of its candidates, as far as they are known, NaN where the truth is not; `later`:
    what maps may have by which to colour them that are not there yet.
    """
    maps = maps_content(answer, errors, drawn)
    known = [key for key in TOPS if key in later or any(key in one["values"] for one in maps)]
    given = landmarks_of(answer) if landmarks is None else landmarks
    return {
        "surfaces": [_surface(*one) for one in zip((answer.source, answer.target), drawn, names, strict=True)],
        "modes": modes(known, errors),
        "maps": maps,
        "words": WORDS,
        "landmarks": [{"name": name, "at": places(at, drawn)} for name, *at in given],
        "colours": levels(matching_colours(answer.target)[drawn[1].origin]),
        "ramp": levels(value_colours(np.linspace(0, 1, 128), 0, 1)),
        "signedRamp": levels(diverging_colours(np.linspace(-1, 1, 129), 1)),
        "missing": levels(np.array(MISSING)).tolist(),
        "thresholds": THRESHOLDS.tolist(),
    }


def maps_content(answer: PointMap, errors: Floats | None, drawn: Both, title: str = "") -> list[dict[str, Any]]:
    """What the script reads of a map and of each of its candidates; `title` is what the map is called."""
    maps = maps_of(answer)
    rows: list[Floats | None] = [None] * len(maps) if errors is None else [*errors, *[None] * (len(maps) - len(errors))]
    fields = [_fields(one, row) for one, row in zip(maps, rows, strict=True)]
    colours = matching_colours(answer.target)
    words = told(answer, errors)
    return [
        {"name": name, "note": note, "told": of_it.as_data(), **_map(one, drawn, colours, values)}
        for (name, note), one, values, of_it in zip(_names(answer, title), maps, fields, words, strict=True)
    ]


def _names(answer: PointMap, title: str) -> list[tuple[str, str]]:
    """A name and a sentence for the map and for each of its candidates."""
    names = [(title or "Best map", " ".join(map(str, answer.meta.get("notes", ()))) if title else "")]
    for i, one in enumerate(answer.candidates, start=1):
        kind = "mirrored" if one.orientation < -0.2 else "not mirrored" if one.orientation > 0.2 else "partly mirrored"
        called = f"{title}, candidate {i}" if title else f"Candidate {i}"
        names.append((f"{called}, {kind}", "Counterparts are taken to be those of the best map."))
    return names


def _fields(one: PointMap, errors: Floats | None) -> dict[str, Floats]:
    """What is known per source vertex (n,) of a map; NaN where it is not."""
    fields = {}
    if not np.isnan(one.confidence).all():
        fields["confidence"] = np.where(one.valid, one.confidence, np.nan)
    if np.ptp(one.distortion) > 0:
        fields["distortion"] = np.where(one.valid, one.distortion, np.nan)
    growth = growth_of(one).relative
    if np.isfinite(growth).any():
        fields["growth"] = growth
    if errors is not None and np.isfinite(errors).any():
        fields["error"] = np.where(np.isfinite(errors), errors, np.nan)
    return fields


def _surface(mesh: Mesh, drawn: Drawing, name: str) -> dict[str, Any]:
    faces, origin = small(drawn.faces), small(drawn.origin)
    turned = (drawn.axes * drawn.unit).ravel().tolist()
    about = {"name": name, "count": mesh.n_vertices, "axes": turned, "unit": drawn.unit}
    return {**about, "vertices": drawn.placed(drawn.vertices), "faces": faces, "origin": origin}


def _map(one: PointMap, drawn: Both, target_colours: Floats, fields: Mapping[str, Floats]) -> dict[str, Any]:
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
    tops = {key: _fitted(key, fields[key]) for key in fields}
    return {
        "there": _images(one.points[here], one.valid[here], theirs),
        "back": _images(points, reached, ours),
        "colours": levels(colours[here]),
        "values": values,
        "tops": tops,
        "largest": {key: float(np.nanmax(fields[key], initial=0.0)) for key in fields},
        "histograms": {
            key: [_histogram(fields[key], top) for top in (TOPS[key], tops[key], FINE.get(key)) if top]
            for key in tops
            if key not in SIGNED
        },
        "curve": _curve(fields["error"]) if "error" in fields else None,
        "dots": _dots(one.source, fields.get("error"), ours),
    }


def _fitted(key: str, values: Floats) -> float:
    """Where the scale of a map ends that is made to fit it."""
    known = values[np.isfinite(values)]
    if key == "confidence" or not len(known):
        return TOPS[key]
    if key in SIGNED:
        return symmetric_reach(known)
    return shown_range(known)[1] or float(known.max()) or TOPS[key]


def _dots(source: Mesh, errors: Floats | None, drawn: Drawing) -> dict[str, Any] | None:
    """The points whose truth is known and their errors, where they are few."""
    if errors is None or not len(known := few_known(errors)):
        return None
    return {"position": drawn.placed(source.vertices[known]), "error": errors[known].astype("<f4")}


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
