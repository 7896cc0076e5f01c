"""Cutting a mesh apart where it is not a manifold: edges of more than two faces, vertices that join several fans."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.edges import Edges, components, corner_fans, degenerate_faces, edges
from geodesics.topology.orientation import orientation

ROUNDS = 8  # a bound: each round cuts what the one before left; in the last, faces at what is left stand alone


def split(mesh: Mesh) -> tuple[Mesh, Integers]:
    """A mesh of edges with at most two faces and vertices with one fan of them, and the old vertex of each new one.

    Faces keep their place and order, and so do vertices; copies of vertices come last. At an edge of more than two
    faces the two that continue each other most nearly flat, and do not clash in orientation, stay together, then the
    next two; the others are separated. Faces must name three different vertices (see `geodesics.repair.repair`).
    """
    faces, vertex = mesh.faces, np.arange(mesh.n_vertices)
    for turn in range(ROUNDS):
        now = Mesh(mesh.vertices[vertex], faces)
        table = edges(now)
        if (table.n_faces <= 2).all() and not several_fans(now).any():
            return (mesh if turn == 0 else now), vertex
        if turn == ROUNDS - 1:
            faces, vertex = _stand_alone(now, table, vertex)
        elif turn == 0:
            faces, vertex = _cut(now, table, *_flattest_pairs(now, table))
        else:
            faces, vertex = _separated(now, _fans(now, *table.pairs()), vertex)
    return Mesh(mesh.vertices[vertex], faces), vertex


def _cut(mesh: Mesh, table: Edges, left: Integers, right: Integers) -> tuple[Integers, Integers]:
    """Faces that stay joined at edges of two faces and at these pairs of sides, unless that makes them one-sided."""
    first, second = table.pairs()
    for _ in range(2):
        fans = _fans(mesh, np.concatenate([first, left]), np.concatenate([second, right]))
        faces, vertex = _separated(mesh, fans, np.arange(mesh.n_vertices))
        twisted = orientation(Mesh(mesh.vertices[vertex], faces)).one_sided
        if not twisted[left // 3].any():
            break
        kept = ~twisted[left // 3]
        left, right = left[kept], right[kept]
    return faces, vertex


@memoized
def several_fans(mesh: Mesh) -> Bools:
    """Vertices (n,) that join more than one fan of faces."""
    sound = ~degenerate_faces(mesh)
    _, first = np.unique(corner_fans(mesh)[sound], return_index=True)
    return np.asarray(np.bincount(mesh.faces[sound].ravel()[first], minlength=mesh.n_vertices) > 1)


def _flattest_pairs(mesh: Mesh, table: Edges) -> tuple[Integers, Integers]:
    """Pairs of sides (flat indices 3 * face + k) at edges of more than two faces, the flattest of each edge first."""
    side = np.flatnonzero(table.n_faces[table.of_side.ravel()] > 2)
    pairs = []
    for edge in np.unique(table.of_side.ravel()[side]):
        here = side[table.of_side.ravel()[side] == edge]
        bend = _bend(mesh, table.ends[edge], here)
        while len(here) > 1:
            i, j = np.unravel_index(int(bend.argmin()), bend.shape)
            pairs.append((here[i], here[j]))
            keep = np.delete(np.arange(len(here)), [i, j])
            here, bend = here[keep], bend[np.ix_(keep, keep)]
    left, right = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return left, right


def _bend(mesh: Mesh, ends: Integers, sides: Integers) -> Floats:
    """How badly each two faces at an edge continue each other: the cosine of their angle, seen along it, plus 2 if they
    clash.

    -1 is flat, 1 folded; faces clash when both run along the edge the same way. Infinite on the diagonal.
    """
    a, b = mesh.vertices[ends]
    along = (b - a) / max(float(np.linalg.norm(b - a)), np.finfo(float).tiny)
    away = mesh.vertices[mesh.faces[sides // 3, (sides % 3 + 2) % 3]] - a  # the corner off the side
    away = away - (away @ along)[:, None] * along
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), np.finfo(float).tiny)
    forward = mesh.faces.ravel()[sides] == ends[0]
    bend = away @ away.T + 2.0 * (forward[:, None] == forward)
    np.fill_diagonal(bend, np.inf)
    return np.asarray(bend)


def _fans(mesh: Mesh, left: Integers, right: Integers) -> Integers:
    """Fan of each corner (m, 3) when faces are joined at these pairs of sides only."""
    corner = np.arange(3 * mesh.n_faces)
    end = (corner // 3) * 3 + (corner + 1) % 3
    vertex = mesh.faces.ravel()
    same = vertex[left] == vertex[right]
    joined = np.concatenate([left, end[left]])
    to = np.concatenate([np.where(same, right, end[right]), np.where(same, end[right], right)])
    return components(joined, to, len(corner)).reshape(-1, 3)


def _separated(mesh: Mesh, fans: Integers, vertex: Integers) -> tuple[Integers, Integers]:
    """Faces with a vertex for every fan; the fan of the first face at a vertex keeps its number."""
    at = mesh.faces.ravel()
    _, first, inverse = np.unique(fans.ravel(), return_index=True, return_inverse=True)
    order = np.argsort(first)
    owner = at[first[order]]
    copies = np.ones(len(order), dtype=bool)
    copies[np.unique(owner, return_index=True)[1]] = False
    number = np.where(copies, len(vertex) + np.cumsum(copies) - 1, owner)
    place = np.empty(len(order), dtype=np.int64)
    place[order] = number
    return place[inverse.reshape(-1)].reshape(-1, 3), np.concatenate([vertex, vertex[owner[copies]]])


def _stand_alone(mesh: Mesh, table: Edges, vertex: Integers) -> tuple[Integers, Integers]:
    """Faces at what is still no manifold, each with vertices of its own."""
    crowded = (table.n_faces[table.of_side] > 2).any(axis=1) | several_fans(mesh)[mesh.faces].any(axis=1)
    faces = mesh.faces.copy()
    faces[crowded] = len(vertex) + np.arange(3 * int(crowded.sum())).reshape(-1, 3)
    return faces, np.concatenate([vertex, vertex[mesh.faces[crowded].ravel()]])
