"""What a distance is."""

from __future__ import annotations

from typing import Protocol

from geodesics.arrays import Floats
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints

FEWER_POINTS = "measure from fewer points at a time, or from samples (`farthest_point_sampling`)"


class Distance(Protocol):
    """Anything that measures distances from points to all vertices of one mesh."""

    @property
    def mesh(self) -> Mesh:
        """The mesh, of n vertices."""

    def field(self, points: SurfacePoints) -> Floats:
        """Distances (p, n) from each of p points to every vertex, in the unit of the metric; +inf where unreachable."""
