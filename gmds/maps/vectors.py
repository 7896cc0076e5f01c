"""Directions on one surface, turned as a map turns the surface, to directions on the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import vertex_normals
from geodesics.arrays import Floats, Integers
from gmds.errors import MapError
from gmds.maps.point_map import PointMap


def carry_vectors(answer: PointMap, vectors: ArrayLike) -> Floats:
    """Vectors in space on the vertices of the target as vectors on those of the source.

    Each is interpolated where the vertex goes, then turned back by `turns`: lengths stay, what is tangent to the target
    becomes tangent to the source but for the error of the normals.

    Parameters
    ----------
    answer : Correspondence
        The map, of n_source vertices.
    vectors : array_like of shape (n_target, 3)
        In the frame of the target's file.

    Returns
    -------
    float64 array of shape (n_source, 3)
        In the frame of the source's file.

    Raises
    ------
    MapError
        For another shape.

    See Also
    --------
    turns : The matrices.
    gmds.maps.values.carry : Values that do not turn.
    """
    given = np.asarray(vectors, dtype=np.float64)
    if given.shape != (answer.target.n_vertices, 3):
        raise MapError(f"vectors must have shape ({answer.target.n_vertices}, 3), a row a vertex, not {given.shape}")
    return np.asarray(np.einsum("nba,nb->na", turns(answer), answer.points.interpolate(given)), dtype=np.float64)


def turns(answer: PointMap) -> Floats:
    """Orthogonal matrices that turn the surface around each source vertex as the map does.

    The polar factor of the differential of the map, averaged over the faces around the vertex by area, which sends the
    normal of the source to that of the target; it reverses orientation where the map does.

    Parameters
    ----------
    answer : Correspondence
        The map, of n_source vertices.

    Returns
    -------
    float64 array of shape (n_source, 3, 3)
        The identity at vertices on no face.

    See Also
    --------
    carry_vectors : Vectors turned back by them.
    """
    source, image = answer.source, answer.points.positions
    rise, run = _edges(image, source.faces), _edges(source.vertices, source.faces)
    area = np.linalg.norm(np.cross(run[:, 0], run[:, 1]), axis=1)
    differential = np.swapaxes(rise, 1, 2) @ np.linalg.pinv(np.swapaxes(run, 1, 2))
    total = np.zeros((source.n_vertices, 3, 3))
    weight = np.zeros(source.n_vertices)
    for corner in source.faces.T:
        np.add.at(total, corner, area[:, None, None] * differential)
        np.add.at(weight, corner, area)
    total /= np.where(weight > 0, weight, 1)[:, None, None]
    stretch = np.sqrt((total**2).sum(axis=(1, 2)) / 2)
    here, there = vertex_normals(source), answer.points.interpolate(vertex_normals(answer.target))
    total += np.where(stretch > 0, stretch, 1)[:, None, None] * there[:, :, None] * here[:, None, :]
    total[weight <= 0] = np.eye(3)
    u, _, v = np.linalg.svd(total)
    return np.asarray(u @ v, dtype=np.float64)


def _edges(vertices: Floats, faces: Integers) -> Floats:
    """Two edges (m, 2, 3) of every face, from its first corner."""
    return np.asarray(vertices[faces[:, 1:]] - vertices[faces[:, :1]], dtype=np.float64)
