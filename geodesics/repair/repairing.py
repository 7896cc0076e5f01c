"""Repairing a mesh, with index arrays between the old mesh and the new one.

`remesh` and `fill_holes` beside it run pymeshlab, which is GPL-3 and therefore an extra (`repair`),
in a process of its own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.check import NAMED, repeated_faces
from geodesics.errors import Note
from geodesics.mesh import Mesh
from geodesics.repair.sewing import sewn
from geodesics.repair.splitting import split
from geodesics.topology.components import largest_component
from geodesics.topology.edges import degenerate_faces
from geodesics.topology.junctions import junctions
from geodesics.topology.orientation import orient_faces


class Repaired(NamedTuple):
    """A new mesh, and how its vertices and faces correspond to those of the old one.

    Parameters
    ----------
    mesh : Mesh
        The new mesh, of n vertices and m faces.
    vertex : int array of shape (n,)
        The vertex of the old mesh from which each new one comes.
    face : int array of shape (m,)
        The face of the old mesh from which each new one comes.
    notes : list of Note
        What was changed.
    new_vertex : int array, one entry per vertex of the old mesh
        The new vertex that it became, the first of its copies where it was split; -1 for none.
    new_face : int array, one entry per face of the old mesh
        The new face that it became; -1 for none.
    """

    mesh: Mesh
    vertex: Integers
    face: Integers
    notes: list[Note]
    new_vertex: Integers
    new_face: Integers


def repair(mesh: Mesh, *, weld: bool = False, sew: bool = False, cut: bool = False, largest: bool = False) -> Repaired:
    """Drop repeated and degenerate faces and vertices on no face, and orient faces consistently, outward when closed.

    Vertices and faces that stay keep their order; positions do not change.

    Parameters
    ----------
    mesh : Mesh
        The mesh, which is not changed.
    weld : bool
        Whether to join vertices at exactly equal positions, first of all.
    sew : bool
        Whether to split open edges at vertices that lie on them to within rounding, and whose edges run along them
        (T-junctions); the first piece of a face keeps its place, the others come last.
    cut : bool
        Whether to take apart edges of more than two faces and vertices that join several fans of faces; copies of
        vertices come last.
    largest : bool
        Whether to keep only the component of the largest area.

    Returns
    -------
    Repaired
        The new mesh, with notes on what was changed.

    Raises
    ------
    MeshError
        When nothing is left.

    See Also
    --------
    geodesics.check.check : What there is to repair.
    decimate, remesh, fill_holes : Changes of the triangulation.
    """
    notes: list[Note] = []
    of_vertex, faces = np.arange(mesh.n_vertices), mesh.faces
    if weld:
        _, first, inverse = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
        of_vertex = first[inverse.reshape(-1)]
        faces = of_vertex[faces]
        _note(notes, "W219", np.flatnonzero(of_vertex != np.arange(mesh.n_vertices)), "vertices welded")
    kept = np.arange(len(faces))
    for code, find, sentence in (
        ("W202", degenerate_faces, "faces that name a vertex twice removed"),
        ("W201", repeated_faces, "repeated faces removed"),
    ):
        bad = find(Mesh(mesh.vertices, faces[kept]))
        _note(notes, code, kept[bad], sentence)
        kept = kept[~bad]
    faces = faces[kept]
    if sew:
        seamed = Mesh(mesh.vertices, faces)
        _note(notes, "W229", np.unique(junctions(seamed).vertex), "vertices sewn to edges that they lie on")
        faces, pieces, _ = sewn(seamed)
        kept = kept[pieces]
    vertex, clean = _compact(np.arange(mesh.n_vertices), mesh.vertices, faces)
    _note(notes, "W215", np.setdiff1d(of_vertex, vertex), "vertices on no face removed")
    if cut:
        apart, copies = split(clean)
        doubled = np.unique(vertex[copies[clean.n_vertices :]])
        _note(notes, "W213", doubled, "vertices doubled where more than two faces or several fans met")
        vertex, clean = vertex[copies], apart
    if largest:
        inside = largest_component(clean)
        _note(notes, "W216", kept[~inside], "faces of other components removed")
        kept = kept[inside]
        vertex, clean = _compact(vertex, clean.vertices, clean.faces[inside])
    oriented = orient_faces(clean)
    _note(notes, "W204", kept[(oriented.faces != clean.faces).any(axis=1)], "faces turned")
    new_vertex = inverse_index(vertex, mesh.n_vertices)[of_vertex]
    return Repaired(oriented, vertex, kept, notes, new_vertex, inverse_index(kept, mesh.n_faces))


def inverse_index(index: Integers, n: int) -> Integers:
    """For each of 0 .. n - 1 where it first occurs in an index array.

    Parameters
    ----------
    index : int array of shape (k,)
        Indices below n; -1 for none.
    n : int
        Length of the result.

    Returns
    -------
    int array of shape (n,)
        Places in `index`; -1 for what does not occur.
    """
    place = np.full(n, -1, dtype=np.int64)
    given = np.flatnonzero(index >= 0)[::-1]
    place[index[given]] = given
    return place


def _compact(vertex: Integers, positions: Floats, faces: Integers) -> tuple[Integers, Mesh]:
    """The vertices that faces use, by their names in `vertex`, and the mesh of only these."""
    used, compact = np.unique(faces, return_inverse=True)
    return vertex[used], Mesh(positions[used], compact.reshape(-1, 3))


def _note(notes: list[Note], code: str, where: Integers, sentence: str) -> None:
    if len(where):
        notes.append(Note(code, "info", f"{len(where)} {sentence}", tuple(where[:NAMED].tolist()), len(where)))
