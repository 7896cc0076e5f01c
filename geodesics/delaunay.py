"""The intrinsic Delaunay triangulation: the same surface, divided into triangles along other straight edges."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geodesics._kernels import flips
from geodesics.arrays import Floats, Integers
from geodesics.caching import memoized
from geodesics.intrinsic import squared_lengths
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.moved_paths import names_moved
from geodesics.topology.edges import edge_keys, proper_faces, twice_given


class IntrinsicTriangulation(NamedTuple):
    """Faces (m, 3) over the mesh's own vertices and their squared edge lengths (m, 3), edge k opposite corner k."""

    faces: Integers
    l_sq: Floats


class GluedTriangulation(NamedTuple):
    """Triangles with their neighbours: faces (m, 3) and edge lengths (m, 3), edge k opposite corner k.

    `origin` (m,) is the mesh face each row began as. `twin` (3 m,) is the other half-edge (3 * face + corner opposite)
    of an edge with exactly two faces that agree, else -1. `direction` (m, 3) is the angle of the edge from each corner
    to the next, summed round the vertex from some first edge, and `whole` (n,) is that sum over one closed ring of
    faces, else inf (signposts: Sharp, Soliman, Crane 2019, not rescaled to 2 pi). Two faces may join the same vertices.
    """

    faces: Integers
    lengths: Floats
    origin: Integers
    twin: Integers
    direction: Floats
    whole: Floats


@of_a_mesh
@memoized
def intrinsic_delaunay(mesh: Mesh) -> IntrinsicTriangulation:
    """The intrinsic Delaunay triangulation, by edge flips; the surface and all distances on it stay the same.

    Works on any mesh: edges with one or more than two faces stay, faces that name a vertex twice and copies of a face
    are left out, and triangles of zero area are first made barely proper by lengthening every edge by the same 1e-9 or
    so of the mean.

    Parameters
    ----------
    mesh : Mesh
        The surface.

    Returns
    -------
    faces : int array of shape (m, 3)
        Triangles over the vertices of the mesh.
    l_sq : array of shape (m, 3)
        Their squared edge lengths along the surface; column k is the edge opposite corner k.

    References
    ----------
    Fisher, Springborn, Schroeder, Bobenko: An algorithm for the construction of intrinsic Delaunay triangulations
    (2007); Sharp, Crane: A Laplacian for nonmanifold triangle meshes (2020).

    See Also
    --------
    stiffness : Assembled on these triangles for conformal metrics.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.intrinsic_delaunay(sphere).faces.shape
    (320, 3)
    """
    delaunay = glued_delaunay(mesh)
    return IntrinsicTriangulation(delaunay.faces, delaunay.lengths**2)


@memoized
def glued_delaunay(mesh: Mesh) -> GluedTriangulation:
    """The intrinsic Delaunay triangulation with neighbours and directions."""
    start = glued_faces(mesh)
    faces, lengths = start.faces.copy(), start.lengths.copy()
    twin, direction = start.twin.copy(), start.direction.copy()
    flips.flip_to_delaunay(faces, lengths, twin, direction, 100 * len(twin) + 1000)
    direction = wrapped(direction, start.whole[faces])
    return GluedTriangulation(faces, lengths, start.origin, twin, direction, start.whole)


@memoized
def glued_faces(mesh: Mesh) -> GluedTriangulation:
    """The mesh's own proper triangles, no edge flipped, with neighbours and directions."""
    origin = proper_faces(mesh.faces)
    faces = mesh.faces[origin]
    return glued(faces, mollified(np.sqrt(squared_lengths(mesh.vertices, faces))), origin, mesh.n_vertices)


def mollified(lengths: Floats, relative: float = 1e-9) -> Floats:
    """Lengths (m, 3) plus the least constant that makes all triangle inequalities hold with a margin."""
    if len(lengths) == 0:
        return lengths
    excess = 2 * lengths.max(axis=1) - lengths.sum(axis=1)
    return np.ascontiguousarray(lengths + max(0.0, relative * lengths.mean() + excess.max()))


def glued(faces: Integers, lengths: Floats, origin: Integers, n: int) -> GluedTriangulation:
    """Find twins, turn faces so that neighbours agree, and measure directions."""
    twin = twins(faces)
    turn = flips.orientation(faces, twin)
    half_edge = np.arange(3 * len(faces)).reshape(-1, 3)
    half_edge[turn, 1:] = half_edge[turn, :0:-1]
    renamed = np.append(half_edge.ravel(), -1)  # -1 stays -1
    turned_twin = np.empty_like(twin)
    turned_twin[half_edge.ravel()] = renamed[twin]
    faces, lengths = faces.copy(), lengths.copy()
    faces[turn, 1:] = faces[turn, :0:-1]
    lengths[turn, 1:] = lengths[turn, :0:-1]
    direction, whole = np.zeros(faces.shape), np.full(n, np.inf)
    flips.signposts(faces, lengths, turned_twin, direction, whole)
    return GluedTriangulation(faces, lengths, origin, turned_twin, direction, whole)


def twins(faces: Integers) -> Integers:
    """For each half-edge (3 m,) the other one on an edge with exactly two faces, else -1."""
    keys = edge_keys(np.roll(faces, -1, axis=1), np.roll(faces, -2, axis=1), int(faces.max(initial=0)) + 1).ravel()
    one, other = twice_given(keys)
    twin = np.full(len(keys), -1, dtype=np.int64)
    twin[one], twin[other] = other, one
    return twin


def wrapped(direction: Floats, whole: Floats) -> Floats:
    """Directions taken modulo the whole angle of their vertex, where that is finite."""
    return np.where(np.isfinite(whole), np.mod(direction, np.where(np.isfinite(whole), whole, 1.0)), direction)


__getattr__ = names_moved(__name__, ("geodesics.topology.edges",))
