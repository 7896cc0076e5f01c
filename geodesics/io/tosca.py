"""TOSCA: a `.vert` file of positions and a `.tri` file of triangles counted from 1."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geodesics.errors import BadPolygon, TruncatedFile
from geodesics.io.contents import Contents
from geodesics.io.opening import read_bytes, unpacked_name
from geodesics.io.text import numbers, rows, vertex_index
from geodesics.io.truncation import refuse_cut_face


def tosca_paths(path: Path) -> tuple[Path, Path]:
    """The two files of a TOSCA shape, from either of them or their common stem; the case of the suffix stays."""
    path = unpacked_name(path)
    stem = path.with_suffix("") if path.suffix.lower() in (".vert", ".tri") else path
    upper = path.suffix.isupper()
    vert, tri = (".VERT", ".TRI") if upper else (".vert", ".tri")
    return stem.with_name(stem.name + vert), stem.with_name(stem.name + tri)


def read_tosca(path: Path) -> Contents:
    """The shape of which `path` is the `.vert` file, the `.tri` file or the common stem."""
    vert, tri = (_as_it_is_there(half) for half in tosca_paths(path))
    vertices = numbers(list(rows(read_bytes(vert), vert)), 0, vert, unknown=True)
    data = read_bytes(tri)
    polygons = []
    for row in rows(data, tri):
        place = f"{tri}, line {row.line}"
        if len(row.words) != 3:
            error = TruncatedFile if len(row.words) < 3 else BadPolygon
            raise error(f"{place}: three indices expected, {len(row.words)} found")
        polygons.append([vertex_index(word, len(vertices), 1, place) for word in row.words])
    refuse_cut_face(data, polygons, len(vertices), 1, tri)
    return Contents(vertices, np.array(polygons, dtype=np.int64).reshape(-1, 3))


def _as_it_is_there(path: Path) -> Path:
    packed = path.with_name(f"{path.name}.gz")
    return packed if packed.exists() and not path.exists() else path
