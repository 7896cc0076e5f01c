"""What a distance is."""

from __future__ import annotations

from typing import Protocol

from geodesics.arrays import Floats
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints

FEWER_POINTS = "measure from fewer points at a time, or from samples (`farthest_point_sampling`)"


class Distance(Protocol):
    """Anything that measures distances from points to all vertices of one mesh.

    A class of your own needs no base class: these two members are enough for `farthest_point_sampling`, `voronoi_cells`
    and `gmds.match`.

    See Also
    --------
    GeodesicDistance : The length of shortest paths.
    DiffusionDistance, CommuteTimeDistance, BiharmonicDistance : Distances between rows of eigenfunctions.
    """

    @property
    def mesh(self) -> Mesh:
        """The mesh, of n vertices."""

    def field(self, points: SurfacePoints) -> Floats:
        """Distances from each of p points to every vertex.

        Parameters
        ----------
        points : SurfacePoints
            Points of the mesh.

        Returns
        -------
        array of shape (p, n)
            Distances in the unit of the metric; +inf at vertices that cannot be reached.
        """
