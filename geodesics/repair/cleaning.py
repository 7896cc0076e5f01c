"""A clean copy of a mesh with faults: welded and sewn at seams, cut apart where no manifold, without what is loose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.defects import repeated_faces
from geodesics.intrinsic import areas, squared_lengths
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from geodesics.repair.repairing import inverse_index
from geodesics.repair.sewing import sewn
from geodesics.repair.splitting import several_fans, split
from geodesics.repair.welding import seam_welds
from geodesics.topology.components import component_areas, vertex_components
from geodesics.topology.edges import degenerate_faces, edges
from geodesics.topology.junctions import junctions
from geodesics.topology.orientation import orient_faces

# Share of the area of all that hangs together, below which a piece that comes off where the mesh is cut apart is left
# out: a fin, a membrane, a wall inside. Set by hand.
SMALL_PIECE = 0.05
# Share that all that is left out may have together, above which it is no such thing but the surface, in patches that
# hang together in corners: of 382 published meshes it has 0.08 at the most. Set by hand.
MOST_LEFT_OUT = 0.1


@dataclass(frozen=True, eq=False)
class CleanCopy:
    """The clean `mesh`, of n vertices and m faces, of one that was `given`.

    `vertex` (one per given vertex) is the vertex that it became, or the nearest where it is on a piece that was left
    out, -1 for none; `face` (m,) is the given face of each, whose corners come in the same order; `changes` says in
    words what was done. Where faces were split at T-junctions `corners` (m, 3, 3) says where in its given face each
    corner is, in barycentric coordinates.
    """

    given: Mesh
    mesh: Mesh
    vertex: Integers
    face: Integers
    changes: tuple[str, ...]
    corners: Floats | None = None

    @property
    def kept(self) -> Bools:
        """Whether each given vertex has a vertex of the clean mesh."""
        return np.asarray(self.vertex >= 0)

    @property
    def nearest(self) -> Integers:
        """For each given vertex that of `vertex`, and where there is none the nearest of all."""
        near = self.vertex.copy()
        lost = np.flatnonzero(near < 0)
        near[lost] = cKDTree(self.mesh.vertices).query(self.given.vertices[lost])[1]
        return near

    def on_given(self, points: SurfacePoints) -> SurfacePoints:
        """Points of the clean mesh as points of the given one."""
        weights = points.barycentric
        if self.corners is not None:
            weights = np.einsum("pi,pij->pj", weights, self.corners[points.face])
        return SurfacePoints(self.given, self.face[points.face], weights)

    def of_given(self, points: SurfacePoints) -> tuple[Integers, Floats]:
        """Faces (p,) of the clean mesh, -1 for none, and coordinates (p, 3) in them, of points of the given one."""
        face = inverse_index(self.face, self.given.n_faces)[points.face]
        weights = points.barycentric.copy()
        if self.corners is not None:
            for i in np.flatnonzero(np.isin(points.face, self.face[(self.corners != np.eye(3)).any(axis=(1, 2))])):
                pieces = np.flatnonzero(self.face == points.face[i])
                inside = points.barycentric[i] @ np.linalg.inv(self.corners[pieces])
                best = inside.min(axis=1).argmax()
                face[i], weights[i] = pieces[best], np.maximum(inside[best], 0) / np.maximum(inside[best], 0).sum()
        return face, weights


@memoized
def cleaned(mesh: Mesh) -> CleanCopy | None:
    """The clean copy of a mesh; None where open edges do not lie on each other, and it is a manifold.

    Vertices at one position that lie on open edges are welded, repeated and degenerate faces dropped, open edges split
    at vertices that lie on them, edges of more than two faces and vertices of several fans taken apart. What came off
    by that is left out where it is small, and joined again in single vertices where it is not; parts that did not hang
    together before stay.
    """
    stand = seam_welds(mesh)
    welded = int((stand != np.arange(mesh.n_vertices)).sum())
    if not welded and _is_manifold(mesh) and not len(junctions(mesh)):
        return None
    face, hanging = _proper(mesh, stand, welded > 0)
    if not len(face):
        return None  # nothing but needles: whoever measures it says so
    dropped = mesh.n_faces - len(face)
    seamless = Mesh(mesh.vertices, stand[mesh.faces[face]])
    on_edges = len(np.unique(junctions(seamless).vertex))
    pieces, piece_of, corners = sewn(seamless)
    face = face[piece_of]
    used, compact = np.unique(pieces, return_inverse=True)
    whole = Mesh(mesh.vertices[used], compact.reshape(-1, 3))
    apart, copies = _apart(whole)
    loose = _loose(whole, apart)
    kept, compact = np.unique(_touching(apart, copies)[~loose], return_inverse=True)
    clean = Mesh(apart.vertices[kept], compact.reshape(-1, 3))
    vertex = inverse_index(used[copies[kept]], mesh.n_vertices)[stand]
    lost = hanging[vertex[hanging] < 0]
    vertex[lost] = cKDTree(clean.vertices).query(mesh.vertices[lost])[1]
    changes = _changes(welded, dropped, on_edges, whole, loose)
    split_at = corners[~loose] if on_edges else None
    return CleanCopy(mesh, clean, vertex, face[~loose], changes, split_at) if changes else None


def _proper(mesh: Mesh, stand: Integers, welded: bool) -> tuple[Integers, Integers]:
    """The faces (rows) that are not degenerate or repeated after welding, and the vertices that are on proper ones."""
    faces = stand[mesh.faces]
    face = np.flatnonzero(~degenerate_faces(Mesh(mesh.vertices, faces)))
    face = face[~repeated_faces(Mesh(mesh.vertices, faces[face]))] if len(face) else face
    hanging = np.unique(mesh.faces[face])
    if welded and len(face):
        face = face[~_on_each_other(Mesh(mesh.vertices, faces[face]))]
    return face, hanging


def _touching(apart: Mesh, copies: Integers) -> Integers:
    """The faces (m, 3), where pieces that came apart at a vertex are joined there again.

    Of the copies of a vertex that lie on one piece each is a vertex of its own.
    """
    piece = vertex_components(apart)
    _, first = np.unique(np.stack([copies, piece], axis=1), axis=0, return_index=True)
    _, leader, member = np.unique(copies[first], return_index=True, return_inverse=True)
    stand = np.arange(apart.n_vertices)
    stand[first] = first[leader[member.reshape(-1)]]
    return np.asarray(stand[apart.faces])


def _apart(mesh: Mesh) -> tuple[Mesh, Integers]:
    """As `split`, of consistently oriented faces, which are turned back after it: those that clash come apart."""
    oriented = orient_faces(mesh)
    turned = (oriented.faces != mesh.faces).any(axis=1, keepdims=True)
    apart, copies = split(oriented)
    return Mesh(apart.vertices, np.where(turned, apart.faces[:, [0, 2, 1]], apart.faces)), copies


def _is_manifold(mesh: Mesh) -> bool:
    return bool((edges(mesh).n_faces <= 2).all() and not several_fans(mesh).any())


def _on_each_other(mesh: Mesh) -> Bools:
    """Faces (m,) whose three corners are where those of an earlier one are: a sheet given for both sides."""
    _, site = np.unique(mesh.vertices, axis=0, return_inverse=True)
    corners = site.reshape(-1)[mesh.faces]
    proper = ~degenerate_faces(Mesh(mesh.vertices, corners))
    again = np.zeros(mesh.n_faces, dtype=bool)
    again[proper] = repeated_faces(Mesh(mesh.vertices, corners[proper])) if proper.any() else False
    return again


def _loose(whole: Mesh, apart: Mesh) -> Bools:
    """Small pieces (faces, (m,)) that came off the largest that they hung together with, if they are little in all."""
    before, after = vertex_components(whole)[whole.faces[:, 0]], vertex_components(apart)[apart.faces[:, 0]]
    size, total = component_areas(apart), component_areas(whole)
    parent = np.zeros(len(size), dtype=np.int64)
    parent[after] = before
    largest = np.zeros(len(size), dtype=bool)
    order = np.argsort(-size, kind="stable")
    largest[order[np.unique(parent[order], return_index=True)[1]]] = True
    small = ~largest & (size < SMALL_PIECE * total[parent])
    in_all = np.bincount(parent, size * small, minlength=len(total))
    return np.asarray((small & (in_all < MOST_LEFT_OUT * total)[parent])[after])


def _changes(welded: int, dropped: int, on_edges: int, whole: Mesh, loose: Bools) -> tuple[str, ...]:
    """What was done, in words."""
    area = areas(squared_lengths(whole.vertices, whole.faces))
    share = area[loose].sum() / max(area.sum(), np.finfo(float).tiny)
    counted = (
        (welded, "vertices at the position of others were welded"),
        (dropped, "repeated or degenerate faces were dropped"),
        (on_edges, "vertices on the edges of other faces (T-junctions) were sewn to them"),
        (int((edges(whole).n_faces > 2).sum()), "edges of more than two faces were cut apart"),
        (int(several_fans(whole).sum()), "vertices at which several fans of faces meet were doubled"),
        (int(loose.sum()), f"faces that came off by that ({share:.1%} of the area) were left out"),
    )
    return tuple(f"{number} {words}" for number, words in counted if number)
