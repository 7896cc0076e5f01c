"""Distances among points, as a matrix."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.distance import FEWER_POINTS, Distance, as_distance, as_points
from geodesics.euclidean import euclidean_distances
from geodesics.memory import table
from geodesics.points import SurfacePoints
from geodesics.topology.components import vertex_components

FIELDS = 256  # that are held at a time: a bound of the memory


def distance_matrix(
    distance: Distance, points: SurfacePoints | ArrayLike, others: SurfacePoints | ArrayLike | None = None
) -> Floats:
    r"""The distances :math:`D_{ij} = d(x_i, y_j)` among points, or from points to others (sec. 3).

    Spectral distances are exact anywhere on the triangles, as (3.1) and (3.2) are linear there before the norm is
    taken; other distances are interpolated from their fields, those among points from both of their fields, so that the
    matrix is symmetric with a diagonal of zeros.

    Parameters
    ----------
    distance : Distance
        What is measured.
    points : SurfacePoints or array_like of int
        The p points x, or vertices.
    others : SurfacePoints or array_like of int, optional
        The q points y, or vertices; the points themselves unless given.

    Returns
    -------
    array of shape (p, q)
        Distances in the unit of the metric; +inf where y cannot be reached.

    Raises
    ------
    MeshError
        E105 for vertices that do not exist and for points of another mesh.
    WouldExceedMemory
        E501 when the matrix does not fit.

    See Also
    --------
    GeodesicDistance, DiffusionDistance, CommuteTimeDistance : Their `field` is a row for all vertices.
    gmds.canonical_form : Points in a Euclidean space that have these distances.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.distance_matrix(geodesics.GeodesicDistance(sphere), [0, 1, 2]).shape
    (3, 3)
    """
    distance = as_distance(distance)
    x = as_points(distance.mesh, points)
    y = x if others is None else as_points(distance.mesh, others)
    result = table(len(x), len(y), "distances", FEWER_POINTS)
    measure = _by_rows if hasattr(distance, "spectrum") and hasattr(distance, "embedding") else _by_fields
    measure(distance, x, y, result)
    if others is None:
        with np.errstate(invalid="ignore"):
            result = 0.5 * (result + result.T)
        np.fill_diagonal(result, 0.0)
    return result


def _by_rows(distance: Any, x: SurfacePoints, y: SurfacePoints, result: Floats) -> None:
    """Fill in (p, q) the distances between rows of the embedding."""
    result[:] = euclidean_distances(x.interpolate(distance.embedding), y.interpolate(distance.embedding))
    label = vertex_components(distance.mesh)[distance.mesh.faces[:, 0]]
    result[label[x.face][:, None] != label[y.face]] = np.inf


def _by_fields(distance: Distance, x: SurfacePoints, y: SurfacePoints, result: Floats) -> None:
    """Fill in (p, q) the fields of the points, interpolated at the others."""
    corners = distance.mesh.faces[y.face]
    for start in range(0, len(x), FIELDS):
        rows = slice(start, start + FIELDS)
        at_corners = np.where(y.barycentric > 0, distance.field(x[rows])[:, corners], 0.0)  # 0 * inf would be nan
        result[rows] = (at_corners * y.barycentric).sum(axis=2)
