"""Surfaces of the brain: GIFTI and FreeSurfer's binary files through nibabel (extra: neuro), FreeSurfer's text here."""

from __future__ import annotations

import base64
import binascii
import math
import tempfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.errors import (
    BadContainer,
    BadCount,
    ExternalReference,
    FormatError,
    InflatesTooFar,
    MissingExtra,
    TruncatedFile,
)
from geodesics.extras import how_to_install
from geodesics.io.cells import no_cells, surface
from geodesics.io.contents import Contents
from geodesics.io.text import count, numbers, rows, vertex_index
from geodesics.io.vtp import parse_xml

_BYTES = {"NIFTI_TYPE_UINT8": 1, "NIFTI_TYPE_INT32": 4, "NIFTI_TYPE_FLOAT32": 4}  # of the types GIFTI 1.0 has
_OTHER_BYTES = 8  # of the longest type that some write nevertheless
_QUADS = (b"\xff\xff\xff", b"\xff\xff\xfd")  # FreeSurfer's magic numbers of surfaces of quads, no longer written


def _nibabel() -> Any:
    try:
        import nibabel
    except ImportError as error:
        reason = f"GIFTI and FreeSurfer files need nibabel; install it with: {how_to_install('neuro')}"
        raise MissingExtra(reason) from error
    return nibabel


def read_gifti(data: bytes, path: Path) -> Contents:
    """The one surface of a GIFTI file: its point set and its triangles, as they lie in the file's own space."""
    _check_gifti(data, path)
    nibabel = _nibabel()
    try:
        image = nibabel.gifti.GiftiImage.from_bytes(data)
        found = [
            [np.asarray(array.data) for array in image.get_arrays_from_intent(f"NIFTI_INTENT_{intent}")]
            for intent in ("POINTSET", "TRIANGLE")
        ]
    except Exception as error:  # whatever a reader of others raises on what it does not know
        raise TruncatedFile(f"{path}: the GIFTI content cannot be read ({type(error).__name__}: {error})") from error
    if [len(arrays) for arrays in found] != [1, 1]:
        raise BadContainer(
            f"{path}: {len(found[0])} sets of points and {len(found[1])} of triangles, where a surface has one of each"
        )
    points, triangles = found[0][0], found[1][0]
    if points.ndim != 2 or points.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
        raise BadContainer(f"{path}: points {points.shape} and triangles {triangles.shape} must have three columns")
    if triangles.dtype.kind not in "iu":
        raise BadContainer(f"{path}: triangles are of type {triangles.dtype}, not integers")
    cells = np.full(len(triangles), 3), triangles.astype(np.int64).ravel()
    return surface(points.astype(np.float64), cells, no_cells(), path, [])


def _check_gifti(data: bytes, path: Path) -> None:
    """Every array against its declared dimensions, before it is unpacked by another."""
    for array in parse_xml(data, path).iter("DataArray"):
        encoding = array.get("Encoding", "")
        if encoding == "ExternalFileBinary" or array.get("ExternalFileName"):
            raise ExternalReference(f"{path}: data in other files is not opened; save them inside, as GZipBase64Binary")
        try:
            dims = [int(array.get(f"Dim{i}", "")) for i in range(int(array.get("Dimensionality", "")))]
        except ValueError as error:
            raise BadCount(f"{path}: the dimensions of an array are no whole numbers ({error})") from error
        wanted = math.prod(dims) * _BYTES.get(array.get("DataType", ""), _OTHER_BYTES)
        if min(dims, default=0) < 0 or wanted > 1100 * len(data):  # 1032 is the most that deflate can do
            raise BadCount(f"{path}: an array of {dims} is declared, more than {len(data)} bytes can hold")
        if encoding == "GZipBase64Binary":
            try:
                packed = base64.b64decode("".join((array.findtext("Data") or "").split()), validate=True)
                length = len(zlib.decompressobj().decompress(packed, wanted + 1))
            except (binascii.Error, ValueError, zlib.error) as error:
                raise TruncatedFile(f"{path}: an array is cut off or damaged ({error})") from error
            if length > wanted:
                raise InflatesTooFar(
                    f"{path}: an array of {dims} unpacks to more than the {wanted} bytes it should have"
                )


def read_freesurfer(data: bytes, path: Path) -> Contents:
    """A binary surface of FreeSurfer (lh.white, rh.pial, ...)."""
    if data[:3] not in _QUADS:
        _check_freesurfer(data, path)
    nibabel = _nibabel()
    try:
        with tempfile.TemporaryDirectory() as folder:  # nibabel reads from names only
            copy = Path(folder) / "surface"
            copy.write_bytes(data)
            points, triangles = nibabel.freesurfer.read_geometry(copy)
    except Exception as error:  # whatever a reader of others raises on what it does not know
        raise TruncatedFile(f"{path}: the FreeSurfer surface cannot be read ({error})") from error
    cells = np.full(len(triangles), 3), np.asarray(triangles).astype(np.int64).ravel()
    return surface(np.asarray(points, dtype=np.float64).reshape(-1, 3), cells, no_cells(), path, [])


def _check_freesurfer(data: bytes, path: Path) -> None:
    """A line of text, an empty one, two counts, then 12 bytes a vertex and 12 a triangle."""
    first = data.find(b"\n", 3)
    second = data.find(b"\n", first + 1)
    if first < 0 or second < 0 or second + 9 > len(data):
        raise TruncatedFile(f"{path}: the file ends before its counts")
    n, m = (int.from_bytes(data[at : at + 4], "big", signed=True) for at in (second + 1, second + 5))
    if min(n, m) < 0 or second + 9 + 12 * (n + m) > len(data):
        raise TruncatedFile(
            f"{path}: {n} vertices and {m} triangles are declared, more than {len(data)} bytes can hold"
        )


def read_freesurfer_ascii(data: bytes, path: Path) -> Contents:
    """FreeSurfer's text format (lh.white.asc): counts, then `x y z flag` and `i j k flag` a line."""
    table = list(rows(data, path, comment=None))[1:]
    if not table or len(table[0].words) < 2:
        raise FormatError(f"{path}, line 2: the numbers of vertices and triangles are expected")
    place = f"{path}, line {table[0].line}"
    n, m = (count(word, 6, data, place) for word in table[0].words[:2])
    if len(table) - 1 < n + m:
        raise TruncatedFile(f"{path}: {n} vertices and {m} triangles are declared, {len(table) - 1} lines follow")
    vertices = numbers(table[1 : n + 1], 0, path, unknown=True)
    triangles = []
    for row in table[n + 1 : n + 1 + m]:
        where = f"{path}, line {row.line}"
        if len(row.words) < 3:
            raise TruncatedFile(f"{where}: three corners expected, {len(row.words)} found")
        triangles.append([vertex_index(word, n, 0, where) for word in row.words[:3]])
    return Contents(vertices, np.array(triangles, dtype=np.int64).reshape(-1, 3))
