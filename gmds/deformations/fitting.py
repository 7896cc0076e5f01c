"""Positions that rotate every neighbourhood rigidly and stretch its edges by given factors, as nearly as possible."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import Mesh, intrinsic
from geodesics.arrays import Floats, Integers
from geodesics.linalg.factors import lu_factors


def fit(
    mesh: Mesh, log_scale: Floats, handles: Integers, places: Floats, *, iterations: int = 100, tol: float = 1e-5
) -> Floats:
    r"""Vertices (n, 3) that minimise an as-rigid-as-possible energy with scaled edges over positions x and rotations R.

    .. math:: \sum_i \sum_{e \text{ near } i} w_e \, | x_e - e^{u_e} R_i p_e |^2

    :math:`p_e` and :math:`x_e` are the edges of the faces at vertex i before and after, :math:`u_e = (u_a + u_b) / 2`
    for the ends a, b of e, and :math:`w_e` cotangent weights (Sorkine and Alexa 2007, with rims). Handles (k,) are held
    at `places` (k, 3). Rotations and positions are optimised in turn until no vertex moves more than `tol` of the
    extent, at most `iterations` times.
    """
    n, faces, p = mesh.n_vertices, mesh.faces, mesh.vertices
    start, end = faces[:, [1, 2, 0]], faces[:, [2, 0, 1]]
    weight = 0.5 * intrinsic.cotangents(intrinsic.squared_lengths(p, faces)).clip(0.02, 20)
    edge = np.exp((log_scale[start] + log_scale[end]) / 2)[:, :, None] * (p[end] - p[start]) * weight[:, :, None]
    difference = sp.coo_matrix(
        (np.repeat([1.0, -1.0], start.size), (np.tile(np.arange(start.size), 2), np.r_[end.ravel(), start.ravel()])),
        shape=(start.size, n),
    ).tocsr()
    corner = sp.coo_matrix((np.ones(faces.size), (faces.ravel(), np.repeat(np.arange(len(faces)), 3))))
    corner = corner.tocsr()
    system = (difference.T @ sp.diags(weight.ravel()) @ difference).tocsc()
    stiff = 1e3 * system.diagonal().mean()
    held = np.bincount(handles, minlength=n).astype(float).clip(max=1) * stiff
    # a light pull to the old places pins components without handles; it vanishes beside the edges
    pin = 1e-9 * system.diagonal().mean()
    solve = lu_factors((system + sp.diags(held + pin)).tocsc()).solve
    fixed = pin * p
    fixed[handles] += stiff * places
    x = solve(difference.T @ edge.reshape(-1, 3) + fixed)
    extent = np.ptp(p, axis=0).max()
    for _ in range(iterations):
        now = (x[end] - x[start]).transpose(0, 2, 1)
        spread = corner @ (now @ edge).reshape(len(faces), 9)
        turn = _rotations(spread.reshape(-1, 3, 3))[faces].mean(axis=1)
        new = solve(difference.T @ (edge @ turn.transpose(0, 2, 1)).reshape(-1, 3) + fixed)
        change, x = np.abs(new - x).max(), new
        if change <= tol * extent:
            break
    return x


def _rotations(matrices: Floats) -> Floats:
    """The rotations (n, 3, 3) nearest to the matrices."""
    u, _, vt = np.linalg.svd(matrices)
    u[:, :, 2] *= np.sign(np.linalg.det(u) * np.linalg.det(vt))[:, None]
    return u @ vt
