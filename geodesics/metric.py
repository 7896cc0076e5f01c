"""A metric on a mesh: three squared edge lengths per face, and a mass per vertex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from geodesics import intrinsic
from geodesics.arguments import real_numbers
from geodesics.arrays import Floats
from geodesics.delaunay import intrinsic_delaunay
from geodesics.errors import BadShape
from geodesics.intrinsic import vertex_areas
from geodesics.mesh import Mesh, of_a_mesh


@dataclass(frozen=True, eq=False)
class Metric:
    r"""A Riemannian metric on a mesh: squared edge lengths per face, and a mass per vertex.

    Three lengths per triangle are the same as a metric tensor on it. Neighbouring faces need not agree on the length of
    their shared edge.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices and m faces.
    l_sq : array of shape (m, 3)
        Squared edge lengths in this metric; column k is the edge opposite corner k.
    mass : array of shape (n,)
        Area in this metric that each vertex stands for. Integrals over the surface are ``mass @ values``.
    conformal_factor : array of shape (n,), optional
        The factor :math:`\rho` per vertex where the metric is :math:`\rho g`, g the embedded metric, else None. Such
        metrics share angles, so their edge flips and their stiffness matrix are those of the embedded metric.

    See Also
    --------
    conformal : The metric of a given factor.
    embedded, scale_invariant, min_curvature, equi_affine, affine : The metrics of the paper.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> metric = geodesics.embedded(triangle)
    >>> metric.l_sq.tolist(), float(metric.mass.sum())
    ([[25.0, 16.0, 9.0]], 6.0)
    """

    mesh: Mesh
    l_sq: Floats
    mass: Floats
    conformal_factor: Floats | None = None

    def __repr__(self) -> str:
        kind = "not conformal to that of space" if self.conformal_factor is None else "conformal to that of space"
        return f"Metric(area {self.mass.sum():.3g}, {kind}, on {self.mesh!r})"


@of_a_mesh
def conformal(mesh: Mesh, factor: Floats) -> Metric:
    r"""The metric :math:`\rho g`, with g the embedded metric.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    factor : array of shape (n,)
        The positive factor :math:`\rho` at each vertex.

    Returns
    -------
    Metric
        Every face has one scale, the mean of :math:`\sqrt{\rho}` over its corners, so that triangles stay triangles.

    See Also
    --------
    embedded : The case :math:`\rho = 1`.
    scale_invariant : The case :math:`\rho = |K|`.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> import numpy as np
    >>> metric = geodesics.conformal(sphere, np.full(sphere.n_vertices, 4.0))  # lengths twice as long
    >>> float((metric.l_sq / geodesics.embedded(sphere).l_sq).max().round(6))
    4.0
    """
    factor = real_numbers(factor, "factor")
    if factor.shape != (mesh.n_vertices,):
        raise BadShape(f"factor must be {mesh.n_vertices} numbers, one for each vertex, not of shape {factor.shape}")
    l_sq = intrinsic.conformal_lengths(intrinsic.squared_lengths(mesh.vertices, mesh.faces), mesh.faces, factor)
    mass = factor * vertex_areas(*intrinsic_delaunay(mesh), mesh.n_vertices)
    return Metric(mesh, l_sq, mass, factor)


def as_metric(metric: Any) -> Metric:
    """A metric, or of a mesh its embedded metric. Raises `TypeError` that says how to make one."""
    if isinstance(metric, Metric) or all(hasattr(metric, name) for name in ("mesh", "l_sq", "mass")):
        return metric  # type: ignore[no-any-return]
    try:
        mesh = Mesh.from_object(metric)
    except TypeError:
        kind = type(metric).__name__
        raise TypeError(f"a metric or a mesh is expected, not {kind}; for example geodesics.embedded(mesh)") from None
    return conformal(mesh, np.ones(mesh.n_vertices))
