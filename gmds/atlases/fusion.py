"""Where the vertices of a template are on a specimen, from all that several templates say."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.closest import closest_on_triangles
from gmds.correspondence import Correspondence

STEPS = 20  # of the geometric median, a bound
NEAR = 1e-3  # root areas: nearer than this two places are one


class Fused(NamedTuple):
    """Places (n, 3) on the specimen, which of them there are, and how far what was said is from them (n,)."""

    places: Floats
    valid: Bools
    spread: Floats


def fused(said: list[Correspondence]) -> Fused:
    """The geometric median of where maps from one template, direct or through others, send its vertices.

    It heeds the majority and not how far off the others are (Weiszfeld 1937), and is brought onto the specimen. Valid
    is what most maps say is there. `spread` is the mean distance from it over the root of the area; NaN for one map.
    """
    target = said[0].target
    if len(said) == 1:
        return Fused(said[0].points.positions, said[0].valid, np.full(len(said[0].valid), np.nan))
    places = np.stack([one.points.positions for one in said])
    there = np.stack([one.valid for one in said])
    size = float(np.sqrt(target.area))
    weight = np.where(there.any(axis=0), there, True).astype(np.float64)
    middle = (weight[..., None] * places).sum(axis=0) / weight.sum(axis=0)[:, None]
    for _ in range(STEPS):
        pull = weight / np.maximum(np.linalg.norm(places - middle, axis=2), NEAR * size)
        middle = (pull[..., None] * places).sum(axis=0) / pull.sum(axis=0)[:, None]
    on = SurfacePoints.closest(target, middle).positions
    spread = (weight * np.linalg.norm(places - on, axis=2)).sum(axis=0) / weight.sum(axis=0) / size
    return Fused(on, there.sum(axis=0) * 2 > len(said), spread)


def gap_of(specimen: Mesh, places: Floats, faces: Integers, valid: Bools) -> float:
    """The mean distance of a specimen's vertices from the registered surface, over the root of the area, or NaN."""
    kept = faces[valid[faces].all(axis=1)]
    if not len(kept):
        return float("nan")
    used = np.unique(specimen.faces)
    return float(closest_on_triangles(specimen.vertices[used], places, kept)[2].mean() / np.sqrt(specimen.area))
