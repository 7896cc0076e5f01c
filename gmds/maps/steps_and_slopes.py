r"""A field on a surface cleared of noise: level or gently sloping, with few steep places.

.. math:: \min_u \int w \, \rho(u - g) + \lambda \int \sqrt{|\nabla u|^2 + \sigma^2}

Total variation (Rudin, Osher, Fatemi 1992) lets a field rise steeply from a part that grew to one that did not, where a
heat step would smear it; :math:`\rho` is quadratic for small deviations and linear for large ones, so that a few places
where a map folds do not drag their surroundings along. Solved by weights found anew a few times.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import cg

from geodesics.arrays import Floats
from geodesics.delaunay import IntrinsicTriangulation
from geodesics.intrinsic import areas, cotangents
from geodesics.laplacian import cotangent_matrix
from geodesics.metric import Metric

# Chosen on the development pairs of `benchmarks.study.growth` (`benchmarks/results/growth_development.csv`): the slope
# beyond which a field is steep, per root area, and the deviation beyond which a value is an outlier.
STEEP = 1.0
OUTLIER = 0.05
REWEIGHTED = 6  # times, a bound: the sixth changes values by less than a hundredth
ACCURACY = 1e-6  # of each linear system, relative: a bound
SYSTEM_STEPS = 500  # a bound


def cleared(metric: Metric, values: Floats, weights: Floats, strength: float) -> Floats:
    r"""The field (n,) that is left of noisy `values` (n,), trusted by `weights` (n,) from 0 to 1.

    `strength` is :math:`\lambda`, in units of the area of the whole times the unit of the values over the root of it.
    """
    mesh, mass = metric.mesh, metric.mass / max(metric.mass.sum(), np.finfo(float).tiny)
    triangles = IntrinsicTriangulation(mesh.faces, metric.l_sq)
    half_cot, area = 0.5 * cotangents(metric.l_sq), areas(metric.l_sq)
    area /= max(area.sum(), np.finfo(float).tiny)
    u = values.copy()
    for _ in range(REWEIGHTED):
        rise = u[mesh.faces[:, [1, 2, 0]]] - u[mesh.faces[:, [2, 0, 1]]]
        steepness = np.maximum((half_cot * rise**2).sum(axis=1), 0.0) / np.maximum(area, np.finfo(float).tiny)
        spread = cotangent_matrix(triangles, mesh.n_vertices, 1 / np.sqrt(steepness + STEEP**2))
        trust = mass * weights / np.sqrt(1 + ((u - values) / OUTLIER) ** 2)
        u = _solved(sp.diags(trust) + strength * spread, trust * values, u)
    return u


def _solved(matrix: sp.spmatrix, right: Floats, start: Floats) -> Floats:
    diagonal = matrix.diagonal()
    scale = sp.diags(np.where(diagonal > 0, 1 / np.where(diagonal > 0, diagonal, 1.0), 1.0))
    found, _ = cg(matrix.tocsr(), right, x0=start, rtol=ACCURACY, maxiter=SYSTEM_STEPS, M=scale)
    return np.asarray(found, dtype=np.float64)
