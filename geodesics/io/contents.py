"""What a mesh file holds, as every reader gives it."""

from __future__ import annotations

from dataclasses import dataclass, field

from geodesics.arrays import Floats, Integers
from geodesics.notes import Note


@dataclass(frozen=True)
class Part:
    """One of several pieces that a file keeps apart and that were joined into one mesh.

    Parameters
    ----------
    name : str
        Of the node and the mesh in the file, "" where it has none.
    material : str
        "" where it has none.
    vertices, faces : range
        Where they lie in the joined mesh. Pieces that share vertices have the same.
    """

    name: str
    material: str
    vertices: range
    faces: range


@dataclass(frozen=True, eq=False)
class Contents:
    """What a file holds: vertices (n, 3), triangles (m, 3), the notes taken on the way, and its parts, if several.

    `slots` (m, 3): which number of the file's own list of corners, face after face, each corner of a triangle was.
    None where that is the triangles themselves. `polygons` is that list: how many corners each face has, and all of
    them, where there are slots.
    """

    vertices: Floats
    triangles: Integers
    notes: list[Note] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    slots: Integers | None = None
    polygons: tuple[Integers, Integers] | None = None
