"""Copies of a clean mesh with the faults that meshes have; the first vertices are those of the clean one, in order.

Each function takes a mesh and a generator of random numbers and returns the copy. Vertices are added behind the old
ones and none is moved, so that the truth of the clean pair is that of the copy.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from geodesics import Mesh, embedded
from geodesics.arrays import Bools, Floats, Integers
from geodesics.topology.edges import edge_ends, edge_keys

FINS = 26  # as many edges of three faces as a published camel has
PARTS = 200  # floating, as in a segmented volume
CHARTS = 12  # of a texture


def pinched(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """Two sheets that meet in one vertex: one near another is replaced by it."""
    start = int(rng.integers(mesh.n_vertices))
    ring = set(mesh.faces[(mesh.faces == start).any(axis=1)].ravel())
    near = cKDTree(mesh.vertices).query(mesh.vertices[start], 60)[1]
    beyond = {v for one in ring for v in mesh.faces[(mesh.faces == one).any(axis=1)].ravel()}
    other = next(v for v in near if v not in beyond)
    return Mesh(mesh.vertices, np.where(mesh.faces == other, start, mesh.faces))


def bow_tie(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """A little pyramid that touches the surface in one vertex."""
    tip = int(rng.integers(mesh.n_vertices))
    corners = mesh.vertices[tip] + 0.02 * _size(mesh) * rng.standard_normal((3, 3))
    a, b, c = range(mesh.n_vertices, mesh.n_vertices + 3)
    return _with(mesh, corners, [[tip, a, b], [tip, b, c], [tip, c, a], [a, c, b]])


def fins(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """Edges of three faces: a triangle stands up from them."""
    face = rng.choice(mesh.n_faces, FINS, replace=False)
    corner = mesh.vertices[mesh.faces[face]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    length = np.linalg.norm(corner[:, 1] - corner[:, 0], axis=1) / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    tips = corner[:, :2].mean(axis=1) + normal * length[:, None]
    return _with(mesh, tips, np.column_stack([mesh.faces[face][:, :2], mesh.n_vertices + np.arange(FINS)]))


def walls(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """Faces inside that join an edge to a vertex on the other side of the body."""
    face = rng.choice(mesh.n_faces, 4, replace=False)
    far = rng.integers(mesh.n_vertices, size=4)
    return _with(mesh, np.empty((0, 3)), np.column_stack([mesh.faces[face][:, :2], far]))


def repeated(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """One face in a hundred twice, half of these turned."""
    face = rng.choice(mesh.n_faces, mesh.n_faces // 100, replace=False)
    again = mesh.faces[face]
    again = np.where(np.arange(len(face))[:, None] % 2 == 0, again, again[:, ::-1])
    return _with(mesh, np.empty((0, 3)), again)


def unwelded(mesh: Mesh, _: np.random.Generator) -> Mesh:
    """Every triangle with corners of its own."""
    return _parted(mesh, np.arange(mesh.n_faces))


def charts(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """Cut along the seams of a texture: vertices there are doubled."""
    seeds = rng.choice(mesh.n_vertices, CHARTS, replace=False)
    return _parted(mesh, cKDTree(mesh.vertices[seeds]).query(mesh.vertices[mesh.faces].mean(axis=1))[1])


def t_junctions(mesh: Mesh, _: np.random.Generator) -> Mesh:
    """The half of the faces in front is split in four; the edges of others that they meet are not."""
    front = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    return split_in_four(mesh, front > np.median(front))


def split_in_four(mesh: Mesh, chosen: Bools) -> Mesh:
    """With a vertex in the middle of each edge of the faces (m,) that are chosen, which come last."""
    a, b, c = mesh.faces[chosen].T
    n = mesh.n_vertices
    keys, name = np.unique(edge_keys(np.array([a, b, c]), np.array([b, c, a]), n), return_inverse=True)
    ab, bc, ca = n + name.reshape(3, -1)
    inner = np.concatenate([np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    places = np.vstack([mesh.vertices, mesh.vertices[edge_ends(keys, n)].mean(axis=1)])
    return Mesh(places, np.vstack([mesh.faces[~chosen], inner]))


def floating(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """Two hundred small tetrahedra around and in the body."""
    where = mesh.vertices[rng.integers(mesh.n_vertices, size=PARTS)]
    where = where + 0.03 * _size(mesh) * rng.standard_normal((PARTS, 3))
    corners = (where[:, None] + 0.01 * _size(mesh) * rng.standard_normal((PARTS, 4, 3))).reshape(-1, 3)
    first = mesh.n_vertices + 4 * np.arange(PARTS)[:, None, None]
    faces = first + np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    return _with(mesh, corners, faces.reshape(-1, 3))


def turned_faces(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """A third of the faces turned."""
    return Mesh(mesh.vertices, np.where(rng.random((mesh.n_faces, 1)) < 1 / 3, mesh.faces[:, ::-1], mesh.faces))


def everything(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """All of the faults that leave vertices joined, and charts."""
    for fault in (bow_tie, pinched, fins, repeated, floating, turned_faces, charts):
        mesh = fault(mesh, rng)
    return mesh


FAULTS: tuple[Callable[[Mesh, np.random.Generator], Mesh], ...] = (
    pinched,
    bow_tie,
    fins,
    walls,
    repeated,
    turned_faces,
    unwelded,
    charts,
    t_junctions,
    floating,
    everything,
)


def _size(mesh: Mesh) -> float:
    """The root of the area."""
    return float(np.sqrt(embedded(mesh).mass.sum()))


def _with(mesh: Mesh, vertices: Floats, faces: object) -> Mesh:
    return Mesh(np.vstack([mesh.vertices, vertices]), np.vstack([mesh.faces, np.asarray(faces)]))


def _parted(mesh: Mesh, part: Integers) -> Mesh:
    """Faces (m,) of different parts share no vertices; the first part at a vertex keeps its number."""
    n = mesh.n_vertices
    key = mesh.faces + n * np.asarray(part)[:, None]
    names, first, inverse = np.unique(key.ravel(), return_index=True, return_inverse=True)
    owner = mesh.faces.ravel()[first]
    number = np.full(len(names), -1)
    order = np.argsort(first, kind="stable")
    lead = order[np.unique(owner[order], return_index=True)[1]]
    number[lead] = owner[lead]
    rest = np.flatnonzero(number < 0)
    number[rest] = n + np.arange(len(rest))
    return Mesh(np.vstack([mesh.vertices, mesh.vertices[owner[rest]]]), number[inverse.reshape(-1)].reshape(-1, 3))
