"""A metric on a mesh: three squared edge lengths per face, and a mass per vertex."""

from __future__ import annotations

from dataclasses import dataclass

from geodesics import intrinsic
from geodesics.arrays import Floats
from geodesics.delaunay import intrinsic_delaunay
from geodesics.intrinsic import vertex_areas
from geodesics.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Metric:
    """Squared edge lengths l_sq (m, 3), edge k opposite corner k, and vertex mass (n,).

    Three lengths per triangle are a metric tensor; neighbouring faces need not agree on the length of their
    shared edge. `conformal_factor` (n,) is rho when the metric is rho * g with g the embedded one, else None:
    conformal metrics share angles, so flips and stiffness are those of the embedded metric.
    """

    mesh: Mesh
    l_sq: Floats
    mass: Floats
    conformal_factor: Floats | None = None


def conformal(mesh: Mesh, factor: Floats) -> Metric:
    """The metric rho * g for a positive factor rho (n,) per vertex; g is the embedded metric."""
    l_sq = intrinsic.conformal_lengths(intrinsic.squared_lengths(mesh.vertices, mesh.faces), mesh.faces, factor)
    mass = factor * vertex_areas(*intrinsic_delaunay(mesh), mesh.n_vertices)
    return Metric(mesh, l_sq, mass, factor)
