"""Making a better mesh out of one, with the way back: removing defects, decimation, remeshing, closing holes.

`remesh` and `fill_holes` run pymeshlab, which is GPL-3 and therefore an extra (`pip install gmds[repair]`), in a
process of its own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics import intrinsic
from geodesics._meshlab import apply_filter
from geodesics.check import NAMED, repeated_faces
from geodesics.edges import degenerate_faces, edges
from geodesics.errors import MeshError, Note, NotManifold
from geodesics.mesh import Mesh
from geodesics.orientation import orient_faces
from geodesics.splitting import split
from geodesics.topology import vertex_components


class Repaired(NamedTuple):
    """A new mesh, and the way from the old one and back; `notes` say what changed.

    `vertex` (n,) and `face` (m,) index the old mesh; `new_vertex` and `new_face` say for each vertex and face of the
    old mesh which new one it became, -1 for none. A vertex that was split became the first of its copies.
    """

    mesh: Mesh
    vertex: NDArray[np.int64]
    face: NDArray[np.int64]
    notes: list[Note]
    new_vertex: NDArray[np.int64]
    new_face: NDArray[np.int64]


def repair(mesh: Mesh, *, weld: bool = False, cut: bool = False, largest: bool = False) -> Repaired:
    """Drop repeated and degenerate faces and vertices on no face, orient faces consistently (outward when closed).

    Vertices and faces that stay keep their order; positions do not change. `weld` first joins vertices at exactly
    equal positions; `cut` takes apart edges of more than two faces and vertices that join several fans, copies of
    vertices coming last (see `geodesics.splitting.split`); `largest` keeps the component of the largest area only.
    Raises `MeshError` when nothing is left.
    """
    notes: list[Note] = []
    of_vertex, faces = np.arange(mesh.n_vertices), mesh.faces
    if weld:
        _, first, inverse = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
        of_vertex = first[inverse.reshape(-1)]
        faces = of_vertex[faces]
        _note(notes, "W219", np.flatnonzero(of_vertex != np.arange(mesh.n_vertices)), "vertices welded")
    kept = np.arange(len(faces))
    for code, found, sentence in (
        ("W202", degenerate_faces, "faces that name a vertex twice removed"),
        ("W201", repeated_faces, "repeated faces removed"),
    ):
        bad = found(Mesh(mesh.vertices, faces[kept]))
        _note(notes, code, kept[bad], sentence)
        kept = kept[~bad]
    vertex, clean = _compact(np.arange(mesh.n_vertices), mesh.vertices, faces[kept])
    _note(notes, "W215", np.setdiff1d(of_vertex, vertex), "vertices on no face removed")
    if cut:
        apart, copies = split(clean)
        doubled = np.unique(vertex[copies[clean.n_vertices :]])
        _note(notes, "W213", doubled, "vertices doubled where more than two faces or several fans met")
        vertex, clean = vertex[copies], apart
    if largest:
        inside = _largest(clean)
        _note(notes, "W216", kept[~inside], "faces of other components removed")
        kept = kept[inside]
        vertex, clean = _compact(vertex, clean.vertices, clean.faces[inside])
    oriented = orient_faces(clean)
    _note(notes, "W204", kept[(oriented.faces != clean.faces).any(axis=1)], "faces turned")
    new_vertex = inverse_index(vertex, mesh.n_vertices)[of_vertex]
    return Repaired(oriented, vertex, kept, notes, new_vertex, inverse_index(kept, mesh.n_faces))


def inverse_index(index: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """For each of 0 .. n - 1 where it first stands in `index`, -1 where it does not or `index` is -1: shape (n,)."""
    place = np.full(n, -1, dtype=np.int64)
    known = np.flatnonzero(index >= 0)[::-1]
    place[index[known]] = known
    return place


def _compact(
    vertex: NDArray[np.int64], positions: NDArray[np.float64], faces: NDArray[np.int64]
) -> tuple[NDArray[np.int64], Mesh]:
    """The vertices that faces use, by their names in `vertex`, and the mesh of only these."""
    used, compact = np.unique(faces, return_inverse=True)
    return vertex[used], Mesh(positions[used], compact.reshape(-1, 3))


def _largest(mesh: Mesh) -> NDArray[np.bool_]:
    """Faces (m,) of the component with the largest area."""
    part = vertex_components(mesh)[mesh.faces[:, 0]]
    area = intrinsic.areas(intrinsic.squared_lengths(mesh.vertices, mesh.faces))
    return np.asarray(part == np.bincount(part, weights=area).argmax())


def decimate(mesh: Mesh, n_faces: int) -> Repaired:
    """A coarser mesh of about `n_faces` faces by quadric edge collapses (Garland and Heckbert 1997, through libigl).

    `vertex` and `face` are the vertex and face of the old mesh from which each new one descends. Raises `NotManifold`
    (E110) for edges of more than two faces, and `ValueError` when `n_faces` is not from 4 to the number of faces.
    """
    import igl

    if not 4 <= n_faces <= mesh.n_faces:
        raise ValueError(f"n_faces must be from 4 to the {mesh.n_faces} of the mesh, not {n_faces}")
    start = repair(mesh)
    _refuse_branching(start.mesh)
    center, size = _frame(start.mesh)
    v = (start.mesh.vertices - center) / size  # a unit-sized copy: quadrics do not underflow at any scale
    u, g, face, vertex = igl.qslim(v, start.mesh.faces.astype(np.int32), int(n_faces), False)
    vertex, face = start.vertex[vertex], start.face[face]
    back = inverse_index(vertex, mesh.n_vertices), inverse_index(face, mesh.n_faces)
    return Repaired(Mesh(u * size + center, g), vertex, face, start.notes, *back)


def remesh(mesh: Mesh, target_vertices: int, *, iterations: int = 10) -> Mesh:
    """A new triangulation of the same surface with nearly equilateral triangles and about `target_vertices` vertices.

    Isotropic explicit remeshing through pymeshlab; boundaries are kept, vertices are new ones. Raises `MissingExtra`
    when pymeshlab is not installed and `MeshError` when it fails.
    """
    if target_vertices < 4:
        raise ValueError(f"target_vertices must be at least 4, not {target_vertices}")
    center, size = _frame(mesh)
    unit = (mesh.vertices - center) / size
    a, b, c = unit[mesh.faces.T]
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    best, miss = (unit, mesh.faces), np.inf
    for near in (True, False):  # that it stays near the surface can keep the mesh finer than asked: then without
        length = np.sqrt(area / target_vertices * 2 / np.sqrt(3))  # an equilateral tiling has sqrt(3)/2 l^2 a vertex
        for _ in range(4):  # edges come out somewhat longer or shorter than asked: correct the length and start again
            v, f = apply_filter(
                "meshing_isotropic_explicit_remeshing",
                unit,
                mesh.faces,
                targetlen=float(length),
                iterations=iterations,
                checksurfdist=near,
            )
            if abs(np.log(len(v) / target_vertices)) < miss:
                best, miss = (v, f), abs(np.log(len(v) / target_vertices))
            if miss < 0.05:
                break
            length *= np.sqrt(len(v) / target_vertices)
        if miss < 0.2:
            break
    v, f = best
    return repair(Mesh(v * size + center, f)).mesh


def fill_holes(mesh: Mesh, max_edges: int = 1000) -> Mesh:
    """The mesh with every boundary loop of at most `max_edges` edges closed by new faces, through pymeshlab.

    Vertices and existing faces stay as they are; the new faces come last. Raises `MissingExtra`, and `NotManifold`
    (E110) for edges of more than two faces.
    """
    _refuse_branching(mesh)
    center, size = _frame(mesh)
    unit = (mesh.vertices - center) / size
    below = int(max_edges) + 1  # meshlab closes holes of fewer edges than that
    v, f = apply_filter("meshing_close_holes", unit, mesh.faces, maxholesize=below, selfintersection=False)
    if len(v) != mesh.n_vertices or not np.array_equal(f[: mesh.n_faces], mesh.faces):
        raise MeshError("closing holes changed the vertices; repair the mesh first")
    return Mesh(mesh.vertices, f)


def _frame(mesh: Mesh) -> tuple[NDArray[np.float64], float]:
    """Center and size of the vertices that lie on faces."""
    used = mesh.vertices[np.unique(mesh.faces)]
    return used.mean(axis=0), float(np.ptp(used, axis=0).max())


def _refuse_branching(mesh: Mesh) -> None:
    table = edges(mesh)
    many = np.flatnonzero(table.n_faces > 2)
    if len(many):
        ends = table.ends[many[0]].tolist()
        raise NotManifold(f"{len(many)} edges have more than two faces, first between vertices {ends}; repair the mesh")


def _note(notes: list[Note], code: str, where: NDArray[np.int64], sentence: str) -> None:
    if len(where):
        notes.append(Note(code, "info", f"{len(where)} {sentence}", tuple(where[:NAMED].tolist()), len(where)))
