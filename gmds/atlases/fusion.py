"""Where the vertices of a template are on a specimen, from all that several templates say."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.closest import closest_on_triangles
from gmds.atlases.sheets import closest_facing
from gmds.correspondence import Correspondence

STEPS = 20  # of the geometric median, a bound
NEAR = 1e-3  # root areas: nearer than this two places are one
LEAST_SURE, MOST_SURE = 0.02, 0.98  # bounds of a confidence, so that no account is worth nothing, or all

SURE = -np.log1p(-MOST_SURE)  # trust in what is known


class Said(NamedTuple):
    """Where the vertices of the template are by one account (n, 3), which there are, and how far to trust it (n,)."""

    places: Floats
    valid: Bools
    trust: Floats

    @classmethod
    def by(cls, answer: Correspondence) -> Said:
        """What a map says: of points whose errors are normal of one width, its confidence is that of a precision."""
        sure = np.where(np.isfinite(answer.confidence), answer.confidence, MOST_SURE)
        return cls(answer.points.positions, answer.valid, -np.log1p(-np.clip(sure, LEAST_SURE, MOST_SURE)))


class Fused(NamedTuple):
    """Places (n, 3) on the specimen, which of them there are, how far what was said is from them, and trust (n,)."""

    places: Floats
    valid: Bools
    spread: Floats
    trust: Floats

    @classmethod
    def as_it_is(cls, mesh: Mesh) -> Fused:
        """Where the points of a template are on itself."""
        there = np.isin(np.arange(mesh.n_vertices), mesh.faces)
        return cls(mesh.vertices, there, np.full(mesh.n_vertices, np.nan), np.full(mesh.n_vertices, SURE))


def fused(said: Sequence[Said], target: Mesh, normals: Floats | None = None) -> Fused:
    """The geometric median of what several accounts say, weighted by trust.

    It heeds the majority and not how far off the others are (Weiszfeld 1937), and is brought onto the specimen, where
    that faces as `normals` (n, 3) do, if they are given. Valid is what most accounts say is there. `spread` is the mean
    distance from it over the root of the area; NaN for one account. Trust is that of the account trusted most.
    """
    if len(said) == 1:
        return Fused(said[0].places, said[0].valid, np.full(len(said[0].valid), np.nan), said[0].trust)
    places = np.stack([one.places for one in said])
    there = np.stack([one.valid for one in said])
    trust = np.stack([one.trust for one in said])
    size = float(np.sqrt(target.area))
    weight = np.where(there.any(axis=0), there, True) * trust
    middle = (weight[..., None] * places).sum(axis=0) / weight.sum(axis=0)[:, None]
    for _ in range(STEPS):
        pull = weight / np.maximum(np.linalg.norm(places - middle, axis=2), NEAR * size)
        middle = (pull[..., None] * places).sum(axis=0) / pull.sum(axis=0)[:, None]
    on = SurfacePoints(target, *closest_facing(middle, normals, target.vertices, target.faces)).positions
    spread = (weight * np.linalg.norm(places - on, axis=2)).sum(axis=0) / weight.sum(axis=0) / size
    return Fused(on, there.sum(axis=0) * 2 > len(said), spread, (weight * there).max(axis=0))


def gap_of(specimen: Mesh, places: Floats, faces: Integers, valid: Bools) -> float:
    """The mean distance of a specimen's vertices from the registered surface, over the root of the area, or NaN."""
    kept = faces[valid[faces].all(axis=1)]
    if not len(kept):
        return float("nan")
    used = np.unique(specimen.faces)
    return float(closest_on_triangles(specimen.vertices[used], places, kept)[2].mean() / np.sqrt(specimen.area))
