"""Left and right: how far shapes differ from mirror images, all alike (directional) or each its way (fluctuating).

Object symmetry (Mardia, Bookstein and Moreton 2000): each shape and its mirror image, with the points of left and right
exchanged, are superimposed together; half their difference is the asymmetry. Matching symmetry: the shapes of one side
are mirrored, and partners of two sides compared (Klingenberg, Barluenga and Meyer 2002).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import Mesh, SurfacePoints, vertex_normals
from geodesics.arrays import Bools, Floats, Integers
from geodesics.errors import BadArgument, BadShape
from gmds.morphometrics.procrustes import superimposed

MIRROR = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Asymmetry:
    """How far k shapes are from symmetric, in units of the aligned shapes, whose mean has centroid size 1.

    Attributes
    ----------
    vectors : float64 array of shape (k, n, 3)
        What takes each point from the symmetric shape to where it is.
    signed : float64 array of shape (k, n)
        Its part along the outward normal, over the root of the area of the mean: positive where this side is larger.
    directional : float64 array of shape (n,)
        The mean of `signed` over the shapes.
    fluctuating : float64 array of shape (n,)
        Its standard deviation over the shapes.
    symmetric : Mesh
        The mean of all shapes and mirror images.
    shares : tuple of float
        Of the summed squares: variation among symmetric shapes, directional and fluctuating asymmetry; they sum to 1.
    valid : bool array of shape (k, n)
        Where both a point and its partner are there.
    """

    vectors: Floats
    signed: Floats
    directional: Floats
    fluctuating: Floats
    symmetric: Mesh
    shares: tuple[float, float, float]
    valid: Bools


def object_asymmetry(configurations: Floats, faces: Integers, partner: SurfacePoints, valid: Bools) -> Asymmetry:
    """The asymmetry of shapes (k, n, 3), each with a left and a right.

    Parameters
    ----------
    configurations : float64 array of shape (k, n, 3)
        Vertices of k meshes.
    faces : int64 array of shape (m, 3)
        Their common triangles.
    partner : SurfacePoints
        Where each vertex is on the other side: n points of any mesh with these triangles.
    valid : bool array of shape (k, n)
        False where a point is missing.

    Returns
    -------
    Asymmetry
        Of each shape.

    Raises
    ------
    BadShape
        E108 when there is not a partner for every vertex.
    """
    if len(partner) != configurations.shape[1]:
        raise BadShape(f"there are {len(partner)} partners and {configurations.shape[1]} vertices")
    corners, weights = faces[partner.face], partner.barycentric
    mirrored = np.einsum("nc,kncd->knd", weights, configurations[:, corners]) * MIRROR
    there = valid & (valid[:, corners] | (weights <= 0)).all(axis=2)
    return _compared(configurations, mirrored, faces, there)


def matching_asymmetry(left: Floats, right: Floats, faces: Integers, valid: Bools) -> Asymmetry:
    """The asymmetry of k pairs of shapes of two sides (k, n, 3), `right` mirrored already; `valid` (k, n) in both."""
    if left.shape != right.shape:
        raise BadShape(f"left is {left.shape} and right is {right.shape}")
    return _compared(left, right, faces, valid)


def _compared(shapes: Floats, images: Floats, faces: Integers, there: Bools) -> Asymmetry:
    k = len(shapes)
    everywhere = there.any(axis=0)
    if everywhere.sum() < 3:
        raise BadArgument("fewer than 3 points are there on both sides of any shape")
    safe = there | ~everywhere
    laid = superimposed(np.concatenate([shapes, images]), np.concatenate([safe, safe]))
    one, other = laid.aligned[:k], laid.aligned[k:]
    vectors = np.where(there[:, :, None], (one - other) / 2, 0.0)
    symmetric, mean = (one + other) / 2, Mesh(laid.mean, faces)
    normals = vertex_normals(mean)
    signed = np.where(there, (vectors * normals).sum(axis=2) / np.sqrt(mean.area), np.nan)
    count = np.maximum(there.sum(axis=0), 1)
    directional = np.where(everywhere, np.nansum(signed, axis=0) / count, np.nan)
    spread = np.nansum((signed - directional) ** 2, axis=0) / np.maximum(count - 1, 1)
    fluctuating = np.where(there.sum(axis=0) > 1, np.sqrt(spread), np.nan)
    alike = vectors.sum(axis=0) / count[:, None]
    rest = np.where(there[:, :, None], vectors - alike, 0.0)
    parts = np.array(
        [
            ((symmetric - symmetric.mean(axis=0)) ** 2).sum(),
            float((there[:, :, None] * alike**2).sum()),
            float((rest**2).sum()),
        ]
    )
    shares = parts / (parts.sum() or 1.0)
    return Asymmetry(vectors, signed, directional, fluctuating, mean, tuple(shares.tolist()), there)
