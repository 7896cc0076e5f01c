"""Extremities that a cut leaves where they are: tips of limbs, but not the corners of a boundary."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.repair.capping import capped
from geodesics.topology.components import boundary_vertices
from geodesics.topology.edges import edges
from gmds.surface.measured import Surface

# Chosen on the development half of the PFAUST pairs (benchmarks/results/notes.md, "Parts"), but for what is said.
SAMPLES = 80  # between which distances are averaged: twice as many move no extremity
PERSISTENCE = 0.06  # of the range of the mean distance, by which a maximum must stand out: fingers do, wrinkles do not
RINGS = 2  # of faces around the boundary in which a maximum is an effect of the cut
APART = 0.12  # root areas between two extremities that count as two
# Root areas around a hole that distances cross: 2 found one pair more of the development half than 0, 0.5 or 1, and the
# others as well or better.
LONGEST_HOLE = 2.0
MOST = 9  # extremities, the farthest ones: the search grows with the square of their number


class Anchors(NamedTuple):
    """Vertices (k,) and the geodesic distances (k, n) of all vertices from each, on a surface of unit area."""

    vertices: Integers
    distances: Floats


@memoized
def inner_extremities(surface: Surface) -> Anchors:
    """Vertices farther from all others, in mean geodesic distance, than those around them, and not beside a boundary.

    A maximum counts when it stands out: by persistence (Edelsbrunner, Letscher, Zomorodian 2002). The mean distance
    changes when a part is cut off, but not where its maxima are.
    """
    return _extremities(surface, near_boundary(surface.mesh))


@memoized
def all_extremities(surface: Surface) -> Anchors:
    """`inner_extremities`, and those beside a boundary: tips of hands that are seen from one side, corners of cuts."""
    return _extremities(surface, np.zeros(surface.mesh.n_vertices, dtype=np.bool_))


def _extremities(surface: Surface, not_here: Bools) -> Anchors:
    """Extremities that are apart, the farthest first, but for those at vertices (n,) where there may be none."""
    mesh = surface.mesh
    distance = distances_across(mesh)
    usable, samples = surface.regular.usable, surface.regular.samples(SAMPLES)
    fields = distance(samples)
    share = np.bincount(fields[:, usable].argmin(axis=0), surface.areas[usable], len(samples))
    mean = np.asarray(share @ np.where(np.isfinite(fields), fields, 0.0), dtype=np.float64)
    peaks = persistent_maxima(mesh, mean, PERSISTENCE * float(np.ptp(mean[usable])))
    peaks = peaks[~not_here[peaks]]
    if len(peaks) == 0:
        return Anchors(peaks, np.zeros((0, mesh.n_vertices)))
    fields = distance(peaks)
    kept: list[int] = []
    for row, peak in enumerate(peaks):
        if len(kept) < MOST and all(fields[other, peak] > APART for other in kept):
            kept.append(row)
    return Anchors(peaks[kept], finite(fields[kept]))


def with_interior(surface: Surface, count: int) -> tuple[Anchors, Bools]:
    """The extremities with `count` points evenly spread over the rest, and which of all are extremities (k + count,).

    A part may have no extremity of its own; points in its middle have no counterpart among a few of the whole, but one
    nearby.
    """
    tips, mesh = inner_extremities(surface), surface.mesh
    samples = surface.regular.samples(SAMPLES)
    samples = samples[~near_boundary(mesh)[samples]]
    spread = tips.distances.min(axis=0, initial=np.inf) if len(tips.vertices) else np.full(mesh.n_vertices, np.inf)
    distance, chosen, fields = distances_across(mesh), [], []
    for _ in range(min(count, len(samples))):
        vertex = int(samples[spread[samples].argmax()])
        field = finite(distance(np.array([vertex])))[0]
        chosen.append(vertex)
        fields.append(field)
        spread = np.minimum(spread, field)
    anchors = Anchors(
        np.concatenate([tips.vertices, np.array(chosen, dtype=np.int64)]), np.vstack([tips.distances, *fields])
    )
    return anchors, np.arange(len(anchors.vertices)) < len(tips.vertices)


def distances_across(mesh: Mesh) -> Callable[[Integers], Floats]:
    """Geodesic distances (k, n) from vertices (k,) of a surface of unit area, across its holes."""
    whole = capped(mesh, LONGEST_HOLE)
    distance = GeodesicDistance(embedded(whole))
    return lambda vertices: distance.field(SurfacePoints.at_vertices(whole, vertices))[:, : mesh.n_vertices]


def finite(distances: Floats) -> Floats:
    """Distances with those to other components made farther than all else, so that sums of them can be compared."""
    known = distances[np.isfinite(distances)]
    return np.where(np.isfinite(distances), distances, 2 * float(known.max(initial=1.0)))


def persistent_maxima(mesh: Mesh, values: Floats, least: float) -> Integers:
    """Maxima (k,) of values per vertex (n,) that are higher by `least` than the pass to a higher one; highest first.

    Vertices are added from the highest down; where two components meet, the one with the lower maximum ends, and its
    maximum stood out by the difference of the two values.
    """
    ends = edges(mesh).ends
    order = np.argsort(-values, kind="stable")
    rank = np.empty(len(values), dtype=np.int64)
    rank[order] = np.arange(len(values))
    lower = np.maximum(rank[ends[:, 0]], rank[ends[:, 1]])
    upper = np.minimum(rank[ends[:, 0]], rank[ends[:, 1]])
    parent, used = np.arange(len(values)), np.zeros(len(values), dtype=bool)
    used[rank[mesh.faces]] = True
    maxima = {}

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = int(parent[i])
        return i

    for edge in np.lexsort((upper, lower)):
        low, high = root(int(lower[edge])), root(int(upper[edge]))
        if low == high:
            continue
        first, second = min(low, high), max(low, high)  # ranks: the smaller is the higher maximum
        if values[order[second]] - values[order[lower[edge]]] > least:
            maxima[second] = True
        parent[second] = first
    highest = {root(int(i)) for i in np.flatnonzero(used)}
    return order[sorted({*maxima, *highest})]


def near_boundary(mesh: Mesh) -> Bools:
    """Whether a vertex (n,) is on the boundary or within `RINGS` faces of it."""
    near = boundary_vertices(mesh).copy()
    for _ in range(RINGS):
        near[mesh.faces[near[mesh.faces].any(axis=1)]] = True
    return near
