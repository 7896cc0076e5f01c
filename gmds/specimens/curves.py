"""Points of curves as semilandmarks: on every specimen they slide along their curve, and stay on its surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from geodesics.arrays import Bools
from geodesics.errors import BadArgument
from gmds.landmarks.files.named_points import PointList
from gmds.morphometrics.sliding import Criterion, slide_all
from gmds.specimens.carried import Landmarked

FEWEST = 5  # landmarks that all specimens have: four leave a thin-plate spline without anything to bend


def curve_triples(lists: Sequence[PointList]) -> list[tuple[int, int, int]]:
    """Of each point of a curve that can slide, (the one before, it, the one after): not of the ends of an open one."""
    found, start = [], 0
    for one in lists:
        at = range(start, start + one.size)
        start += one.size
        if one.kind == "ClosedCurve" and one.size > 2:
            found += [(at[i - 1], at[i], at[(i + 1) % one.size]) for i in range(one.size)]
        elif "Curve" in one.kind:
            found += [(at[i - 1], at[i], at[i + 1]) for i in range(1, one.size - 1)]
    return found


def with_slid_curves(found: Landmarked, by: Criterion) -> Landmarked:
    """The collection with the points of its curves slid, by bending energy or by Procrustes distance.

    Landmarks that some specimen lacks have no say, and stay; so do points of a curve beside one. Raises `BadArgument`
    (E604) where there is no curve, or not enough that all specimens have.
    """
    triples = curve_triples(found.marks.lists)
    if not triples:
        raise BadArgument("there is no curve whose points could slide; a curve of 3D Slicer (.mrk.json) is one")
    whole: Bools = np.all([one.valid for one in found.specimens], axis=0)
    used = np.flatnonzero(whole)
    number = {int(row): i for i, row in enumerate(used)}
    curves = [tuple(number[i] for i in triple) for triple in triples if whole[list(triple)].all()]
    if len(used) < FEWEST or not curves:
        raise BadArgument(f"all specimens have {len(used)} landmarks, and {len(curves)} points of curves, to slide by")
    places = np.stack([one.positions[used] for one in found.specimens])
    meshes = [one.mesh for one in found.specimens]
    moved = slide_all(places, curves=curves, meshes=meshes, by=by)  # type: ignore[arg-type]
    specimens = []
    for one, rows in zip(found.specimens, moved, strict=True):
        positions = one.positions.copy()
        positions[used] = rows
        specimens.append(replace(one, positions=positions))
    return replace(found, specimens=tuple(specimens))
