r"""Semilandmarks slid along curves and patches until they say as little as possible of where they were put.

Each semilandmark i may move along one tangent (of a curve) or two (of a patch). With all these as columns of U,

.. math:: Y = Y^0 - U (U^T B U)^{-1} U^T B Y^0

minimises the bending energy of the thin-plate spline from the reference to Y (Bookstein 1997; Gunz, Mitteroecker and
Bookstein 2005), where B has the upper left block of the inverse of its system for each coordinate, with the kernel -r
of space. With the identity in place of B, and the difference from the reference in place of Y, it is the Procrustes
distance that becomes least.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import scipy.linalg
from scipy.spatial.distance import cdist

from geodesics import Mesh, SurfacePoints, vertex_normals
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument, BadShape
from gmds.morphometrics.procrustes import superimposed

Criterion = Literal["bending", "procrustes"]
ROUNDS = 10  # of sliding and superposition, a bound: most do not move after three to five
STILL = 1e-4  # change of the mean, over its centroid size, below which sliding has settled; set by hand


def bending_energy_matrix(reference: Floats) -> Floats:
    """The matrix B (k, k) of the thin-plate spline with knots `reference` (k, 3): trace(Y' B Y) is its energy."""
    k = len(reference)
    affine = np.column_stack([np.ones(k), reference])
    system = np.block([[-cdist(reference, reference), affine], [affine.T, np.zeros((4, 4))]])
    return np.asarray(np.linalg.pinv(system)[:k, :k], dtype=np.float64)


def bending_energy(reference: Floats, points: Floats) -> float:
    """The bending energy of the thin-plate spline from `reference` (k, 3) to `points` (k, 3); 0 if it is affine."""
    return float(np.trace(points.T @ bending_energy_matrix(reference) @ points))


def slid(points: Floats, reference: Floats, which: Integers, tangents: Floats, by: Criterion = "bending") -> Floats:
    """Points (k, 3), of which each of `which` (s,) moved along its tangent (s, 3), so that the criterion is least.

    A point of a patch stands in `which` twice, with two tangents. Raises `BadArgument` (E604) for another criterion,
    `BadShape` (E108) when tangents and points are not as many.
    """
    if len(which) != len(tangents):
        raise BadShape(f"there are {len(which)} points that slide and {len(tangents)} tangents")
    if by not in ("bending", "procrustes"):
        raise BadArgument(f"semilandmarks slide by bending or procrustes, not {by!r}")
    k, s = len(points), len(which)
    along = np.zeros((3, k, s))
    along[:, which, np.arange(s)] = tangents.T
    flat = along.reshape(3 * k, s)
    if by == "bending":
        energy = bending_energy_matrix(reference)
        pulled = np.concatenate([energy @ along[axis] for axis in range(3)])
        start = points.T.ravel()
    else:
        pulled, start = flat, (points - reference).T.ravel()
    step, *_ = scipy.linalg.lstsq(flat.T @ pulled, -(pulled.T @ start))
    return np.asarray(points + (flat @ step).reshape(3, k).T, dtype=np.float64)


def slide_all(
    configurations: Floats,
    curves: Sequence[tuple[int, int, int]] = (),
    patches: Sequence[int] = (),
    meshes: Sequence[Mesh] | None = None,
    by: Criterion = "bending",
) -> Floats:
    """Configurations (n, k, 3) whose semilandmarks slid, in turn with superposition, until the mean shape rests.

    Parameters
    ----------
    configurations : float64 array of shape (n, k, 3)
        Landmarks and semilandmarks of n specimens.
    curves : sequence of (before, point, after)
        A semilandmark of a curve, and its neighbours, which tell the tangent.
    patches : sequence of int
        Semilandmarks of a surface.
    meshes : sequence of Mesh, optional
        The specimens: slid points are put back on them. Needed for patches.
    by : {"bending", "procrustes"}
        What is to be least.

    Returns
    -------
    float64 array of shape (n, k, 3)
        In the place of each specimen.

    Raises
    ------
    BadArgument
        E604 for patches without meshes.
    """
    x = np.array(configurations, dtype=np.float64)
    if len(patches) and meshes is None:
        raise BadArgument("semilandmarks of a patch need the meshes that they slide on")
    before = superimposed(x)
    for _ in range(ROUNDS):
        for i in range(len(x)):
            reference = before.moves[i].inverse(before.mean)
            which, tangents = _tangents(x[i], curves, patches, None if meshes is None else meshes[i])
            moved = slid(x[i], reference, which, tangents, by)
            if meshes is not None:
                rows = np.unique(which)
                moved[rows] = SurfacePoints.closest(meshes[i], moved[rows]).positions
            x[i] = moved
        after = superimposed(x)
        change = float(np.linalg.norm(after.mean - before.mean))
        before = after
        if change < STILL:
            break
    return x


def _tangents(
    points: Floats, curves: Sequence[tuple[int, int, int]], patches: Sequence[int], mesh: Mesh | None
) -> tuple[Integers, Floats]:
    """Which points slide, and along which unit vectors."""
    chain = np.asarray(curves, dtype=np.int64).reshape(-1, 3)
    chords = points[chain[:, 2]] - points[chain[:, 0]]
    chords /= np.maximum(np.linalg.norm(chords, axis=1, keepdims=True), np.finfo(float).tiny)
    if mesh is None or not len(patches):
        return chain[:, 1], chords
    here = np.asarray(patches, dtype=np.int64)
    normals = SurfacePoints.closest(mesh, points[here]).interpolate(vertex_normals(mesh))
    _, _, axes = np.linalg.svd(normals[:, None, :])  # rows 1 and 2 are across the normal
    return np.concatenate([chain[:, 1], here, here]), np.concatenate([chords, axes[:, 1], axes[:, 2]])
