"""VTP: XML PolyData with arrays in base64; VTK, which could write it, is larger than all the rest together."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers

_TYPES = {"f8": "Float64", "f4": "Float32", "i8": "Int64", "i4": "Int32", "u1": "UInt8", "b1": "UInt8"}


def encode_vtp(
    vertices: Floats,
    faces: Integers,
    values: Mapping[str, NDArray[Any]] | None = None,
    sizes: Integers | None = None,
) -> bytes:
    """The file of a mesh with values (n,) or (n, k) on its vertices, by name.

    `faces` are triangles (m, 3), or the corners (c,) of faces that have `sizes` (m,).
    """
    if sizes is None:
        sizes = np.full(len(faces), 3)
    n, m = len(vertices), len(sizes)
    points = "".join(_array(name, np.asarray(table).reshape(n, -1)) for name, table in (values or {}).items())
    cells = _array("connectivity", faces.reshape(-1, 1)) + _array("offsets", np.cumsum(sizes)[:, None])
    return (
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
        f'<PolyData><Piece NumberOfPoints="{n}" NumberOfPolys="{m}" NumberOfVerts="0" NumberOfLines="0" '
        f'NumberOfStrips="0"><PointData>{points}</PointData><Points>{_array("Points", vertices)}</Points>'
        f"<Polys>{cells}</Polys></Piece></PolyData></VTKFile>\n"
    ).encode()


def _array(name: str, table: NDArray[Any]) -> str:
    kind = table.dtype.kind + str(table.dtype.itemsize)
    if kind not in _TYPES:
        table, kind = table.astype(np.float64 if kind[0] == "f" else np.int64), "f8" if kind[0] == "f" else "i8"
    content = np.ascontiguousarray(table, dtype=f"<{kind}").tobytes()
    text = base64.b64encode(len(content).to_bytes(8, "little") + content).decode("ascii")
    about = f'type="{_TYPES[kind]}" Name={quoteattr(name)} NumberOfComponents="{table.shape[1]}" format="binary"'
    return f"<DataArray {about}>{text}</DataArray>"
