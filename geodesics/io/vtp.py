"""VTP: PolyData of VTK in XML (and the polygons of .vtu), with arrays in text, base64 or raw bytes behind the rest."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadContainer, BadShape, BadToken, FormatError, TruncatedFile, UnknownFormat
from geodesics.io.cells import Cells, check_corners, from_offsets, joined, no_cells, of_types, surface
from geodesics.io.contents import Contents
from geodesics.io.packed_array import Packing, unpacked

_RAW = re.compile(rb"<AppendedData[^>]*encoding\s*=\s*[\"']raw[\"'][^>]*>\s*_")
_PLAIN = re.compile(rb"[\s\d.+\-eEnNaAiIfF]*")  # of numbers in text, and of nan and inf
_END = rb"</AppendedData>"
_TYPES = {
    "Float32": "f4", "Float64": "f8", "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2",
    "Int32": "i4", "UInt32": "u4", "Int64": "i8", "UInt64": "u8",
}  # fmt: skip


@dataclass(frozen=True)
class _File:
    path: Path
    packing: Packing
    appended: bytes
    raw: bool


def parse_xml(data: bytes, path: Path) -> ElementTree.Element:
    """The tree of an XML file; `BadContainer` for one that is malformed or declares entities, which may expand."""
    if b"<!ENTITY" in data or data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise BadContainer(f"{path}: XML with entities of its own, or in UTF-16, is not read")
    try:
        return ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise TruncatedFile(f"{path}: the XML is cut off or malformed ({error})") from error


def read_vtp(data: bytes, path: Path) -> Contents:
    """A VTP or VTU file, its pieces joined; values on vertices and faces are passed over."""
    raw, end = _RAW.search(data), data.rfind(_END)
    appended = b""
    if raw:
        if end < raw.end():
            raise TruncatedFile(f"{path}: the file ends within its appended data")
        appended, data = data[raw.end() : end], data[: raw.end() - 1] + data[end:]
    root = parse_xml(data, path)
    kind = root.get("type", "")
    grid = root.find(kind) if kind in ("PolyData", "UnstructuredGrid") else None
    if grid is None:
        raise UnknownFormat(f"{path}: VTK files of {kind[:40] or 'no type'} hold no surface; save it as PolyData")
    if not raw:
        appended = (root.findtext("AppendedData") or "").strip().removeprefix("_").encode("ascii", "replace")
    packing = Packing(
        "<" if root.get("byte_order", "LittleEndian") == "LittleEndian" else ">",
        8 if root.get("header_type", "UInt32") == "UInt64" else 4,
        root.get("compressor", ""),
    )
    file = _File(path, packing, appended, raw is not None)
    pieces = [_piece(piece, kind, file) for piece in grid.findall("Piece")]
    n_before, polygons, strips = 0, [], []
    for vertices, faces, ribbons in pieces:
        polygons.append((faces[0], faces[1] + n_before))
        strips.append((ribbons[0], ribbons[1] + n_before))
        n_before += len(vertices)
    all_vertices = np.concatenate([np.empty((0, 3)), *(vertices for vertices, *_ in pieces)])
    return surface(all_vertices, joined(polygons), joined(strips), path, [])


def _piece(piece: ElementTree.Element, kind: str, file: _File) -> tuple[Floats, Cells, Cells]:
    """Vertices, polygons and strips of a piece; corners are checked against its own vertices."""
    n = _declared(piece, "NumberOfPoints", file.path)
    points = piece.find("Points/DataArray")
    vertices = np.empty((0, 3))
    if points is not None and n:
        flat = _numbers(points, file).astype(np.float64)
        if len(flat) != 3 * n:
            raise TruncatedFile(f"{file.path}: {n} points are declared, and {len(flat)} coordinates are there")
        vertices = flat.reshape(-1, 3)
    if kind == "PolyData":
        cells = [
            _cells(piece, name, _declared(piece, f"NumberOf{name}", file.path), file) for name in ("Polys", "Strips")
        ]
    else:
        n_cells = _declared(piece, "NumberOfCells", file.path)
        types = piece.find("Cells/DataArray[@Name='types']")
        every = _cells(piece, "Cells", n_cells, file)
        cells = (
            list(of_types(every, _whole(types, file)[:n_cells], file.path)) if types is not None else [no_cells()] * 2
        )
    for found in cells:
        check_corners(found, len(vertices), file.path)
    return vertices, cells[0], cells[1]


def _cells(piece: ElementTree.Element, name: str, n: int, file: _File) -> Cells:
    arrays = [piece.find(f"{name}/DataArray[@Name='{which}']") for which in ("offsets", "connectivity")]
    if n == 0:
        return no_cells()
    if arrays[0] is None or arrays[1] is None:
        raise TruncatedFile(f"{file.path}: {n} {name} are declared, and their offsets or connectivity are missing")
    offsets = _whole(arrays[0], file)
    if len(offsets) != n:
        raise TruncatedFile(f"{file.path}: {n} {name} are declared, and {len(offsets)} offsets are there")
    return from_offsets(np.append(0, offsets), _whole(arrays[1], file), file.path)


def _declared(piece: ElementTree.Element, name: str, path: Path) -> int:
    word = piece.get(name, "0").strip()
    if not (word.isascii() and word.isdecimal() and len(word) < 19):
        raise FormatError(f"{path}: {name} is {word[:40]!r}, not a count")
    return int(word)


def _numbers(element: ElementTree.Element, file: _File) -> np.ndarray:
    kind, how = element.get("type", ""), element.get("format", "ascii")
    if kind not in _TYPES:
        raise FormatError(f"{file.path}: numbers of type {kind[:40]!r} are not known")
    dtype = np.dtype(file.packing.order + _TYPES[kind])
    if how == "appended":
        return unpacked(
            file.appended, _declared(element, "offset", file.path), file.raw, dtype, file.packing, file.path
        )
    text = "".join((element.text or "").split() if how == "binary" else element.text or "").encode("ascii", "replace")
    if how == "binary":
        return unpacked(text, 0, False, dtype, file.packing, file.path)
    if not _PLAIN.fullmatch(text):
        raise BadToken(f"{file.path}: array {element.get('Name', '')[:40]!r} holds what is no number")
    try:
        values = np.array(text.split(), dtype=np.float64 if dtype.kind == "f" else np.int64)
    except (ValueError, OverflowError) as error:
        name = element.get("Name", "")[:40]
        raise BadToken(f"{file.path}: array {name!r} holds what is no number ({error})") from error
    return values


def _whole(element: ElementTree.Element, file: _File) -> Integers:
    values = _numbers(element, file)
    if values.dtype.kind not in "iu":
        raise BadShape(f"{file.path}: {element.get('Name', 'cells')[:40]!r} must hold whole numbers")
    if values.dtype.itemsize == 8 and values.dtype.kind == "u":
        values = np.minimum(values, 2**62)  # what no vertex can be stays so
    return values.astype(np.int64)
