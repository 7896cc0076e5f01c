"""Geodesic distance in any metric, by fast marching."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics._kernels import marching
from geodesics.arrays import Floats, Integers
from geodesics.distance import FEWER_POINTS, as_points
from geodesics.errors import BadArgument
from geodesics.fast_marching.front import corners, fresh_front, longest_edges
from geodesics.fast_marching.seeds import seeds
from geodesics.memory import table
from geodesics.mesh import Mesh
from geodesics.metric import Metric, as_metric
from geodesics.points import SurfacePoints
from geodesics.threads import side_by_side, spare


@dataclass(frozen=True, eq=False)
class GeodesicDistance:
    """Geodesic distance in a metric, by fast marching with unfolded sources.

    In the scale-invariant metric its paths are the scale invariant geodesics of the abstract. A conformal metric is
    marched over the intrinsic Delaunay triangulation of the embedded one, whose angles it shares; any other metric over
    the mesh's own faces.

    Parameters
    ----------
    metric : Metric or Mesh
        The metric, on a mesh of n vertices; of a mesh the embedded one.
    threads : int
        Sources that are marched at once, at most, where so many threads are to spare (`geodesics.threads`); the numbers
        do not depend on it.

    References
    ----------
    Kimmel, Sethian: Computing geodesic paths on manifolds (1998); Novotni, Klein: Computing geodesic distances on
    triangular meshes (2002).

    See Also
    --------
    DiffusionDistance, CommuteTimeDistance, BiharmonicDistance : Distances from eigenpairs, less sensitive to topology.
    farthest_point_sampling : Evenly spread samples in this distance.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> field = geodesics.GeodesicDistance(sphere).field(0)[0]
    >>> float(field.max().round(1))  # half a great circle
    3.1
    """

    metric: Metric
    threads: int = 2

    def __post_init__(self) -> None:
        object.__setattr__(self, "metric", as_metric(self.metric))

    @property
    def mesh(self) -> Mesh:
        """The mesh at whose vertices distances are given."""
        return self.metric.mesh

    def field(self, points: SurfacePoints | ArrayLike, *, limit: float = np.inf) -> Floats:
        """Distances from each of p points to every vertex.

        Parameters
        ----------
        points : SurfacePoints or array_like of int
            Points of the mesh, or vertices.
        limit : float
            Where fronts stop, in the unit of the metric.

        Returns
        -------
        array of shape (p, n)
            Distances; +inf where unreachable or farther than `limit`.

        Raises
        ------
        WouldExceedMemory
            E501 when the table does not fit.
        """
        points = as_points(self.mesh, points)
        out = table(len(points), self.mesh.n_vertices, "distances", FEWER_POINTS)
        around = seeds(self.metric, points)
        out[:] = np.inf
        until = _until(self.metric, limit=limit)

        def march(chunk: range) -> None:
            front = fresh_front(self.metric)
            for i in chunk:
                marching.begin(front, around.vertices[i], around.spokes[i], 0.0)
                marching.march(corners(self.metric), front, until)
                marching.finish(front, out[i])

        workers = max(1, min(self.threads, spare(), len(points)))
        side_by_side(march, [range(k, len(points), workers) for k in range(workers)])
        return out

    def to_set(
        self,
        points: SurfacePoints | ArrayLike,
        *,
        values: ArrayLike | None = None,
        stop: ArrayLike | None = None,
        limit: float = np.inf,
    ) -> Floats:
        """Distances to the nearest of p points, each with a head start: min over i of values[i] + d(points[i], x).

        Parameters
        ----------
        points : SurfacePoints or array_like of int
            Points of the mesh, or vertices.
        values : array_like of shape (p,), optional
            Finite offsets in the unit of the metric; 0 by default.
        stop : array_like of int, optional
            Vertices; the front stops when it has passed all of them.
        limit : float
            Where the front stops in any case.

        Returns
        -------
        array of shape (n,)
            Distances; +inf where the front did not arrive.

        Raises
        ------
        ValueError
            Unless there is one finite value per point.
        """
        points = as_points(self.mesh, points)
        start = np.zeros(len(points)) if values is None else np.array(values, dtype=np.float64)
        if start.shape != (len(points),) or not np.isfinite(start).all():
            raise BadArgument(f"values must be {len(points)} finite numbers, one a point")
        wanted = None if stop is None else np.asarray(stop, dtype=np.int64).reshape(-1)
        front, around, out = fresh_front(self.metric), seeds(self.metric, points), np.full(self.mesh.n_vertices, np.inf)
        for i in range(len(points)):
            marching.begin(front, around.vertices[i], around.spokes[i], start[i])
        marching.march(corners(self.metric), front, _until(self.metric, limit=limit, wanted=wanted))
        marching.finish(front, out)
        return out

    def spreader(self) -> Callable[[int, Floats], tuple[Integers, Floats]]:
        """The search for the vertices that a new sample is closest to, for `farthest_point_sampling`.

        Its front stops a little way into what is nearer to others, so that the cells of all samples together cost no
        more than a few fields.

        Returns
        -------
        callable
            (vertex, nearest (n,)) -> the vertices closer to this one than `nearest`, and their distances.
        """
        front, at_vertex = fresh_front(self.metric), np.array([[0.0, np.nan]])
        until = _until(self.metric)

        def closer(vertex: int, nearest: Floats) -> tuple[Integers, Floats]:
            marching.begin(front, np.array([vertex]), at_vertex, 0.0)
            marching.march(corners(self.metric), front, until._replace(nearest=nearest))
            return marching.finish_closer(front, nearest)  # type: ignore[no-any-return]

        return closer


def _until(metric: Metric, *, limit: float = np.inf, wanted: Integers | None = None) -> marching.Until:
    """Where a front stops, as the kernel wants it."""
    n = metric.mesh.n_vertices
    marks = np.zeros(n, dtype=bool)
    if wanted is not None:
        marks[wanted] = True
    margin = longest_edges(metric).max(where=marks, initial=0.0)
    return marching.Until(np.full(n, np.inf), marks, int(marks.sum()), float(limit), float(margin))
