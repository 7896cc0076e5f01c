"""Several bodies in one mesh: which goes with which, each pair matched by itself, and one map of all of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import cached_property
from geodesics.points import mixed
from geodesics.topology.components import component_areas, vertex_components
from gmds.comparison.profiles import distance_profile, least_distortion
from gmds.correspondence import Correspondence
from gmds.errors import TooFewVertices
from gmds.maps.point_map import Candidate, MatchStatus
from gmds.matching.changed_places import changed_places, doubted
from gmds.surface.measured import Surface, measured_as_it_is

# All set by hand. A part is a body of its own from this share of the area of the largest; of so many bodies of a mesh,
# the largest, partners are looked for; and so many pairs of the first body are matched before the others are placed, of
# which none may be less alike than the most alike by more than this factor (of the bound of `least_distortion`, and
# what is added to it).
BODY = 0.05
MOST_BODIES = 6
ANCHORS = 3
AS_ALIKE = (1.5, 0.02)


@dataclass(frozen=True, eq=False)
class Body:
    """A part of a mesh as a `surface` with the same vertices; `faces` are its rows of those of the whole."""

    surface: Surface
    faces: Integers
    area: float

    @cached_property
    def vertices(self) -> Integers:
        """Those on its faces."""
        return np.unique(self.surface.mesh.faces)

    @cached_property
    def center(self) -> Floats:
        """The mean of its vertices (3,), in coordinates of the mesh."""
        return np.asarray(self.surface.original.vertices[self.vertices].mean(axis=0))

    @cached_property
    def profile(self) -> Floats:
        """How distances are distributed on it."""
        return distance_profile(self.surface)


def bodies_of(surface: Surface) -> list[Body]:
    """The bodies of the original of a surface, the largest first."""
    mesh, area = surface.original, component_areas(surface.original)
    large = np.argsort(-area, kind="stable")
    large = large[area[large] >= BODY * area.max()][:MOST_BODIES]
    if len(large) < 2:
        alone = surface if surface.clean is None else replace(surface, clean=None)
        return [Body(alone, np.arange(mesh.n_faces), float(area.max()))]
    label = vertex_components(mesh)[mesh.faces[:, 0]]
    found = []
    for one in large:
        faces = np.flatnonzero(label == one)
        try:
            part = measured_as_it_is(Mesh(mesh.vertices, mesh.faces[faces]))
        except TooFewVertices:
            continue
        found.append(Body(part, faces, float(area[one])))
    return found


def matched_bodies(
    ours: Sequence[Body],
    theirs: Sequence[Body],
    whole: tuple[Surface, Surface],
    match: Callable[[Body, Body], Correspondence],
) -> tuple[Correspondence, list[int], list[int]]:
    """The map between the originals of two surfaces, made of those of their bodies; and the bodies without a partner.

    The largest body of the mesh with fewer is matched with those of the other that are about as much alike; the
    similarity that comes nearest to each map says where the other bodies would be, and the map for which they are there
    is kept. These are matched with what is there. Where the first body is far likelier to be another, by its shape,
    nothing tells whether bodies changed their shapes or their places: the map is AMBIGUOUS, and says so (W310).
    """
    swapped = len(ours) > len(theirs)
    few, many = (theirs, ours) if swapped else (ours, theirs)
    unlike = np.array([[least_distortion(a.profile, b.profile) for b in many] for a in few])
    likely = np.argsort(unlike[0], kind="stable")[:ANCHORS]
    likely = likely[unlike[0, likely] <= AS_ALIKE[0] * unlike[0].min() + AS_ALIKE[1]]
    begun: list[tuple[bool, float, int, Correspondence, tuple[Body, Body], list[tuple[Body, Body]]]] = []
    for j in likely:
        pair = (many[j], few[0]) if swapped else (few[0], many[j])
        answer = match(*pair)
        rest, gap = _partners(answer, pair, ours, theirs, unlike.T if swapped else unlike)
        begun.append((answer.status is MatchStatus.POOR, gap + unlike[0, j], len(begun), answer, pair, rest))
    *_, answer, pair, rest = min(begun, key=lambda one: one[:3])
    others = [(one[3], (int(one[4][0].vertices[0]), int(one[4][1].vertices[0]))) for one in begun]
    note = changed_places(answer, others)
    maps = [(pair, answer), *((two, match(*two)) for two in rest)]
    kept = [one for one in maps if one[1].status is not MatchStatus.POOR] or maps[:1]
    alone = [i for i, one in enumerate(ours) if all(one is not pair[0] for pair, _ in kept)]
    without = [j for j, one in enumerate(theirs) if all(one is not pair[1] for pair, _ in kept)]
    joined = _joined(kept, whole)
    return joined if note is None else doubted(joined, note), alone, without


def _partners(
    answer: Correspondence, pair: tuple[Body, Body], ours: Sequence[Body], theirs: Sequence[Body], unlike: Floats
) -> tuple[list[tuple[Body, Body]], float]:
    """The other bodies in pairs, and by how much they are not where the map of the first pair says.

    That is the mean distance of their centers in root areas of both first bodies, and how unlike they are.
    """
    rows = [i for i, one in enumerate(ours) if one is not pair[0]]
    columns = [j for j, one in enumerate(theirs) if one is not pair[1]]
    if not rows or not columns:
        return [], 0.0
    expected = _similarity(pair[0], answer)(np.array([ours[i].center for i in rows]))
    there = np.array([theirs[j].center for j in columns])
    far = np.linalg.norm(expected[:, None] - there, axis=2) / np.sqrt(pair[1].area)
    cost = far + unlike[np.ix_(rows, columns)]
    row, column = linear_sum_assignment(cost)
    return [(ours[rows[i]], theirs[columns[j]]) for i, j in zip(row, column, strict=True)], float(
        cost[row, column].mean()
    )


def _similarity(body: Body, answer: Correspondence) -> Callable[[Floats], Floats]:
    """The rotation, reflection where that fits better, scaling and shift that come nearest to the map of a body."""
    rows = body.vertices[answer.valid[body.vertices]]
    x, y = body.surface.original.vertices[rows], answer.points.positions[rows]
    here, there = x.mean(axis=0), y.mean(axis=0)
    u, stretch, v = np.linalg.svd((y - there).T @ (x - here))
    turn = u @ v * (stretch.sum() / max(float(((x - here) ** 2).sum()), np.finfo(float).tiny))
    return lambda points: (points - here) @ turn.T + there


def _joined(maps: Sequence[tuple[tuple[Body, Body], Correspondence]], whole: tuple[Surface, Surface]) -> Correspondence:
    """One map of the maps of pairs of bodies: rows of no body are those of the first, and not valid."""
    source, target = whole[0].original, whole[1].original
    (_, first) = maps[0]
    points, candidates = _on_whole(first.points, maps[0][0][1], target), first.candidates
    sent = [_on_whole(one.points, maps[0][0][1], target) for one in candidates]
    valid, distortion = first.valid & _on(maps[0][0][0], source), first.distortion.copy()
    confidence = first.confidence
    for (ours, theirs), answer in maps[1:]:
        here = _on(ours, source)
        there = _on_whole(answer.points, theirs, target)
        points, sent = mixed(here, there, points), [mixed(here, there, one) for one in sent]
        valid, distortion = np.where(here, answer.valid, valid), np.where(here, answer.distortion, distortion)
        confidence = np.where(here, answer.confidence, confidence)
    worst = max((answer.status for _, answer in maps), key=lambda status: status.rank)
    notes = [note for _, answer in maps for note in answer.meta.get("notes", ())]
    wrong = [one for _, answer in maps for one in answer.meta.get("evidence", {}).get("contradicted", ())]
    evidence = {"evidence": {**first.meta.get("evidence", {}), "contradicted": wrong}} if wrong else {}
    meta = {**first.meta, **evidence, "bodies": len(maps), "notes": list(dict.fromkeys(notes))}
    others = tuple(Candidate(there, one.stress, one.orientation) for there, one in zip(sent, candidates, strict=True))
    return replace(
        first,
        source=source,
        target=target,
        points=points,
        valid=valid,
        distortion=distortion,
        confidence=confidence,
        status=worst,
        candidates=others,
        meta=meta,
    )


def _on(body: Body, mesh: Mesh) -> Bools:
    mask = np.zeros(mesh.n_vertices, dtype=bool)
    mask[body.vertices] = True
    return mask


def _on_whole(points: SurfacePoints, body: Body, mesh: Mesh) -> SurfacePoints:
    """Points of the mesh of a body as points of the whole."""
    return SurfacePoints(mesh, body.faces[points.face], points.barycentric)
