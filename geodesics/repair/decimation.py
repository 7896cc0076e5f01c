"""A coarser mesh of the same surface, in one of four ways.

| function | made for | method | on a surface that it cannot reduce |
|---|---|---|---|
| `decimate` | users, who keep the mesh | quadric collapses, with index arrays between old and new | raises |
| `decimated` | computations on a coarse copy | collapses of the shortest edges | `clustered`, then cleaned |
| `clustered` | drawings of any mesh | vertices of one grid cell become one | there is none |
| `collapse` | even triangles | collapses, then edge flips and smoothing | callers give manifolds |
"""

from __future__ import annotations

import threading

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument, NotManifold, ZeroArea
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from geodesics.repair.cleaning import cleaned
from geodesics.repair.clustering import clustered
from geodesics.repair.repairing import Repaired, inverse_index, repair
from geodesics.repair.splitting import several_fans, split
from geodesics.repair.triangulation import flip_towards_delaunay
from geodesics.topology.components import boundary_vertices, component_areas
from geodesics.topology.edges import edges, proper_faces

# Times the faces wanted, and faces at the least, that a large mesh is first brought to: both set by hand, so that
# meshes of fewer than 40,000 vertices are copied as they always were.
BEGUN = 4
FEWEST_BEGUN = 40_000
MOST_LOST = 0.2  # share of a part that may come off it where it is cut apart; set by hand: published parts lose 0.12
_one_at_a_time = threading.Lock()  # fast_simplification keeps its mesh in variables that all threads share


def decimate(mesh: Mesh, n_faces: int) -> Repaired:
    """A coarser mesh by quadric edge collapses.

    Parameters
    ----------
    mesh : Mesh
        The mesh, which is repaired first (see `repair`).
    n_faces : int
        About how many faces to leave.

    Returns
    -------
    Repaired
        The coarser mesh; `vertex` and `face` say from which vertex and face of the old mesh each new one descends.

    Raises
    ------
    NotManifold
        E110 for edges of more than two faces, and for vertices of several fans of faces.
    ValueError
        When `n_faces` is not from 4 to the number of faces.

    References
    ----------
    Garland, Heckbert: Surface simplification using quadric error metrics (1997); computed by libigl.

    See Also
    --------
    remesh : Even triangles instead.
    """
    import igl

    if not 4 <= n_faces <= mesh.n_faces:
        raise BadArgument(f"n_faces must be from 4 to the {mesh.n_faces} of the mesh, not {n_faces}")
    start = repair(mesh)
    refuse_branching(start.mesh)
    center, size = center_and_size(start.mesh)
    v = (start.mesh.vertices - center) / size  # a unit-sized copy: quadrics do not underflow at any scale
    u, g, face, vertex = igl.qslim(v, start.mesh.faces.astype(np.int32), int(n_faces), False)
    if not len(g):  # as libigl has it, where it finds that vertices are no manifold
        fans = np.flatnonzero(several_fans(start.mesh))
        where = start.vertex[fans[:1]].tolist()
        raise NotManifold(f"{len(fans)} vertices join several fans of faces, first {where}; cut the mesh apart (--cut)")
    vertex, face = start.vertex[vertex], start.face[face]
    back = inverse_index(vertex, mesh.n_vertices), inverse_index(face, mesh.n_faces)
    return Repaired(Mesh(u * size + center, g), vertex, face, start.notes, *back)


def center_and_size(mesh: Mesh) -> tuple[Floats, float]:
    """Center and size of the vertices that lie on faces."""
    used = mesh.vertices[np.unique(mesh.faces)]
    return used.mean(axis=0), float(np.ptp(used, axis=0).max())


def refuse_branching(mesh: Mesh) -> None:
    """Raise `NotManifold` (E110) when an edge has more than two faces."""
    table = edges(mesh)
    many = np.flatnonzero(table.n_faces > 2)
    if len(many):
        ends = table.ends[many[0]].tolist()
        raise NotManifold(f"{len(many)} edges have more than two faces, first between vertices {ends}; repair the mesh")


def decimated(mesh: Mesh, n_faces: int) -> Mesh | None:
    """A mesh of about `n_faces` faces, by collapsing edges; None if there are few more.

    The shortest edges go first; a large mesh loses most of its faces by quadrics before. Where more than two faces or
    several fans meet, the coarse copy is cut apart first (see `split`). A surface with one side alone, one whose edges
    resist, and one of pieces that hang together in vertices alone, are clustered instead.
    """
    import igl

    used, faces = np.unique(mesh.faces[proper_faces(mesh.faces)], return_inverse=True)
    faces = faces.reshape(-1, 3).astype(np.int64)
    if len(faces) <= n_faces * 1.25:
        return None
    v, faces = _begun(mesh.vertices[used], faces, n_faces)
    if not _can_be_collapsed(faces):
        apart, _ = split(Mesh(v, faces))
        lost = 1 - component_areas(apart).max() / component_areas(Mesh(v, faces)).max()
        v, faces = apart.vertices, np.asarray(apart.faces)
        if lost > MOST_LOST or not _can_be_collapsed(faces):
            return _clustered_and_cleaned(mesh, n_faces)
    v, f, *_ = igl.decimate(np.ascontiguousarray(v), faces, n_faces)
    if len(f) == 0 or len(f) > 2 * n_faces:
        return _clustered_and_cleaned(mesh, n_faces)
    return Mesh(v, np.asarray(f, dtype=np.int64))


def _begun(v: Floats, faces: Integers, n_faces: int) -> tuple[Floats, Integers]:
    """Of very many faces some `BEGUN` times `n_faces`, left by quadric collapses in an eighth of the time of others.

    All of them where there are not so many, or where what is left is no manifold. Quadrics leave long, thin faces where
    a surface bends one way alone, over which collapses of the shortest edges would fold it: their edges are flipped.
    """
    import fast_simplification

    enough = max(BEGUN * n_faces, FEWEST_BEGUN)
    if len(faces) <= 2 * enough:
        return v, faces
    center, size = v.mean(axis=0), float(np.ptp(v, axis=0).max())
    unit = np.ascontiguousarray((v - center) / size)  # its thresholds are lengths
    with _one_at_a_time:
        places, few = fast_simplification.simplify(unit, faces.astype(np.int32), target_count=enough)
    used, few = np.unique(few, return_inverse=True)
    few = few.reshape(-1, 3).astype(np.int64)
    if not len(few) or not _can_be_collapsed(few):
        return v, faces
    begun = np.asarray(places[used] * size + center, dtype=np.float64)
    return begun, flip_towards_delaunay(begun, few)


def _clustered_and_cleaned(mesh: Mesh, n_faces: int) -> Mesh | None:
    """The mesh by clustering, cut apart where it then is no manifold; None where that has no area."""
    try:
        coarse = clustered(mesh, n_faces // 2)
    except ZeroArea:
        return None
    copy = cleaned(coarse)
    return coarse if copy is None else copy.mesh


def _can_be_collapsed(faces: Integers) -> bool:
    """Whether faces (m, 3) are a manifold with two sides: others make libigl take all memory or end the process."""
    import igl

    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    one_way = len(np.unique(directed, axis=0)) == len(directed)  # so that no edge has more than two faces
    return bool(one_way and np.all(igl.is_vertex_manifold(faces)))


def collapse(mesh: Mesh, n_vertices: int, *, adaptive: bool = False) -> tuple[Floats, Integers]:
    """Vertices (about n_vertices, 3) and faces of an even triangulation near the mesh, shortest edges collapsed first.

    `adaptive` collapses first what changes the surface least (quadric error, Garland and Heckbert 1997): triangles stay
    small where the surface is thin or sharply bent. There are exactly `n_vertices` on a closed surface of genus 0.
    Afterwards edges are flipped towards Delaunay and vertices moved to the middle of their neighbours; they lie near
    the surface, not on it.
    """
    import igl

    closed_faces = mesh.n_faces - 2 * (mesh.n_vertices - n_vertices)
    vertices, faces = np.asfortranarray(mesh.vertices), np.asfortranarray(mesh.faces.astype(np.int32))
    if adaptive:
        size = np.ptp(vertices, axis=0).max()  # a surface of any size: quadrics are compared with absolute numbers
        v, f = igl.qslim(np.asfortranarray(vertices / size), faces, int(closed_faces))[:2]
        v = size * v
    else:
        v, f = igl.decimate(vertices, faces, int(closed_faces))[:2]
    v, f = np.ascontiguousarray(v), np.ascontiguousarray(f, dtype=np.int64)
    inside = ~boundary_vertices(Mesh(v, f))
    for _ in range(3):
        f = flip_towards_delaunay(v, f)
        v[inside] = SurfacePoints.closest(mesh, _towards_neighbours(v, f)[inside]).positions
    return v, flip_towards_delaunay(v, f)


def _towards_neighbours(v: Floats, f: Integers) -> Floats:
    """Vertices moved half way to the mean of the centres of their faces."""
    centres, count = np.zeros_like(v), np.bincount(f.ravel(), minlength=len(v))
    np.add.at(centres, f.ravel(), np.repeat(v[f].mean(axis=1), 3, axis=0))
    return 0.5 * (v + centres / np.maximum(count, 1)[:, None])
