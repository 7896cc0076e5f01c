"""The scale-invariant metric."""

from __future__ import annotations

from geodesics.arguments import real_number
from geodesics.curvature import gaussian_curvature
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics._regularised import regularised
from geodesics.smoothing import DEFAULT_SMOOTHING


@of_a_mesh
def scale_invariant(
    mesh: Mesh, *, exponent: float = 1.0, regularisation: float = 1.0, smoothing: float = DEFAULT_SMOOTHING
) -> Metric:
    r"""The scale-invariant metric (2.1), Theorem 2.1, and its interpolation towards the metric of space.

    .. math:: \tilde g_{ij} = (K^2 + \epsilon^2)^{a/2} \, g_{ij} \approx |K|^a g_{ij}

    What is flat or nearly a cylinder has hardly any Gaussian curvature: at a = 1 trunks shrink, of people to a twelfth
    of the area, and tips of limbs take up to two thirds (benchmarks/results/metric_shares.md). For geodesic distances
    of `gmds.match` a = 1 with a smoothing of 0.02 is best all the same, of a = 0, 1/3, 1/2, 2/3, 1 (plain.md there).

    Parameters
    ----------
    mesh : Mesh
        The surface.
    exponent : float
        :math:`a`, from 0 for the embedded metric to 1 for that of the paper (Halimi and Kimmel interpolate likewise).
    regularisation : float
        :math:`\epsilon` in units of :math:`4 \pi` / area, the curvature of a sphere of the same area, so that the
        metric does not change with the size of the surface.
    smoothing : float
        As of `gaussian_curvature`, without unit.

    Returns
    -------
    Metric
        For exponent 1 its lengths have no unit.

    References
    ----------
    Eq. (2.1) and Theorem 2.1 of Aflalo, Kimmel, Raviv: Scale invariant geometry for nonrigid shapes (2013); Halimi,
    Kimmel: Self functional maps (2018).

    See Also
    --------
    embedded : Exponent 0.
    min_curvature, equi_affine, affine : Other metrics of the paper.
    gaussian_curvature : K.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> large = geodesics.Mesh(10 * sphere.vertices, sphere.faces)
    >>> areas = [geodesics.scale_invariant(mesh).mass.sum() for mesh in (sphere, large)]
    >>> float(round(areas[1] / areas[0], 6))
    1.0
    """
    exponent = real_number(exponent, "exponent")
    return conformal(mesh, regularised(mesh, gaussian_curvature(mesh, smoothing), regularisation) ** exponent)
