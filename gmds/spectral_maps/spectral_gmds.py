"""Spectral generalised multidimensional scaling: an orthogonal matrix that carries distances over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Distance, Spectrum, SurfacePoints, distance_matrix, eigenpairs, embedded, farthest_point_sampling
from geodesics.arguments import whole_number
from geodesics.arrays import Floats
from geodesics.distance import as_distance
from geodesics.errors import BadArgument
from geodesics.topology.components import vertex_components
from gmds.canonical_forms.spectral import squared_distances_in_eigenfunctions
from gmds.spectral_maps.representation import FunctionalMap, points_for
from gmds.surface.view import View

SAMPLES = 300  # of each surface, by which its distances are known; set by hand, as for `canonical_form`
FIRST = 20  # eigenfunctions in which a map of points is written first: with 6 or 12 some distances lose it; set by hand
STEPS = 100  # of the ascent with as many eigenfunctions, at the most; set by hand
STAY = 1e-9  # of the tangent, by which C stays where no distance has a say: a bound, far below what distances say
FLAT = 1e-9  # share of the objective by which a step has to raise it, or it is the last: rounding


@dataclass(frozen=True, eq=False)
class SpectralPlacement:
    """Where spectral GMDS placed a surface: `map` (a `FunctionalMap`), with the `points` (n,) of the target.

    `stress` is the root of the mean square of what is left of the squared distances, over that of the source's.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> import geodesics
    >>> distances = [geodesics.BiharmonicDistance(mesh) for mesh in (source, target)]
    >>> placed = gmds.spectral_gmds(*distances, truth(source, target), count=10, samples=40)
    >>> placed.map.matrix.shape
    (10, 10)
    """

    map: FunctionalMap
    points: SurfacePoints
    stress: float

    def __repr__(self) -> str:
        return f"SpectralPlacement({self.map!r}, stress {self.stress:.4g})"


def spectral_gmds(
    source_distance: Distance,
    target_distance: Distance,
    start: SurfacePoints | FunctionalMap | ArrayLike | Any,
    *,
    count: int = 40,
    samples: int = SAMPLES,
) -> SpectralPlacement:
    r"""Generalised multidimensional scaling in eigenfunctions: an orthogonal matrix instead of points (sec. 5).

    .. math:: \min_{C^T C = I} \| C^T \alpha_S C - \alpha_Q \|_F, \qquad
              d^2(x, y) = \sum_{ij} \alpha_{ij} \phi_i(x) \phi_j(y)

    All distances of a surface are k x k numbers. A step replaces C by the orthogonal matrix nearest to
    :math:`\alpha_S C \alpha_Q`, which never lowers :math:`\mathrm{tr}(C^T \alpha_S C \alpha_Q)`; steps alternate with
    going to points and back, as the number of eigenfunctions grows from that of the start.

    Parameters
    ----------
    source_distance, target_distance : Distance
        Distances of the two surfaces, geodesic in the original. Eigenfunctions are those of their spectra or metrics.
    start : SurfacePoints, FunctionalMap, Correspondence or array_like of int
        A rough map: a functional map of few eigenfunctions, or the point of the target for each source vertex.
    count : int
        Eigenfunctions in the end.
    samples : int
        Farthest points of each surface by which distances are known.

    Returns
    -------
    SpectralPlacement
        With a point for each source vertex. It improves a rough map in the metrics :math:`|K|^a g` with a from 0 to 1
        (`benchmarks/results/spectral_gmds.md`).

    Raises
    ------
    ValueError
        Where there are fewer eigenfunctions, or the start is one of other surfaces.
    MeshError
        E105 to E108 for a start that does not name a point of the target for each source vertex.

    References
    ----------
    Aflalo, Dubrovina, Kimmel: Spectral generalized multi-dimensional scaling (2016); sec. 5 of Aflalo, Kimmel, Raviv
    (2013).

    See Also
    --------
    solve : Places samples anywhere on the triangles.
    functional_map : From descriptors.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> import geodesics
    >>> distances = [geodesics.BiharmonicDistance(mesh) for mesh in (source, target)]
    >>> placed = gmds.spectral_gmds(*distances, truth(source, target), count=10, samples=40)
    >>> len(placed.points)
    200
    """
    distances = as_distance(source_distance), as_distance(target_distance)
    count, samples = whole_number(count, "count", 2), whole_number(samples, "samples", 2)
    ours, theirs = (View.of(_spectrum(each, count)) for each in distances)
    have = min(ours.functions.shape[1], theirs.functions.shape[1])
    count = whole_number(count, "count", 2, have, "the eigenfunctions that both surfaces have")
    ours, theirs = ours.first(count), theirs.first(count)
    first, second = _squared(distances[0], ours, samples), _squared(distances[1], theirs, samples)
    unit = np.sqrt((first**2).sum())
    constant = float(np.sign(ours.functions[ours.usable[0], 0] * theirs.functions[theirs.usable[0], 0]))
    now = FunctionalMap(ours, theirs, _start(ours, theirs, start))
    for size in _sizes(min(*now.matrix.shape), count):
        matrix = np.zeros((size, size))
        k = min(size, *now.matrix.shape)
        matrix[:k, :k] = now.matrix[:k, :k]
        improved = carried_over(first[:size, :size], second[:size, :size], matrix, constant)
        points = FunctionalMap(ours, theirs, improved).points()
        now = FunctionalMap.of_points(ours, theirs, points, min(count, 2 * size))
    matrix = carried_over(first, second, now.matrix, constant)
    left = matrix.T @ first @ matrix - second
    final = FunctionalMap(ours, theirs, matrix)
    return SpectralPlacement(final, final.points(), float(np.sqrt((left**2).sum()) / unit))


def carried_over(first: Floats, second: Floats, start: Floats, constant: float = 1.0) -> Floats:
    """The orthogonal matrix C, reached from `start`, for which tr(C^T first C second) rises no more.

    The constant function stays what it is, times `constant`, 1 or -1: eigenfunctions have their signs by chance. The
    rest of squared distances is negative where they are those of points in a Euclidean space, and nearly so else: its
    negative, shifted by the little that is missing, makes the trace convex, so that the orthogonal matrix that its
    tangent likes best raises it.
    """
    inner = [_positive(-alpha[1:, 1:]) for alpha in (first, second)]
    linear = constant * np.outer(first[1:, 0], second[0, 1:])
    turn, value = _nearest_orthogonal(start[1:, 1:]), -np.inf
    for _ in range(STEPS):
        image = inner[0] @ turn @ inner[1]
        reached = float((turn * (image + 2 * linear)).sum())
        if reached - value <= FLAT * abs(reached):
            break
        tangent = image + linear
        turn, value = _nearest_orthogonal(tangent + STAY * np.linalg.norm(tangent) * turn), reached
    matrix = np.zeros_like(first)
    matrix[0, 0], matrix[1:, 1:] = constant, turn
    return matrix


def _positive(matrix: Floats) -> Floats:
    """The matrix plus as much of the identity as makes its eigenvalues non-negative."""
    return np.asarray(matrix + max(0.0, -np.linalg.eigvalsh(matrix)[0]) * np.eye(len(matrix)), dtype=np.float64)


def _nearest_orthogonal(matrix: Floats) -> Floats:
    u, _, vt = np.linalg.svd(matrix)
    return np.asarray(u @ vt, dtype=np.float64)


def _sizes(begin: int, end: int) -> list[int]:
    """Numbers of eigenfunctions on the way, each a fifth more."""
    steps = 1 + max(1, int(np.log(end / begin) / np.log(1.2)))
    return [int(k) for k in np.unique(np.append(np.geomspace(begin, end, steps), end).astype(int))]


def _squared(distance: Distance, view: View, samples: int) -> Floats:
    """The squared distances of a surface in its eigenfunctions (k, k), over their mean."""
    if len(np.unique(vertex_components(view.mesh)[view.usable])) > 1:
        raise BadArgument(f"{view.mesh!r} has several components, and no distances between them; take one of each")
    chosen = farthest_point_sampling(distance, min(samples, len(view.usable)))
    found = squared_distances_in_eigenfunctions(view.spectrum, chosen, distance_matrix(distance, chosen))
    return np.asarray(found / (found[0, 0] * view.functions[view.usable[0], 0] ** 2), dtype=np.float64)


def _spectrum(distance: Distance, count: int) -> Spectrum:
    """That of the distance if it is rich enough, else of its metric, else of the metric of space."""
    spectrum = getattr(distance, "spectrum", None)
    if isinstance(spectrum, Spectrum) and len(spectrum.eigenvalues) >= count:
        return spectrum
    return eigenpairs(getattr(distance, "metric", None) or embedded(distance.mesh), count)


def _start(source: View, target: View, start: Any) -> Floats:
    """The matrix to begin with, of two functions at least: a constant alone says nothing."""
    if not isinstance(start, FunctionalMap):
        return FunctionalMap.of_points(source, target, points_for(source, target, start), FIRST).matrix
    for given, view, name in ((start.source, source, "source"), (start.target, target, "target")):
        if given.mesh is not view.mesh and given.mesh.n_vertices != view.mesh.n_vertices:
            raise BadArgument(f"the {name} of start is {given.mesh!r}, and not {view.mesh!r}")
    if min(start.matrix.shape) < 2:
        raise BadArgument("start must be a map of two eigenfunctions or more: a constant one alone says nothing")
    return start.matrix
