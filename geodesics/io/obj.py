"""OBJ: the `v` and `f` lines; everything else (textures, normals, materials, groups) is passed over."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from geodesics.errors import IndexOutOfRange, TruncatedFile
from geodesics.io.contents import Contents
from geodesics.io.polygons import split
from geodesics.io.text import Row, numbers, rows, whole
from geodesics.io.truncation import refuse_cut_face

_DECLARED = re.compile(rb"^#[ \t]*(vertices|faces)[ \t]*:[ \t]*(\d{1,18})[ \t]*\r?$", re.IGNORECASE | re.MULTILINE)


def read_obj(data: bytes, path: Path) -> Contents:
    """A Wavefront OBJ file; vertices stay as they are listed, texture seams do not split them.

    Counts in the comments `# Vertices: n` and `# Faces: m` (MeshLab and `write_mesh` leave them) are checked.
    """
    vertex_rows, polygons, last = [], [], [""]
    for row in statements(data, path):
        last = row.words
        if row.words[0] == "v":
            vertex_rows.append(row)
        elif row.words[0] in ("f", "fo"):
            polygons.append((row, len(vertex_rows)))
    vertices = numbers(vertex_rows, 1, path, unknown=True)
    faces = [_corners(row, defined, len(vertices), path) for row, defined in polygons]
    _check_declared(data, len(vertices), len(faces), path)
    if last[0] in ("f", "fo"):
        refuse_cut_face(data, faces, len(vertices), 1, path, any_size=True)
    sizes = np.array(list(map(len, faces)), dtype=np.int64)
    flat = np.array([corner for face in faces for corner in face], dtype=np.int64)
    triangles, slots, notes = split(sizes, flat, vertices)
    return Contents(vertices, triangles, notes, slots=slots, polygons=(sizes, flat))


def statements(data: bytes, path: Path, comment: str | None = "#") -> Iterator[Row]:
    """The lines of the file, those that a backslash continues made one; names may hold the mark of a comment."""
    return rows(re.sub(rb"\\(\r\n|\n|\r)", b"  ", data), path, comment)


def _corners(row: Row, defined: int, n_vertices: int, path: Path) -> list[int]:
    """The corners of a face line; a negative index counts back from the vertices defined so far."""
    place = f"{path}, line {row.line}"
    face = []
    for word in row.words[1:]:
        written = whole(word.split("/", 1)[0], place)
        index = written - 1 if written > 0 else defined + written
        if written == 0 or not 0 <= index < n_vertices:
            raise IndexOutOfRange(
                f"{place}: index {word[:40]} refers outside the {n_vertices} vertices (counted from 1)"
            )
        face.append(index)
    return face


def _check_declared(data: bytes, n_vertices: int, n_faces: int, path: Path) -> None:
    counts = {b"vertices": n_vertices, b"faces": n_faces}
    declared = {name.lower(): int(number) for name, number in _DECLARED.findall(data)}
    for name, number in declared.items():
        if counts[name] < number:
            raise TruncatedFile(f"{path}: {number} {name.decode()} are declared in a comment, {counts[name]} found")
