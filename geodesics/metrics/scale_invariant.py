"""The scale-invariant metric."""

from __future__ import annotations

import numpy as np

from geodesics import intrinsic
from geodesics.curvature import gaussian_curvature
from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal


def scale_invariant(mesh: Mesh, *, exponent: float = 1.0, regularisation: float = 1.0, smoothing: float = 3e-4) -> Metric:
    """The metric |K|^a g regularised as (K^2 + eps^2)^(a/2) g, eps = regularisation * 4 pi / area (eq. 2.1)."""
    area = intrinsic.areas(intrinsic.squared_lengths(mesh.vertices, mesh.faces)).sum()
    curvature = gaussian_curvature(mesh, smoothing)
    return conformal(mesh, np.hypot(curvature, regularisation * 4 * np.pi / area) ** exponent)
