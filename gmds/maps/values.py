"""Values on the vertices of one surface, read off at points of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics.arrays import Floats
from geodesics.points import SurfacePoints
from gmds.errors import MapError

HELD = 0.5  # of a point's corners, by weight, that must have weights for it to have some: the nearer side decides


def carry(points: SurfacePoints, values: NDArray[Any], labels: bool | None = None) -> NDArray[Any]:
    """Values per vertex of the points' mesh as values per point.

    Parameters
    ----------
    points : SurfacePoints
        p points of a mesh with n vertices.
    values : array of shape (n,) or (n, ...)
        Of any dtype.
    labels : bool, optional
        Whether values are names (the largest weight wins, the dtype stays) or quantities (linear interpolation: floats
        keep their precision, uint8 colours are rounded, other integers become float64). Unless given the dtype decides:
        floats, complex numbers and uint8 with 3 or 4 columns are quantities.

    Returns
    -------
    array of shape (p,) or (p, ...)
        The values at the points.

    Raises
    ------
    MapError
        When there is not one row for each vertex.

    See Also
    --------
    Correspondence.transfer : The same along a map.
    carry_weights : Weights that sum to 1.
    gmds.maps.vectors.carry_vectors : Directions in space.
    """
    if values.ndim == 0 or len(values) != points.mesh.n_vertices:
        rows = "a single value" if values.ndim == 0 else f"{len(values)} rows"
        raise MapError(
            f"values has {rows}; the target has {points.mesh.n_vertices} vertices and needs one row for each"
        )
    corners = values[points.mesh.faces[points.face]]
    if is_label(values) if labels is None else labels:
        return _majority(corners, points.barycentric)
    return _blend(corners, points.barycentric)


def carry_weights(points: SurfacePoints, weights: ArrayLike, *, most: int | None = None) -> Floats:
    """Weights per vertex, as of bones in skinning, as weights per point: interpolated, rows sum to 1.

    A vertex may have no weights, a row of 0, as one that no bone moves: a point has none where most of its corners,
    by their barycentric weights, have none. Vertices on no face are not looked at.

    Parameters
    ----------
    points : SurfacePoints
        p points of a mesh with n vertices.
    weights : array_like of shape (n, k)
        Not negative, a column for each bone.
    most : int, optional
        How many bones may hold a point, the heaviest ones: four is what most game engines and glTF readers take.

    Returns
    -------
    float64 array of shape (p, k)
        Each row sums to 1, or is 0.

    Raises
    ------
    MapError
        Naming the vertex on a face whose weights are negative or not finite; for another shape.

    See Also
    --------
    carry : Any other values.
    """
    given = np.asarray(weights, dtype=np.float64)
    if given.ndim != 2:
        raise MapError(f"weights must have shape (n, k), a column for each bone, not {given.shape}")
    if len(given) != points.mesh.n_vertices:
        raise MapError(f"weights have {len(given)} rows, and the target has {points.mesh.n_vertices} vertices")
    used = np.unique(points.mesh.faces)
    wrong = used[~(np.isfinite(given[used]) & (given[used] >= 0)).all(axis=1)]
    if len(wrong):
        raise MapError(f"the weights of vertex {wrong[0]} must be finite and at least 0")
    clean = np.zeros_like(given)
    clean[used] = given[used]
    carried = carry(points, _to_sum_one(clean), labels=False)
    carried[carried.sum(axis=1) < HELD] = 0
    if most is not None and most < carried.shape[1]:
        lightest = np.argsort(-carried, axis=1, kind="stable")[:, max(most, 1) :]
        np.put_along_axis(carried, lightest, 0.0, axis=1)
    return np.asarray(_to_sum_one(carried), dtype=np.float64)


def _to_sum_one(weights: Floats) -> Floats:
    """Rows divided by their sum, where it is not 0."""
    total = weights.sum(axis=1, keepdims=True)
    return np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)


def is_label(values: NDArray[Any]) -> bool:
    """Whether values are names rather than quantities.

    Parameters
    ----------
    values : array
        Of any dtype and shape.

    Returns
    -------
    bool
        True for integers, booleans, strings and other names; False for floats, complex numbers and uint8 colours.
    """
    colour = values.dtype == np.uint8 and values.ndim == 2 and values.shape[1] in (3, 4)
    return values.dtype.kind not in "fc" and not colour


def _blend(corners: NDArray[Any], weights: Floats) -> NDArray[Any]:
    """Linear interpolation of (p, 3, ...) corner values; a corner of weight zero has no say, even when it is NaN."""
    w = weights.reshape(weights.shape + (1,) * (corners.ndim - 2))
    with np.errstate(invalid="ignore", over="ignore"):
        blended = np.where(w == 0, 0, corners * w).sum(axis=1)
    if corners.dtype == np.uint8:
        return np.clip(np.rint(blended), 0, 255).astype(np.uint8)
    return blended.astype(corners.dtype) if corners.dtype.kind in "fc" else blended.astype(np.float64)


def _majority(corners: NDArray[Any], weights: Floats) -> NDArray[Any]:
    """Per row the corner label (p, 3, ...) with the largest total weight; a tie goes to the heaviest corner."""
    rows = corners.reshape(len(corners), 3, -1)
    same = (rows[:, :, None] == rows[:, None, :]).all(axis=-1)
    share = np.einsum("pij,pj->pi", same, weights)
    heaviest = np.zeros_like(weights)
    heaviest[np.arange(len(weights)), weights.argmax(axis=1)] = 1e-9
    return np.ascontiguousarray(corners[np.arange(len(corners)), (share + heaviest).argmax(axis=1)])
