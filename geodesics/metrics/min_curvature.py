"""The metric of the smaller principal curvature."""

from __future__ import annotations

import numpy as np

from geodesics.curvature import principal_curvatures
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics._regularised import regularised
from geodesics.smoothing import DEFAULT_SMOOTHING


@of_a_mesh
def min_curvature(mesh: Mesh, *, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING) -> Metric:
    r"""The metric of the smaller principal curvature (7.1), which the paper names and leaves unexplored.

    .. math:: \tilde g_{ij} = \kappa_{\min}^2 \, g_{ij}, \qquad \kappa_{\min}^2 = \big( \sqrt{H^2 - K} - |H| \big)^2

    It is invariant to scale, and bending changes it. The factor is regularised as :math:`|K|` is below (2.1).

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

    See Also
    --------
    scale_invariant : Invariant to bending as well.
    principal_curvatures : Both principal curvatures.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> large = geodesics.Mesh(10 * sphere.vertices, sphere.faces)
    >>> areas = [geodesics.min_curvature(mesh).mass.sum() for mesh in (sphere, large)]
    >>> float(round(areas[1] / areas[0], 6))
    1.0
    """
    first, second = principal_curvatures(mesh, smoothing)
    smaller = np.minimum(np.abs(first), np.abs(second))
    return conformal(mesh, regularised(mesh, smaller**2, regularisation))
