"""The scale-invariant metric."""

from __future__ import annotations

from geodesics.curvature import gaussian_curvature
from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics._regularised import regularised
from geodesics.smoothing import DEFAULT


def scale_invariant(
    mesh: Mesh, *, exponent: float = 1.0, regularisation: float = 1.0, smoothing: float = DEFAULT
) -> Metric:
    """The metric |K|^a g (eq. (2.1), Theorem 2.1), regularised as (K^2 + eps^2)^(a/2) g.

    eps = regularisation * 4 pi / area, so the metric does not change with the size of the surface. The exponent a goes
    from the embedded metric (0) to the paper's (1), as in Halimi and Kimmel; for `smoothing` see `gaussian_curvature`.
    """
    return conformal(mesh, regularised(mesh, gaussian_curvature(mesh, smoothing), regularisation) ** exponent)
