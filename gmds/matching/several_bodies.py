"""A match of meshes of several bodies: each with its partner, as `match` does it, and what is told of the rest."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.closest import closest_on_triangles
from geodesics.errors import Note
from geodesics.io.precision import median_edge
from geodesics.repair.repairing import inverse_index
from geodesics.topology.components import boundary_vertices, component_areas
from gmds.correspondence import Correspondence
from gmds.landmarks.placed import PlacedLandmarks
from gmds.maps.point_map import MatchStatus
from gmds.matching.bodies import BODY, MOST_BODIES, Body, matched_bodies
from gmds.matching.clean_copies import cleaning_notes, on_given
from gmds.surface.measured import Surface

Report = Callable[[str, float], None]

# A mesh falls apart where pieces that are too small to be matched have more than this share of its area, or where most
# of the boundary of a body is nearer to others than half an edge. Set by hand.
MOST_SMALL = 0.1
BESIDE = 0.5


def match_bodies(
    match: Callable[..., Correspondence],
    bodies: tuple[Sequence[Body], Sequence[Body]],
    whole: tuple[Surface, Surface],
    placed: PlacedLandmarks | None,
    n_samples: int | None,
    options: dict[str, Any],
    report: Report,
) -> Correspondence:
    """The map of all bodies that have a partner, between the meshes that were given (see `matched_bodies`)."""
    started = time.perf_counter()

    def each(ours: Body, theirs: Body) -> Correspondence:
        count = None if n_samples is None else min(n_samples, len(ours.vertices))
        landmarks = None if placed is None else _landmarks(placed, (ours, theirs), whole)
        pair = ours.surface, theirs.surface
        return match(*pair, n_samples=count, landmarks=landmarks, progress=report, **options)

    answer, alone, without = matched_bodies(*bodies, whole, each)
    answer = on_given(answer, *whole)
    notes = [*cleaning_notes(*whole), *_left_out(bodies[0], alone, "source"), *_left_out(bodies[1], without, "target")]
    more = beyond(bodies, whole)
    notes += more
    if placed is not None:
        answer, missed = placed.applied(answer)
        notes += [*placed.notes, *missed]
    status = incomplete(answer.status) if alone or without or more else answer.status
    told = [*answer.meta.get("notes", ()), *map(str, notes)]
    meta = {**answer.meta, "notes": told, "seconds": round(time.perf_counter() - started, 3)}
    return replace(answer, status=status, meta=meta)


def incomplete(status: MatchStatus) -> MatchStatus:
    """That status, at best INCOMPLETE."""
    return max(status, MatchStatus.INCOMPLETE, key=lambda one: one.rank)


def beyond(bodies: tuple[Sequence[Body], Sequence[Body]], whole: tuple[Surface, Surface]) -> list[Note]:
    """The notes on bodies that no partner is looked for: beyond the largest, of too few vertices, or small but many."""
    notes = []
    for found, surface, name in zip(bodies, whole, ("source", "target"), strict=True):
        area = component_areas(surface.original)
        count = int((area >= BODY * area.max()).sum())
        if count > len(found):
            message = (
                f"{count - len(found)} of {count} bodies of the {name} were not looked at, as only the "
                f"{MOST_BODIES} largest of enough vertices are: split the mesh, and match the pieces"
            )
            notes.append(Note("W305", "warning", message, (), count - len(found)))
        small = area < BODY * area.max()
        if (share := area[small].sum() / area.sum()) > MOST_SMALL:
            message = (
                f"the {name} falls apart into pieces: {int(small.sum())} that are too small to be matched have "
                f"{share:.0%} of its area; join them, and match again"
            )
            notes.append(Note("W305", "warning", message, (), int(small.sum())))
    return notes


def _left_out(bodies: Sequence[Body], alone: Sequence[int], name: str) -> list[Note]:
    """The note on bodies without a partner."""
    if not alone:
        return []
    share = sum(bodies[i].area for i in alone) / sum(one.area for one in bodies)
    first = tuple(int(bodies[i].vertices[0]) for i in alone)
    rows = "its vertices are not valid" if name == "source" else "nothing is sent there"
    message = (
        f"{len(alone)} of {len(bodies)} bodies of the {name} ({share:.0%} of their area, at vertices "
        f"{', '.join(map(str, first))}) have no partner in the other mesh: {rows}{_torn(bodies, alone)}"
    )
    return [Note("W305", "warning", message, first, len(alone))]


def _torn(bodies: Sequence[Body], alone: Sequence[int]) -> str:
    """What is said where bodies that are left out lie along others: the mesh may be one body in pieces."""
    mesh = bodies[0].surface.original
    gaps = []
    for i in alone:
        others = np.vstack([one.surface.original.faces for j, one in enumerate(bodies) if j != i])
        ends = mesh.vertices[boundary_vertices(bodies[i].surface.original)]
        gaps.append(closest_on_triangles(ends, mesh.vertices, others)[2])
    gap = np.concatenate(gaps)
    beside = gap < BESIDE * median_edge(mesh)
    if not len(gap) or beside.mean() < BESIDE:
        return ""
    share = gap[beside].max() / float(np.ptp(mesh.vertices[np.unique(mesh.faces)], axis=0).max())
    return f"; they lie along the others, at most {share:.1g} of the extent away: if that is a tear, join them"


def _landmarks(
    placed: PlacedLandmarks, pair: tuple[Body, Body], whole: tuple[Surface, Surface]
) -> PlacedLandmarks | None:
    """The landmarks that lie on both bodies; None where none does."""
    sides = placed.on_source, placed.on_target
    found = [_on_body(*one) for one in zip(sides, pair, whole, strict=True)]
    both = np.flatnonzero((found[0][0] >= 0) & (found[1][0] >= 0))
    if not len(both):
        return None
    halves = [
        SurfacePoints(body.surface.original, face[both], weights[both])
        for body, (face, weights) in zip(pair, found, strict=True)
    ]
    return PlacedLandmarks(halves[0], halves[1], placed.tolerance[both], told=False, rows=both)


def _on_body(points: SurfacePoints, body: Body, whole: Surface) -> tuple[Integers, Floats]:
    """Faces (p,) of a body, -1 for others, and coordinates (p, 3) in them, of points of the mesh that was given."""
    face, weights = (points.face, points.barycentric) if whole.clean is None else whole.clean.of_given(points)
    row = inverse_index(body.faces, whole.original.n_faces)
    return np.where(face >= 0, row[face], -1), weights
