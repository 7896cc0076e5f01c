"""PLY: a header naming elements and their properties, then the elements as text or binary."""

from __future__ import annotations

from dataclasses import dataclass, field
from io import BytesIO
from itertools import islice
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import BadPolygon, BadToken, FormatError, IndexOutOfRange, TruncatedFile
from geodesics.io.text import Contents, Row, corners, count, fan, numbers, rows, whole
from geodesics.io.truncation import refuse_cut_face

# Bytes of a number, by the names of its type in a PLY header.
_BYTES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16", "float16"), 2),
    **dict.fromkeys(("int", "uint", "float", "int32", "uint32", "float32"), 4),
    **dict.fromkeys(("double", "float64", "int64", "uint64"), 8),
}
_CORNERS = ("vertex_indices", "vertex_index")


@dataclass
class Element:
    """One element of the header: how many, and its properties; a list property has the size of its count too."""

    name: str
    length: int
    properties: list[str] = field(default_factory=list)
    lists: list[bool] = field(default_factory=list)
    n_bytes: int = 0


def read_ply(data: bytes, path: Path) -> Contents:
    """An ASCII or binary PLY file with elements vertex (x, y, z) and face (vertex_indices); others are passed over."""
    elements, is_ascii, body, n_lines = _read_header(data, path)
    by_name: dict[str, Element] = {}
    for element in elements:
        if element.name in by_name:
            raise FormatError(f"{path}: the header declares element {element.name[:40]} twice")
        by_name[element.name] = element
    for name, needed in (("vertex", ("x", "y", "z")), ("face", ())):
        if name in by_name and not set(needed) <= set(by_name[name].properties):
            raise FormatError(f"{path}: element {name} lacks one of the properties {', '.join(needed)}")
    if "vertex" not in by_name:
        raise FormatError(f"{path}: the header declares no vertices")
    face = by_name.get("face")
    if face is not None and face.length and not set(_CORNERS) & set(face.properties):
        raise FormatError(f"{path}: element face has no property vertex_indices")
    least = sum(element.length * (2 * len(element.properties) if is_ascii else element.n_bytes) for element in elements)
    if least > len(data) - body + 1:
        raise TruncatedFile(f"{path}: the header promises at least {least} bytes of data, {len(data) - body} are there")
    if is_ascii:
        return _read_ascii(data, body, n_lines, elements, path)
    return _read_binary(data, path)


def _read_header(data: bytes, path: Path) -> tuple[list[Element], bool, int, int]:
    """Elements, whether ASCII, the byte where data begin and the number of header lines."""
    end = data.find(b"end_header")
    stop = data.find(b"\n", end)
    if stop < 0 and end >= 0:
        stop = data.find(b"\r", end)
    if end < 0 or stop < 0:
        raise TruncatedFile(f"{path}: the header has no end_header")
    elements: list[Element] = []
    encoding = ""
    header = list(rows(data[:end], path, comment=None))
    for line, words in header[1:]:
        place = f"{path}, line {line}"
        if words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "format" and len(words) == 3:
            encoding = words[1]
        elif words[0] == "element" and len(words) == 3:
            elements.append(Element(words[1], count(words[2], 1, data, place)))
        elif words[0] == "property" and elements:
            _add_property(elements[-1], words, place)
        else:
            raise BadToken(f"{place}: {' '.join(words)[:60]!r} does not belong in a PLY header")
    if encoding not in ("ascii", "binary_little_endian", "binary_big_endian"):
        raise FormatError(f"{path}: format {encoding[:40]!r} is not a PLY encoding")
    head = data[: stop + 1]
    n_lines = head.count(b"\n") or head.count(b"\r")
    return elements, encoding == "ascii", stop + 1, n_lines


def _add_property(element: Element, words: list[str], place: str) -> None:
    is_list = len(words) == 5 and words[1] == "list"
    types = words[2:4] if is_list else words[1:2]
    if len(words) != (5 if is_list else 3) or any(kind not in _BYTES for kind in types):
        raise BadToken(f"{place}: {' '.join(words)[:60]!r} is not a property PLY knows")
    element.properties.append(words[-1])
    element.lists.append(is_list)
    element.n_bytes += _BYTES[types[0]]


def _read_ascii(data: bytes, body: int, n_lines: int, elements: list[Element], path: Path) -> Contents:
    lines = rows(data[body:], path, comment=None, first_line=n_lines + 1)
    vertices: Floats = np.empty((0, 3))
    polygons: list[list[int]] = []
    ends_with_corners = False
    for element in elements:
        table = list(islice(lines, element.length))
        if len(table) < element.length:
            raise TruncatedFile(f"{path}: {element.length} of {element.name} are declared, {len(table)} found")
        columns = [_columns(element, row, path) for row in table]
        if element.name == "vertex":
            at = [element.properties.index(axis) for axis in "xyz"]
            picked = [Row(row.line, [row.words[c[i]] for i in at]) for row, c in zip(table, columns, strict=True)]
            vertices = numbers(picked, 0, path)
        elif element.name == "face" and table:
            at_corners = next(i for i, name in enumerate(element.properties) if name in _CORNERS)
            polygons = [
                corners(row, c[at_corners], len(vertices), 0, path) for row, c in zip(table, columns, strict=True)
            ]
            ends_with_corners = element is elements[-1] and at_corners == len(element.properties) - 1
    if ends_with_corners:
        refuse_cut_face(data, polygons, len(vertices), 0, path)
    triangles, notes = fan(polygons)
    return Contents(vertices, triangles, notes)


def _columns(element: Element, row: Row, path: Path) -> list[int]:
    """Where each property begins in a line; the line must hold exactly what the header promises."""
    place = f"{path}, line {row.line}"
    starts, at = [], 0
    for is_list in element.lists:
        starts.append(at)
        if at >= len(row.words):
            raise TruncatedFile(f"{place}: the line ends before all properties of {element.name}")
        at += 1 + (max(whole(row.words[at], place), 0) if is_list else 0)
    if at > len(row.words):
        error = BadPolygon if element.name == "face" else TruncatedFile
        raise error(f"{place}: {len(row.words)} numbers where {element.name} needs {min(at, 10**20)}")
    return starts


def _read_binary(data: bytes, path: Path) -> Contents:
    """Binary data through trimesh, which checks the total length; the list lengths are checked here."""
    from trimesh.exchange.ply import load_ply

    try:
        loaded = load_ply(BytesIO(data), fix_texture=False, skip_materials=True)
        raw = loaded["metadata"]["_ply_raw"]
        vertices = np.column_stack([raw["vertex"]["data"][axis] for axis in "xyz"]).astype(np.float64)
        face_data = raw["face"]["data"] if "face" in raw and raw["face"]["length"] else None
    except Exception as error:  # whatever a third-party reader throws on a bad file
        raise TruncatedFile(
            f"{path}: the data do not have the length the header promises for faces of one size; "
            f"the file is cut off, or mixes polygons ({error})"
        ) from error
    if face_data is None:
        return Contents(vertices, np.empty((0, 3), dtype=np.int64))
    column = face_data[next(name for name in _CORNERS if name in face_data.dtype.names)]
    degrees, polygons = column["f0"], np.atleast_2d(column["f1"])
    if len(np.unique(degrees)) != 1 or degrees[0] < 3:
        raise BadPolygon(
            f"{path}: faces of {np.unique(degrees)[:5].tolist()} corners; only one size from 3 is supported"
        )
    if polygons.dtype.kind not in "iu":
        raise BadToken(f"{path}: the vertex indices are of type {polygons.dtype}, not integers")
    bad = np.flatnonzero(((polygons < 0) | (polygons >= len(vertices))).any(axis=1))
    if len(bad):
        raise IndexOutOfRange(f"{path}: face {bad[0]} = {polygons[bad[0]]} refers outside the {len(vertices)} vertices")
    triangles, notes = fan(polygons.tolist()) if degrees[0] > 3 else (polygons.astype(np.int64), [])
    return Contents(vertices, triangles, notes)
