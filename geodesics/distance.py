"""What a distance is."""

from __future__ import annotations

from typing import Any, Protocol

from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.errors import IndexOutOfRange
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

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> distance: geodesics.Distance = geodesics.BiharmonicDistance(sphere)
    >>> distance.field([0, 1]).shape
    (2, 162)
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


def as_distance(distance: Any) -> Distance:
    """The distance that it is. Raises `TypeError` that says how to make one of a mesh, a metric or a spectrum."""
    if hasattr(distance, "mesh") and callable(getattr(distance, "field", None)):
        return distance  # type: ignore[no-any-return]
    kind = "Mesh" if isinstance(distance, Mesh) else type(distance).__name__  # which may be one of a kind of its own
    raise TypeError(f"a distance is expected, not {kind}; for example geodesics.GeodesicDistance(mesh)")


def as_points(mesh: Mesh, points: SurfacePoints | ArrayLike) -> SurfacePoints:
    """Points of a mesh, from points or from the numbers of vertices, one or several.

    Raises `MeshError` (E105) for vertices that do not exist and for points of a mesh with other counts.
    """
    if not isinstance(points, SurfacePoints):
        return SurfacePoints.at_vertices(mesh, points)
    given = points.mesh
    if given is not mesh and (given.n_vertices, given.n_faces) != (mesh.n_vertices, mesh.n_faces):
        raise IndexOutOfRange(f"the points lie on another mesh, {given!r}, and not on {mesh!r}")
    return points
