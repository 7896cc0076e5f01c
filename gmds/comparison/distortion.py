"""How far apart two shapes are: the distortion of the best embedding of one in the other (sec. 5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.threads import on_one_blas_thread
from gmds import initialization
from gmds.comparison.profiles import equal_area_samples, normalised_distances, views
from gmds.initialization.shortlist import shortlist
from gmds.spectral.sample_maps import SampledPair
from gmds.surface.view import View

# chosen on the classes CHOSEN_ON of examples/paper/dissimilarity.py
STARTS_PER_METRIC = 8  # embeddings that each metric proposes
IMPROVED_STARTS = 3  # how many of all embeddings are improved in each metric
SWEEPS = 6  # a bound: 70 of 72 descents between four shapes of TOSCA and FAUST stop sooner


@on_one_blas_thread
def dissimilarity(a: Mesh, b: Mesh) -> float:
    r"""How far apart two shapes are, whatever their poses and sizes and, within limits, the sizes of their parts.

    The "morphometric similarity" of the abstract: the mean distortion

    .. math:: |d_S(s, s') - d_Q(\rho(s), \rho(s'))|

    of distances, over the mean distance, by the best map :math:`\rho` found of one surface into the other (sec. 5) or
    by the best one found back, whichever distorts more, as a surface may embed well in another that has more to it.
    Metrics and distances are those of `distance_profile`. Symmetric, and 0 up to rounding for congruent shapes, moved,
    resized or mirrored.

    Parameters
    ----------
    a, b : Mesh
        The shapes; of several components the largest.

    Returns
    -------
    float
        The dissimilarity, >= 0, in units of the mean distance. It takes seconds.

    Raises
    ------
    TooFewVertices
        E113.
    MeshError
        Where a mesh cannot be measured.

    See Also
    --------
    least_distortion : A bound in a millisecond, without a map.

    References
    ----------
    Abstract, sec. 5 and (2.1); both ways as in the modified Gromov-Hausdorff distance of F. Memoli, Discrete Comput.
    Geom. 48 (2012).

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> bool(gmds.dissimilarity(source, target) < 0.1)  # another pose of one animal
    True
    """
    return embedding_distortion(views(Mesh.from_object(a)), views(Mesh.from_object(b)))


def embedding_distortion(ours: Sequence[View], theirs: Sequence[View]) -> float:
    """The distortion of the best embeddings found of two surfaces in each other, given their `views` (sec. 5).

    In each metric that of the way round that distorts more, each way by its own map: the modified Gromov-Hausdorff
    distance (Memoli, Discrete Comput. Geom. 48, 2012) with means in place of maxima. Then the mean over the metrics.
    """
    both_ways = zip(_one_way(ours, theirs), _one_way(theirs, ours), strict=True)
    return float(np.mean([max(pair) for pair in both_ways]))


def _one_way(source: Sequence[View], target: Sequence[View]) -> list[float]:
    """In each metric the least distortion of the maps found from source to target, in whichever metric they started."""
    pairs = [SampledPair.of(*both, sense=0) for both in zip(source, target, strict=True)]
    found = [(pair, images) for pair in pairs for images in shortlist(pair, initialization.ALL, STARTS_PER_METRIC)]
    return [_embedded(pair, found) for pair in pairs]


def _embedded(pair: SampledPair, found: Sequence[tuple[SampledPair, Integers]]) -> float:
    """The least distortion to which the maps found descend in the metric of `pair`."""
    here = equal_area_samples(pair.source)
    there = np.union1d(pair.target_samples, equal_area_samples(pair.target))
    ours, theirs = normalised_distances(pair.source, here), normalised_distances(pair.target, there)
    starts = [np.searchsorted(there, other.extended(images, here, there)) for other, images in found]
    first = [np.abs(ours - theirs[np.ix_(start, start)]).mean() for start in starts]
    return min(descended(ours, theirs, starts[i]) for i in np.argsort(first, kind="stable")[:IMPROVED_STARTS])


def descended(ours: Floats, theirs: Floats, images: Integers) -> float:
    """The mean |d_S(x, x') - d_Q(y, y')| after each point in turn went where it is least, the others staying.

    `ours` (p, p) and `theirs` (q, q) are distances, `images` (p,) says among the q where the p points start. Sweeps
    repeat until they gain less than a hundredth: discrete generalised multidimensional scaling in the mean absolute
    stress, which outliers sway less than the mean square.
    """
    places = images.copy()
    to_places = theirs[:, places]
    least = float(np.abs(ours - to_places[places]).mean())
    for _ in range(SWEEPS):
        for x, known in enumerate(ours):
            cost = np.abs(to_places - known)
            cost[:, x] = 0  # the distance from x to itself is 0 wherever it goes
            places[x] = cost.sum(axis=1).argmin()
            to_places[:, x] = theirs[:, places[x]]
        before, least = least, float(np.abs(ours - to_places[places]).mean())
        if least > 0.99 * before:
            break
    return least
