"""Landmarks of a collection in tables: raw and superimposed, a row a landmark and a row a specimen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from geodesics.io import atomic_write
from gmds.files.table import write_table
from gmds.maps.point_map import MatchStatus
from gmds.morphometrics.procrustes import Superposition, superimposed
from gmds.specimens.carried import DOUBTFUL, Landmarked
from gmds.specimens.units import in_other_units

FAR = 3.0  # times the median distance from the mean shape beyond which a specimen needs a look; set by hand
NOWHERE = ("NA", "NA", "NA")  # a place, as R reads one that is missing


def write_tables(folder: Path, found: Landmarked) -> list[tuple[str, str]]:
    """All tables of a collection, into a folder; who needs a look, and why.

    landmarks.csv and shapes.csv have a row for every landmark of every specimen, raw and superimposed;
    landmarks_wide.csv and shapes_wide.csv a row for every specimen; landmarks.tps a block for every specimen.
    """
    places = np.stack([one.configuration for one in found.specimens])
    some = np.isfinite(places).all(axis=2).any(axis=0)
    laid, why = _laid(places[:, some])
    wide = [f"{name}.{axis}" for name in found.names for axis in "xyz"]
    write_table(
        folder / "landmarks.csv",
        ["specimen", "landmark", "x", "y", "z", "confidence", "valid"],
        _long(found, places, confidence=True),
    )
    rows = ([one.name, *_na(place.ravel())] for one, place in zip(found.specimens, places, strict=True))
    write_table(folder / "landmarks_wide.csv", ["specimen", *wide], rows)
    with atomic_write(folder / "landmarks.tps") as stream:
        stream.write(_tps(found, places).encode("utf-8"))
    to_look_at = list(found.failures.items())
    if not some.all():
        to_look_at.append(("all", f"on no specimen: {', '.join(found.names[i] for i in np.flatnonzero(~some))}"))
    if laid is not None:
        aligned = np.full(places.shape, np.nan)
        aligned[:, some] = np.where(np.isfinite(places[:, some]), laid.aligned, np.nan)
        write_table(folder / "shapes.csv", ["specimen", "landmark", "x", "y", "z"], _long(found, aligned))
        head = ["specimen", "centroid_size", "distance_to_mean", *wide]
        sizes = zip(found.specimens, laid.sizes.tolist(), laid.distances.tolist(), aligned, strict=True)
        rows = ([one.name, size, far, *_na(shape.ravel())] for one, size, far, shape in sizes)
        write_table(folder / "shapes_wide.csv", head, rows)
    else:
        to_look_at.append(("all", f"no superposition: {why}"))
    root_areas = np.sqrt([one.mesh.area for one in found.specimens])
    for name, times in in_other_units([one.name for one in found.specimens], root_areas).items():
        to_look_at.append((name, f"{times:.3g} times as large as the median: in other units?"))
    to_look_at += _reasons(found, np.full(len(places), np.nan) if laid is None else laid.distances)
    write_table(folder / "to_look_at.csv", ["specimen", "why"], to_look_at)
    return to_look_at


def _laid(places: Floats) -> tuple[Superposition | None, str]:
    """The superposition of configurations (s, k, 3), and why there is none."""
    try:
        return superimposed(places), ""
    except BadArgument as error:
        return None, str(error)


def _na(values: Floats) -> list[object]:
    return ["NA" if np.isnan(value) else value for value in values.tolist()]


def _long(found: Landmarked, places: Floats, *, confidence: bool = False) -> Iterator[list[object]]:
    """A row for every landmark of every specimen."""
    for one, configuration in zip(found.specimens, places, strict=True):
        for i, name in enumerate(found.names):
            more = [_rounded(one.confidence[i]), int(one.valid[i])] if confidence else []
            yield [one.name, name, *_na(configuration[i]), *more]


def _rounded(value: float) -> str:
    return "NA" if np.isnan(value) else f"{value:.4f}"


def _tps(found: Landmarked, places: Floats) -> str:
    blocks = []
    for one, configuration in zip(found.specimens, places, strict=True):
        rows = [" ".join(map(repr, at.tolist()) if np.isfinite(at).all() else NOWHERE) for at in configuration]
        blocks.append("\n".join([f"LM3={len(rows)}", *rows, f"ID={one.name}", ""]))
    return "\n".join(blocks)


def _reasons(found: Landmarked, distance: Floats) -> Iterator[tuple[str, str]]:
    """Who needs a look, and why; the template does not."""
    usual = np.nanmedian(distance) if np.isfinite(distance).any() else np.nan
    for one, far in zip(found.specimens[1:], distance[1:], strict=True):
        if one.status is not MatchStatus.GOOD:
            yield one.name, f"{one.status.name}: {one.status.value}"
        for text, rows in (
            ("no counterpart on the specimen", found.marks.defined & ~one.valid),
            (f"confidence below {DOUBTFUL}", one.valid & (one.confidence < DOUBTFUL)),
        ):
            if rows.any():
                yield one.name, f"{text}: {', '.join(found.names[i] for i in np.flatnonzero(rows))}"
        if far > FAR * usual:
            yield one.name, f"{far / usual:.1f} times the median distance from the mean shape"
