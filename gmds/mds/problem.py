"""What is asked: place the samples of one surface on another so that distances agree."""

from __future__ import annotations

import copy
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Distance, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import cached_property
from geodesics.distance import as_distance, as_points
from geodesics.errors import BadArgument
from geodesics.tracing import barycentric_gradient
from gmds.mds.chosen_pairs import Weights, chosen_pairs, pair_weights, tabulated
from gmds.mds.jacobian import Jacobian, scaled
from gmds.mds.pair_distances import Pairs, lengths_between, pairwise

PER_PAIR = {"first", "second", "source_distances", "root_weights"}  # of a problem: arrays with one entry a pair


@dataclass(frozen=True, eq=False, init=False)
class Problem:
    r"""Generalised multidimensional scaling: find rho with d_Q(rho_i, rho_j) close to d_S(s_i, s_j) (sec. 5).

    .. math:: r_{ij} = \sqrt{w_{ij}} \, \frac{d_S(s_i, s_j) - d_Q(\rho_i, \rho_j)}{\bar d_S}, \qquad i < j

    are the residuals, without unit: :math:`\bar d_S` is the mean of :math:`d_S` over the pairs, so a residual of 0.05
    is a twentieth of the mean distance. Pairs of samples that cannot reach each other are left out.

    Parameters
    ----------
    source_distance, target_distance : Distance
        Distances of the two surfaces.
    source_points : SurfacePoints or array_like of int
        The p samples of the source, or vertices.
    weights : array_like of shape (p,) or (p, p), or callable, optional
        Of the samples (:math:`w_{ij} = w_i w_j`), of the pairs, or a function that makes them (r,) of the source
        distances (r,) of the pairs; they are scaled to mean 1.
    pairs : array_like of shape (r, 2), or int, optional
        The pairs of samples that are asked for, all of them unless given. A number h: those that one of the first h
        samples belongs to; memory then grows with the number of samples, not with its square.

    Raises
    ------
    ValueError
        When shapes disagree, no two samples can reach each other, or a weight is negative.
    WouldExceedMemory
        When all pairs do not fit, or fields of a distance without coordinates (E501).

    See Also
    --------
    solve : Places the samples.
    TabulatedDistance : Makes geodesic distances quick.

    Examples
    --------
    >>> import geodesics, gmds
    >>> from gmds.shapes import quadruped
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> ours, theirs = (geodesics.BiharmonicDistance(mesh) for mesh in (source, target))
    >>> samples = geodesics.SurfacePoints.at_vertices(source, geodesics.farthest_point_sampling(ours, 10))
    >>> problem = gmds.Problem(ours, samples, theirs)
    >>> start = geodesics.SurfacePoints.closest(target, samples.positions)
    >>> problem
    Problem(10 samples, 45 pairs, into BiharmonicDistance(99 coordinates on Mesh(200 vertices, 396 faces)))
    """

    source_points: SurfacePoints
    target_distance: Distance
    first: Integers
    second: Integers
    source_distances: Floats
    root_weights: Floats
    unit: float

    def __init__(
        self,
        source_distance: Distance,
        source_points: SurfacePoints | ArrayLike,
        target_distance: Distance,
        weights: Weights = None,
        pairs: ArrayLike | int | None = None,
    ) -> None:
        source_distance, target_distance = as_distance(source_distance), as_distance(target_distance)
        source_points = as_points(source_distance.mesh, source_points)
        count = len(source_points)
        first, second = chosen_pairs(pairs, count)
        lengths = lengths_between(source_distance, source_points, first, second)
        reached = np.isfinite(lengths)
        if not (lengths[reached] > 0).any():
            raise BadArgument("a problem needs at least two samples at a positive, finite distance from each other")
        first, second, lengths = first[reached], second[reached], lengths[reached]
        root_weights = np.sqrt(pair_weights(weights, first, second, lengths, count))
        values = (source_points, target_distance, first, second, lengths, root_weights, float(lengths.mean()))
        for column, value in zip(fields(self), values, strict=True):
            object.__setattr__(self, column.name, value)

    def __len__(self) -> int:
        """Number of samples p."""
        return len(self.source_points)

    def __repr__(self) -> str:
        return f"Problem({len(self)} samples, {len(self.first)} pairs, into {self.target_distance!r})"

    def towards(self, target_distance: Distance) -> Problem:
        """The same samples and source distances, placed by another distance of the target."""
        other = copy.copy(self)
        object.__setattr__(other, "target_distance", target_distance)
        return other

    def head(self, count: int) -> Problem:
        """The problem of the first `count` samples alone; `unit` stays."""
        return self._with_pairs(self.source_points[:count], (self.second < count) & (self.first < count))

    def anchored(self, count: int) -> Problem:
        """The problem of the pairs that one of the first `count` samples belongs to; `unit` stays."""
        return self._with_pairs(self.source_points, self.first < count)  # of two, the first is the smaller

    def _with_pairs(self, points: SurfacePoints, kept: Bools) -> Problem:
        """The problem of some samples and some pairs (r,)."""
        other, names = object.__new__(Problem), [column.name for column in fields(self)]
        for name in names:
            value = getattr(self, name)
            object.__setattr__(other, name, value[kept] if name in PER_PAIR else value)
        object.__setattr__(other, "source_points", points)
        return other

    def at(self, points: SurfacePoints | ArrayLike) -> Placement:
        """The problem seen from target points (p,), or vertices, with residuals and their derivative."""
        points = as_points(self.target_distance.mesh, points)
        if len(points) != len(self):
            raise BadArgument(f"{len(self)} samples need {len(self)} target points, not {len(points)}")
        if points.mesh is not self.target_distance.mesh:
            raise BadArgument("the points lie on another mesh than the target distance measures")
        own = getattr(self.target_distance, "pairs", None)  # of a distance that measures pairs itself
        return Placement(self, points, pairwise(self.target_distance, points) if own is None else own(points))

    @cached_property
    def total_weights(self) -> Floats:
        """The sum of the weights of the pairs of each sample, (p,)."""
        square = self.root_weights**2
        ends = np.concatenate([self.first, self.second])
        return np.bincount(ends, np.concatenate([square, square]), len(self)).astype(np.float64)

    def distance_table(self, heads: int | None = None) -> Floats:
        """Source distances (p, h) to the first h samples of the pairs that are asked for, else NaN; None: to all."""
        return tabulated(
            self.source_distances, self.first, self.second, np.full((len(self), heads or len(self)), np.nan)
        )

    def weight_table(self, heads: int | None = None) -> Floats:
        """Weights (p, h) of these pairs, 0 elsewhere."""
        return tabulated(self.root_weights**2, self.first, self.second, np.zeros((len(self), heads or len(self))))

    def compare(self, lengths: Floats) -> Floats:
        """Residuals (r,) of target distances (r,); a pair out of reach counts as three mean distances apart."""
        reached = np.where(np.isposinf(lengths), 3 * self.unit, lengths)
        return self.root_weights * (self.source_distances - reached) / self.unit


@dataclass(frozen=True, eq=False)
class Placement:
    """The samples of a problem placed at `points` (p,) of the target."""

    problem: Problem
    points: SurfacePoints
    pairs: Pairs

    @cached_property
    def lengths(self) -> Floats:
        """Distances of the pairs that are asked for, (r,)."""
        return self.pairs.lengths(self.problem.first, self.problem.second)

    @cached_property
    def residuals(self) -> Floats:
        """r_ij (r,), without dimension."""
        return self.problem.compare(self.lengths)

    @cached_property
    def shares(self) -> Floats:
        """The sum of the squared residuals of each sample, (p,)."""
        problem, square = self.problem, self.residuals**2
        share = [np.bincount(side, square, len(problem)) for side in (problem.first, problem.second)]
        return np.add(*share).astype(np.float64)

    @property
    def derivatives(self) -> Floats:
        """Of the residuals by the in-face displacement of their two points, (r, 2, 2)."""
        first, second, lengths = self.problem.first, self.problem.second, self.lengths
        scale = -np.where(np.isfinite(lengths), self.problem.root_weights, 0.0) / self.problem.unit
        return self.pairs.slopes(first, second, lengths, scale)

    @property
    def jacobian(self) -> Jacobian:
        """The derivative in steps measured in distances; not kept, as it is most of what a descent holds."""
        problem = self.problem
        weight = np.maximum(problem.total_weights, np.finfo(float).tiny)
        return scaled(problem.first, problem.second, self.derivatives, len(problem), weight)

    @property
    def walled_jacobian(self) -> Jacobian:
        """The same with walls: no weight of a point may fall below zero, so that no point leaves its face."""
        jacobian = self.jacobian
        slope = np.einsum("pkx,pxy->pky", barycentric_gradient(self.points), jacobian.frames)
        return replace(jacobian, walls=(self.points.barycentric, slope))
