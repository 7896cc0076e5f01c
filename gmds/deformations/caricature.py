"""The caricature: curved parts grow, flat ones do not."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import Mesh, SurfacePoints, intrinsic, scale_invariant
from geodesics.arguments import real_number
from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from geodesics.linalg.factors import lu_factors
from geodesics.smoothing import DEFAULT_SMOOTHING
from gmds.deformations.truths import moved

PIN = 1e-9  # of the mean diagonal, by which every component is held where it is: a bound, nothing beside the edges


def caricature(
    mesh: Mesh, exponent: float = 0.3, *, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING
) -> tuple[Mesh, SurfacePoints]:
    r"""Exaggerate what is curved: gradients of the coordinates scaled by a power of the curvature (beside (2.1)).

    .. math:: \min_{x'} \int_S \| \nabla x' - |K|^{\gamma} \nabla x \|^2 da, \qquad
              \Delta x' = \mathrm{div} \, ( |K|^{\gamma} \nabla x )

    Lengths grow by about :math:`|K|^{\gamma}`: the local scale field that the surface itself suggests, and that the
    scale-invariant metric is made to undo. :math:`|K|` is regularised as in that metric and relative to the sphere of
    the same area, which keeps its size. A bent surface has the bent caricature.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    exponent : float
        :math:`\gamma`: 0 for the mesh as it is, 0.2 to 0.5 for caricatures, below 0 for their opposite.
    regularisation, smoothing : float
        As of `geodesics.scale_invariant`.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    References
    ----------
    Sela, Aflalo, Kimmel: Computational caricaturization of surfaces (2015). |K| as in (2.1) of Aflalo, Kimmel, Raviv
    (2013).

    See Also
    --------
    local_scaling : Any field of scale.
    """
    mesh, exponent = Mesh.from_object(mesh), real_number(exponent, "exponent")
    metric = scale_invariant(mesh, regularisation=regularisation, smoothing=smoothing)
    sphere = 4 * np.pi / mesh.area * np.hypot(1.0, regularisation)
    with np.errstate(over="ignore"):
        growth = (np.asarray(metric.conformal_factor) / sphere) ** exponent
    if not np.isfinite(growth).all():
        raise BadArgument(f"exponent {exponent:g} is too large: powers of the curvature are beyond all numbers")
    cotangents = intrinsic.cotangents(intrinsic.squared_lengths(mesh.vertices, mesh.faces))
    plain = _stiffness(mesh, cotangents)
    scaled = _stiffness(mesh, cotangents * growth[mesh.faces].mean(axis=1, keepdims=True))
    centre = mesh.vertices.mean(axis=0)
    x = mesh.vertices - centre
    pin = PIN * plain.diagonal().mean()
    solve = lu_factors((plain + pin * sp.eye(mesh.n_vertices)).tocsc()).solve
    return moved(mesh, centre + solve(scaled @ x + pin * x))


def _stiffness(mesh: Mesh, cotangents: Floats) -> sp.csr_matrix:
    """The cotangent matrix (n, n) over the mesh's own faces; cotangents (m, 3) may carry a weight of each face."""
    n, (a, b, c) = mesh.n_vertices, mesh.faces.T
    i, j = np.concatenate([b, c, a]), np.concatenate([c, a, b])
    off = sp.coo_matrix((0.5 * cotangents.T.ravel(), (i, j)), shape=(n, n))
    off = (off + off.T).tocsr()
    return sp.csr_matrix(sp.diags(np.asarray(off.sum(axis=1)).ravel()) - off)
