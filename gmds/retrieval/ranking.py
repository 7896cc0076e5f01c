"""The order of a collection by likeness to a shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from gmds.retrieval.bags import learned
from gmds.retrieval.descriptors import DEFAULT, signatures_of


@dataclass(frozen=True, eq=False)
class Ranking:
    """Members of a collection, the most alike first: their numbers `order` (n,) and their `distances` (n,).

    Distances are from 0 to 2: twice the share of the surface that says different words.
    """

    order: Integers
    distances: Floats


def retrieve(query: Mesh, collection: Sequence[Mesh], features: Callable[[Mesh], ArrayLike] | None = None) -> Ranking:
    """A collection ranked by likeness to a query, whatever the poses and the sizes of parts (Table 1).

    Parameters
    ----------
    query : Mesh
        What is looked for.
    collection : sequence of n meshes
        Where it is looked for.
    features : function Mesh -> array, optional
        Makes a vector of a mesh; by default a `BagOfFeatures` whose words come from the query and the collection.

    Returns
    -------
    Ranking
        `order` (n,), the numbers of the collection, the most alike first and equals as they were; `distances` (n,), the
        L1 distances of the vectors.

    Raises
    ------
    MeshError
        For a mesh that cannot be measured.
    EigensolverFailed
        E402.

    Notes
    -----
    Meshes are to be of similar resolution, as signatures depend on it. In a collection of shapes that are much alike,
    one of them with 5,000 vertices in place of 1,000 is 0.3 from all of them.

    See Also
    --------
    BagOfFeatures : To learn words once and use them for many queries.

    References
    ----------
    Table 1; A. M. Bronstein, M. M. Bronstein, L. J. Guibas and M. Ovsjanikov, "Shape Google", ACM Trans. Graph. 30
    (2011).

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import humanoid, quadruped
    >>> collection = [humanoid(n_vertices=200), quadruped('walk', n_vertices=200)]
    >>> gmds.retrieve(quadruped(n_vertices=200), collection).order.tolist()
    [1, 0]
    """
    meshes = [query, *collection]
    if features is not None:
        vectors = [np.asarray(features(mesh), dtype=np.float64) for mesh in meshes]
    else:
        parts = [signatures_of(mesh, DEFAULT) for mesh in meshes]
        bags = learned(DEFAULT, parts)
        vectors = [bags.of(each) for each in parts]
    return ranking(vectors[0], vectors[1:])


def ranking(query: Floats, collection: Sequence[Floats]) -> Ranking:
    """Vectors of a collection ranked by their L1 distance to that of the query."""
    distances = bag_distances([query], collection)[0]
    order = np.argsort(distances, kind="stable")
    return Ranking(order, distances[order])


def bag_distances(first: Sequence[Floats], second: Sequence[Floats]) -> Floats:
    """|f - g|_1 for bags f of the first and g of the second list: (len(first), len(second))."""
    if len(first) == 0 or len(second) == 0:
        return np.zeros((len(first), len(second)))
    return np.array([np.abs(np.asarray(second) - f).sum(axis=1) for f in first])
