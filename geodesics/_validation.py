"""Checks of what callers give: arrays in, clean arrays or a typed error out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics.arrays import Bools, Floats, Integers
from geodesics.errors import (
    BadDtype,
    BadShape,
    BadWeights,
    CoordinateRange,
    EmptyMesh,
    IndexOutOfRange,
    NoFaces,
    NonFiniteVertex,
    NonIntegralFace,
    NotTriangles,
    ZeroArea,
)

# Extent of the coordinates along an axis, in their own unit. Areas are computed from fourth powers of lengths, which
# must stay within float64, 1e-308 to 1e308; a factor of 1e8 is left at either end.
SMALLEST_EXTENT, LARGEST_EXTENT = 1e-75, 1e75
OF_A_MESH = ("vertices", "faces")  # of which errors show how to get them


def as_vertices(vertices: ArrayLike | None) -> Floats:
    """A fresh C-ordered float64 copy (n, 3).

    Raises `MeshError`: E103 empty, E107 dtype, E108 shape, E101 not finite, E102 too large or too small for float64.
    """
    raw = as_array(vertices, "vertices")
    if raw.size == 0:
        raise EmptyMesh("the mesh has no vertices; give an (n, 3) array of positions")
    if raw.ndim != 2 or raw.shape[1] != 3:
        hint = "; append a column of zeros for a flat mesh" if raw.ndim == 2 and raw.shape[1] == 2 else ""
        raise BadShape(f"vertices must have shape (n, 3), not {raw.shape}{hint}")
    if raw.dtype.kind not in "fiu":
        raise BadDtype(f"vertices must be real numbers, not {raw.dtype}; convert them to float64 first")
    with np.errstate(over="ignore", invalid="ignore"):
        v = np.array(raw, dtype=np.float64, order="C")
    bad = np.flatnonzero(~np.isfinite(v).all(axis=1))
    if len(bad):
        raise NonFiniteVertex(f"{len(bad)} vertices are NaN or infinite, first {bad[:5].tolist()}; repair them")
    _check_range(v)
    return v


def as_faces(faces: ArrayLike | None, n_vertices: int) -> Integers:
    """A fresh C-ordered int64 copy (m, 3) whose every index is in 0 .. n_vertices - 1.

    Raises `MeshError`: E104 none, E107 dtype, E108 shape, E109 quads, E106 not whole, E105 out of range (checked
    before any cast, so that nothing wraps around).
    """
    raw = as_array(faces, "faces")
    if raw.size == 0:
        raise NoFaces("the mesh has vertices but no faces; point clouds must be triangulated first")
    if raw.ndim != 2 or raw.shape[1] < 3:
        raise BadShape(f"faces must have shape (m, 3), not {raw.shape}")
    raw = as_indices(raw, n_vertices, "face", "vertices")
    if raw.shape[1] > 3:
        raise NotTriangles(f"faces have {raw.shape[1]} corners; split them with geodesics.triangulate(faces)")
    return np.array(raw, dtype=np.int64, order="C")


def as_indices(indices: ArrayLike, bound: int, row: str, things: str) -> Integers:
    """A fresh int64 copy of whole numbers in 0 .. bound - 1; `row` and `things` name them in errors (E105-E107)."""
    if indices is None:
        raise TypeError(f"{row} indices are expected, not None")
    raw = np.atleast_1d(as_array(indices, f"{row} indices"))
    outside = f"{row} {{}} = {{}} refers outside the {bound} {things}; indices count from 0"
    if raw.dtype.kind not in "fiu":
        if raw.dtype.kind == "O" and all(
            type(value) is int for value in raw.flat
        ):  # a list with integers beyond 64 bits
            _refuse_rows((raw < 0) | (raw >= bound), raw, IndexOutOfRange, outside)
        raise BadDtype(f"{row} indices must be whole numbers, not {raw.dtype}")
    if raw.dtype.kind == "f":
        with np.errstate(invalid="ignore"):
            broken = (raw != np.floor(raw)) | ~np.isfinite(raw)
        kind = "no whole number" if raw.ndim == 1 else "not made of whole numbers"
        _refuse_rows(broken, raw, NonIntegralFace, f"{row} {{}} = {{}} is {kind}")
    _refuse_rows((raw < 0) | (raw >= bound), raw, IndexOutOfRange, outside)
    return np.array(raw, dtype=np.int64, order="C")


def as_weights(weights: ArrayLike, n_points: int) -> Floats:
    """Barycentric weights (p, 3) as a fresh float64 copy, rounding errors removed: >= 0 and summing to 1.

    Raises `MeshError`: E107 dtype, E108 shape, E115 not finite, below -1e-6 or a sum further than 1e-6 from 1.
    """
    raw = as_array(weights, "barycentric")
    if raw.size == 0 and n_points == 0:
        return np.empty((0, 3))
    if raw.shape != (n_points, 3):
        raise BadShape(f"barycentric must have shape ({n_points}, 3), one row per point, not {raw.shape}")
    if raw.dtype.kind not in "fiu":
        raise BadDtype(f"barycentric weights must be real numbers, not {raw.dtype}")
    with np.errstate(invalid="ignore", over="ignore"):
        b = np.array(raw, dtype=np.float64, order="C")
        bad = ~(np.isfinite(b) & (b >= -1e-6))
        bad |= ~(np.abs(b.sum(axis=1, keepdims=True) - 1) <= 1e-6)
    _refuse_rows(bad, b, BadWeights, "point {} has weights {}; they must be >= 0 and sum to 1")
    np.maximum(b, 0.0, out=b)
    total = b.sum(axis=1, keepdims=True)
    # a sum already within rounding is left alone, so that checking twice changes nothing
    np.divide(b, total, out=b, where=np.abs(total - 1) > 4 * np.finfo(float).eps)
    return b


def as_array(values: Any, name: str) -> NDArray[Any]:
    """`values` as an array, unconverted; E107 for masked entries, E108 for ragged lists, `TypeError` for text."""
    if values is None:
        return np.empty(0)
    if isinstance(values, (str, bytes)) or hasattr(values, "__fspath__"):
        hint = "; files are read by geodesics.read_mesh(path)" if name in OF_A_MESH else ""
        raise TypeError(f"{name} must be an array, not {values!r:.80}{hint}")
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        raise BadDtype(f"{name} have {int(np.ma.count_masked(values))} masked entries; fill or remove them")
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise BadShape(f"{name} do not form a rectangular array ({error})") from error
    if array.dtype.kind == "O" and array.ndim == 0:
        example = "; for example Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])" if name in OF_A_MESH else ""
        raise TypeError(f"{name} must be an array, not {type(values).__name__}{example}")
    return array


def check_area(v: Floats, f: Integers) -> None:
    """`ZeroArea` when no face has an area."""
    if is_flat(v, f).all():
        raise ZeroArea(f"all {len(f)} faces have zero area: their corners coincide or lie on lines, up to rounding")


def is_flat(v: Floats, f: Integers) -> Bools:
    """Faces whose area is no more than rounding of the coordinates alone would give, shape (m,)."""
    a, b, c = v[f.T]
    double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.sqrt(np.maximum(((b - a) ** 2).sum(axis=1), ((c - a) ** 2).sum(axis=1)))
    return np.asarray(double_area <= 4 * np.finfo(float).eps * np.abs(v[f]).max(axis=(1, 2)) * longest)


def _check_range(v: Floats) -> None:
    """`CoordinateRange` naming the farthest vertex when the extent leaves what float64 can square twice."""
    size = np.abs(v - v[0] if np.abs(v).max() < LARGEST_EXTENT else v).max(axis=1)
    extent, farthest = size.max(), int(size.argmax())
    if extent >= LARGEST_EXTENT or 0 < extent <= SMALLEST_EXTENT:
        raise CoordinateRange(
            f"vertex {farthest} = {v[farthest]} makes the extent {extent:.3g}, and areas leave float64; "
            "rescale the coordinates towards 1"
        )


def _refuse_rows(bad: Bools, raw: NDArray[Any], error: type[Exception], message: str) -> None:
    """Raise `error` for the first row of `raw` with a bad entry; `message` takes the row's number and content."""
    if np.any(bad):
        row = int(np.argmax(np.asarray(bad, dtype=bool).reshape(len(raw), -1).any(axis=1)))
        raise error(message.format(row, raw[row]))
