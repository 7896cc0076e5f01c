"""Tables of numbers in glTF: strided, normalised and sparse ones (glTF 2.0, sec. 3.6.2)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.errors import BadContainer
from geodesics.io.gltf_container import Gltf

_DTYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}  # by componentType
_ITEMS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}  # numbers in an element, by type
ZEROS_WITHOUT_BYTES = 1 << 20  # elements that may be declared to be zero without a byte in the file; set by hand


def read_accessor(gltf: Gltf, index: Any, kind: str) -> NDArray[Any]:
    """The table (count, k) of an accessor that must be of the type `kind`; normalised integers are floats."""
    accessor = gltf.item("accessors", index)
    what = f"accessor {index}"
    if accessor["type"] != kind:
        raise BadContainer(f"{gltf.path}: {what} is malformed: {accessor['type']!r:.40} where {kind} is needed")
    n, size, dtype = accessor["count"], _ITEMS[kind], np.dtype(_DTYPES[accessor["componentType"]])
    if type(n) is not int or n < 0:
        raise BadContainer(f"{gltf.path}: {what} has a negative count, or none")
    if "bufferView" in accessor:
        values = _table(gltf, accessor, n, size, dtype, what)
    elif n <= ZEROS_WITHOUT_BYTES:
        values = np.zeros((n, size), dtype)
    else:
        raise BadContainer(f"{gltf.path}: {what} declares {n} elements, and the file has no bytes for them")
    if "sparse" in accessor:
        values = _with_others(gltf, accessor["sparse"], values, what)
    if accessor.get("normalized") and dtype.kind in "iu":
        return np.maximum(values.astype(np.float64) / np.iinfo(dtype).max, -1.0)
    return values


def _table(gltf: Gltf, place: dict[str, Any], n: int, size: int, dtype: np.dtype, what: str) -> NDArray[Any]:
    held, stride = gltf.bytes_of_view(place["bufferView"], what)
    start, width = place.get("byteOffset", 0), size * dtype.itemsize
    if start < 0 or stride < 0:
        raise BadContainer(f"{gltf.path}: {what} has a negative place")
    step = max(stride or width, 1)
    needed = (n - 1) * step + width if n else 0
    if start + needed > len(held) or (stride and stride < width):
        raise BadContainer(f"{gltf.path}: {what} needs {needed} bytes, more than its part of the file holds")
    return np.ndarray((n, size), dtype, held, start, (step, dtype.itemsize)) if n else np.empty((0, size), dtype)


def _with_others(gltf: Gltf, sparse: dict[str, Any], values: NDArray[Any], what: str) -> NDArray[Any]:
    """The table with the rows that a sparse accessor lists apart."""
    n = sparse["count"]
    if type(n) is not int or not 0 <= n <= len(values):
        raise BadContainer(f"{gltf.path}: {what} lists {n!r:.40} rows apart, and has {len(values)}")
    kind = np.dtype(_DTYPES[sparse["indices"]["componentType"]])
    where = _table(gltf, sparse["indices"], n, 1, kind, what).ravel()
    if kind.kind != "u" or (n and where.max() >= len(values)):
        raise BadContainer(f"{gltf.path}: {what} lists rows apart that it does not have")
    values = values.copy()
    values[where] = _table(gltf, sparse["values"], n, values.shape[1], values.dtype, what)
    return values
