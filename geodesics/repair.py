"""Making a better mesh out of one, with the way back: removing defects, decimation, remeshing, closing holes.

`remesh` and `fill_holes` run pymeshlab, which is GPL-3 and therefore an extra: `pip install gmds[repair]`.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics.check import repeated_faces
from geodesics.edges import degenerate_faces, edges
from geodesics.errors import MeshError, MissingExtra, Note, NotManifold
from geodesics.mesh import Mesh
from geodesics.orientation import orient_faces


class Repaired(NamedTuple):
    """A new mesh and where it came from: `vertex` (n,) and `face` (m,) index the old mesh; `notes` say what changed."""

    mesh: Mesh
    vertex: NDArray[np.int64]
    face: NDArray[np.int64]
    notes: list[Note]


def repair(mesh: Mesh, *, weld: bool = False) -> Repaired:
    """Drop repeated and degenerate faces and vertices on no face, orient faces consistently (outward when closed).

    Vertices and faces that stay keep their order; positions do not change. `weld` also joins vertices at exactly
    equal positions. Raises `MeshError` when nothing is left.
    """
    notes: list[Note] = []
    faces = mesh.faces
    if weld:
        _, first, inverse = np.unique(mesh.vertices + 0.0, axis=0, return_index=True, return_inverse=True)
        faces = first[inverse.reshape(-1)][faces]
        _note(
            notes, "W219", np.flatnonzero(first[inverse.reshape(-1)] != np.arange(mesh.n_vertices)), "vertices welded"
        )
    kept = np.arange(len(faces))
    for code, found, sentence in (
        ("W202", degenerate_faces, "faces that name a vertex twice removed"),
        ("W201", repeated_faces, "repeated faces removed"),
    ):
        bad = found(Mesh(mesh.vertices, faces[kept]))
        _note(notes, code, kept[bad], sentence)
        kept = kept[~bad]
    vertex, compact = np.unique(faces[kept], return_inverse=True)
    _note(notes, "W215", np.setdiff1d(np.arange(mesh.n_vertices), vertex), "vertices on no face removed")
    clean = Mesh(mesh.vertices[vertex], compact.reshape(-1, 3))
    oriented = orient_faces(clean)
    _note(notes, "W204", kept[(oriented.faces != clean.faces).any(axis=1)], "faces turned")
    return Repaired(oriented, vertex, kept, notes)


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
    return Repaired(Mesh(u * size + center, g), start.vertex[vertex], start.face[face], start.notes)


def remesh(mesh: Mesh, target_vertices: int, *, iterations: int = 10) -> Mesh:
    """A new triangulation of the same surface with nearly equilateral triangles and about `target_vertices` vertices.

    Isotropic explicit remeshing through pymeshlab; boundaries are kept, vertices are new ones. Raises `MissingExtra`
    when pymeshlab is not installed and `MeshError` when it fails.
    """
    if target_vertices < 4:
        raise ValueError(f"target_vertices must be at least 4, not {target_vertices}")
    pymeshlab = _pymeshlab("remesh")
    center, size = _frame(mesh)
    unit = (mesh.vertices - center) / size
    a, b, c = unit[mesh.faces.T]
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    length = np.sqrt(area / target_vertices * 2 / np.sqrt(3))  # a vertex of the equilateral tiling owns sqrt(3)/2 l^2
    v, f = unit, mesh.faces
    for _ in range(4):  # edges come out somewhat longer or shorter than asked: correct the length and start again
        v, f = _run(
            pymeshlab,
            "meshing_isotropic_explicit_remeshing",
            unit,
            mesh.faces,
            targetlen=pymeshlab.PureValue(float(length)),
            iterations=iterations,
        )
        if abs(len(v) / target_vertices - 1) < 0.05:
            break
        length *= np.sqrt(len(v) / target_vertices)
    return repair(Mesh(v * size + center, f)).mesh


def fill_holes(mesh: Mesh, max_edges: int = 1000) -> Mesh:
    """The mesh with every boundary loop of at most `max_edges` edges closed by new faces, through pymeshlab.

    Vertices and existing faces stay as they are; the new faces come last. Raises `MissingExtra`, and `NotManifold`
    (E110) for edges of more than two faces.
    """
    pymeshlab = _pymeshlab("fill_holes")
    _refuse_branching(mesh)
    center, size = _frame(mesh)
    unit = (mesh.vertices - center) / size
    v, f = _run(pymeshlab, "meshing_close_holes", unit, mesh.faces, maxholesize=int(max_edges), selfintersection=False)
    if len(v) != mesh.n_vertices or not np.array_equal(f[: mesh.n_faces], mesh.faces):
        raise MeshError("closing holes changed the vertices; repair the mesh first")
    return Mesh(mesh.vertices, f)


def _run(pymeshlab: ModuleType, name: str, v: Any, f: Any, **options: Any) -> tuple[Any, Any]:
    """One pymeshlab filter: vertices and faces in, vertices and faces out."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(v, f.astype(np.int32)))
    try:
        meshes.apply_filter(name, **options)
    except pymeshlab.PyMeshLabException as error:
        raise MeshError(f"pymeshlab can not process the mesh ({error}); repair it first") from error
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix().astype(np.int64)


def _pymeshlab(name: str) -> ModuleType:
    try:
        import pymeshlab
    except ImportError as error:
        raise MissingExtra(f"{name} needs pymeshlab; install it with: pip install 'gmds[repair]'") from error
    return pymeshlab


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
        notes.append(Note(code, "info", f"{len(where)} {sentence}", tuple(where[:100].tolist())))
