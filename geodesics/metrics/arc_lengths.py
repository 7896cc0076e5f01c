"""The other scale-invariant arc lengths of sec. 2; only the last one is also invariant to isometries."""

from __future__ import annotations

import numpy as np

from geodesics.curvature import gaussian_curvature, mean_curvature, principal_curvatures
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics._regularised import regularised
from geodesics.smoothing import DEFAULT_SMOOTHING


@of_a_mesh
def first_curvature_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING) -> Metric:
    r"""The arc length :math:`d\tau = |k_1| \, ds` (sec. 2), :math:`k_1` the larger signed principal curvature.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    regularisation : float
        eps of the regularisation below (2.1), in units of 4 pi / area: the curvature of a sphere of the same area.
    smoothing : float
        As of `gaussian_curvature`, without unit.

    Returns
    -------
    Metric
        Its lengths have no unit.
    """
    return conformal(mesh, regularised(mesh, principal_curvatures(mesh, smoothing)[0] ** 2, regularisation))


@of_a_mesh
def second_curvature_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING) -> Metric:
    r"""The arc length :math:`d\tau = |k_2| \, ds` (sec. 2), :math:`k_2` the smaller signed principal curvature.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    regularisation : float
        eps of the regularisation below (2.1), in units of 4 pi / area: the curvature of a sphere of the same area.
    smoothing : float
        As of `gaussian_curvature`, without unit.

    Returns
    -------
    Metric
        Its lengths have no unit.
    """
    return conformal(mesh, regularised(mesh, principal_curvatures(mesh, smoothing)[1] ** 2, regularisation))


@of_a_mesh
def curvature_ratio_length(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING) -> Metric:
    r"""The arc length :math:`d\tau = |K / H| \, ds = 2 \, ds / |\rho_1 + \rho_2|` (sec. 2).

    Where H vanishes the factor is bounded by :math:`4 |K|`.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    regularisation : float
        eps of the regularisation below (2.1), in units of 4 pi / area: the curvature of a sphere of the same area.
    smoothing : float
        As of `gaussian_curvature`, without unit.

    Returns
    -------
    Metric
        Its lengths have no unit.
    """
    k, h = gaussian_curvature(mesh, smoothing), mean_curvature(mesh, smoothing)
    squared = k**2 / np.maximum(h**2, np.abs(k) / 4 + np.finfo(float).tiny)
    return conformal(mesh, regularised(mesh, squared, regularisation))


@of_a_mesh
def gaussian_curvature_length(
    mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING
) -> Metric:
    r"""The arc length :math:`d\tau = \sqrt{|K|} \, ds` (sec. 2), that of the scale-invariant metric (2.1).

    Parameters
    ----------
    mesh : Mesh
        The surface.
    regularisation : float
        eps of the regularisation below (2.1), in units of 4 pi / area: the curvature of a sphere of the same area.
    smoothing : float
        As of `gaussian_curvature`, without unit.

    Returns
    -------
    Metric
        Its lengths have no unit.
    """
    return conformal(mesh, regularised(mesh, gaussian_curvature(mesh, smoothing), regularisation))
