"""A functional map: the matrix that pulls functions on one surface back to the other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import SurfacePoints
from geodesics.arguments import real_numbers, whole_number
from geodesics.arrays import Floats, Integers
from geodesics.distance import as_points
from geodesics.errors import BadArgument, BadShape
from gmds.spectral.extension import closest_points
from gmds.spectral.functional_maps import nearest_rows
from gmds.spectral.refinement import upsampled
from gmds.surface.view import View

BOTH = "the eigenfunctions that both surfaces have"


@dataclass(frozen=True, eq=False)
class FunctionalMap:
    r"""A map of surfaces as a matrix between their eigenfunctions (sec. 4): it pulls target functions back.

    .. math:: \psi_j \circ \rho = \sum_i C_{ij} \, \phi_i

    for the eigenfunctions :math:`\phi_i` of the source, :math:`\psi_j` of the target and the point map :math:`\rho`
    from source to target. Both surfaces are scaled to unit area in their metrics, which may be any two: C is orthogonal
    where the map keeps area between them, and commutes with the eigenvalues where it is an isometry.

    Attributes
    ----------
    source, target : View
        The surfaces in their metrics, with at least as many eigenfunctions as the matrix has rows and columns.
    matrix : float64 array of shape (k, l)
        :math:`C`.

    References
    ----------
    Ovsjanikov, Ben-Chen, Solomon, Butscher, Guibas: Functional maps (2012).

    See Also
    --------
    functional_map : Makes one.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> found = gmds.functional_map(source, target, points=truth(source, target), count=10)
    >>> heights = found.pull_back(target.vertices[:, 2])
    >>> heights.shape
    (200,)
    """

    source: View
    target: View
    matrix: Floats

    def __repr__(self) -> str:
        k, j = self.matrix.shape
        return f"FunctionalMap({k} x {j}, {self.source.mesh!r} -> {self.target.mesh!r})"

    @classmethod
    def of_points(cls, source: View, target: View, points: SurfacePoints, count: int) -> FunctionalMap:
        """That of the map from every source vertex to a point of the target, projected on `count` eigenfunctions."""
        ours, theirs = source.functions[:, :count], target.functions[:, :count]
        matrix = (source.spectrum.mass[:, None] * ours).T @ points.interpolate(theirs)
        return cls(source, target, matrix)

    def pull_back(self, values: ArrayLike) -> Floats:
        """A function on the target as one on the source, of as many eigenfunctions as the matrix has.

        Parameters
        ----------
        values : array_like of shape (n_target,) or (n_target, c)
            One row for each target vertex.

        Returns
        -------
        array of shape (n,) or (n, c)
            One row for each source vertex.

        Raises
        ------
        MeshError
            E107 or E108 for values of another kind or shape.
        ValueError
            For values that are not finite.
        """
        v = real_numbers(values, "values")
        if v.ndim not in (1, 2) or len(v) != self.target.mesh.n_vertices:
            raise BadShape(f"values must have {self.target.mesh.n_vertices} rows, one for each target vertex")
        k, j = self.matrix.shape
        usable = self.target.usable
        if not np.isfinite(v[usable]).all():
            raise BadArgument("values must be finite: each function on the source is a mean over the whole target")
        coefficients = (self.target.functions[usable, :j] * self.target.spectrum.mass[usable, None]).T @ v[usable]
        return np.asarray(self.source.functions[:, :k] @ (self.matrix @ coefficients), dtype=np.float64)

    def points(self) -> SurfacePoints:
        """The point of the target, for each source vertex, where target functions are nearest to what is pulled back.

        Returns
        -------
        SurfacePoints
            n points, anywhere on the triangles.
        """
        k, j = self.matrix.shape
        return closest_points(self.target, self.target.functions[:, :j] @ self.matrix.T, self.source.functions[:, :k])

    def vertex_map(self) -> Integers:
        """The same among the vertices of the target, (n,)."""
        k, j = self.matrix.shape
        usable = self.target.usable
        rows = self.target.functions[usable, :j] @ self.matrix.T
        return usable[nearest_rows(self.source.functions[:, :k], rows)]

    def zoomed_out(self, count: int, *, sizes: Iterable[int] | None = None) -> FunctionalMap:
        """The map refined by ZoomOut: to points and back, with ever more eigenfunctions.

        Parameters
        ----------
        count : int
            Eigenfunctions in the end; both surfaces must have as many.
        sizes : iterable of int, optional
            On the way; in steps of a twentieth unless given.

        Returns
        -------
        FunctionalMap
            Of `count` x `count` entries.

        Raises
        ------
        ValueError
            When there are fewer eigenfunctions than `count` or any of `sizes`.

        References
        ----------
        Melzi, Ren, Rodola, Sharma, Wonka, Ovsjanikov: ZoomOut (2019).
        """
        most = min(self.source.functions.shape[1], self.target.functions.shape[1])
        count = whole_number(count, "count", 1, most, BOTH)
        begin = min(*self.matrix.shape, count)
        if sizes is None:
            steps = np.unique(np.geomspace(begin, count, 21).astype(int)).tolist()
        else:
            steps = [whole_number(size, "each of sizes", 1, most, BOTH) for size in sizes] or [count]
        images = upsampled(self.source, self.target, self.vertex_map(), steps)
        points = SurfacePoints.at_vertices(self.target.mesh, images)
        return FunctionalMap.of_points(self.source, self.target, points, count)


def points_for(source: View, target: View, points: Any) -> SurfacePoints:
    """The points of the target for all source vertices, which may be those of a correspondence, or vertices.

    Raises `MeshError` (E105 to E108) where they are not.
    """
    found = as_points(target.mesh, getattr(points, "points", points))
    if len(found) != source.mesh.n_vertices:
        raise BadShape(f"there must be {source.mesh.n_vertices} points, one for each source vertex, not {len(found)}")
    return found
