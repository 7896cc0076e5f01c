"""A collection of shapes by their dissimilarities: a tree, and a map of it in the plane."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import scipy.cluster.hierarchy as hierarchy
from numpy.typing import ArrayLike
from scipy.spatial.distance import squareform

from geodesics.arrays import Floats, Integers
from gmds.canonical_forms.classical import classical_scaling


def tree(matrix: ArrayLike) -> Floats:
    """The dendrogram of a symmetric matrix (k, k) of dissimilarities, as SciPy's linkage (k - 1, 4), average linkage.

    Row i joins clusters [0] and [1] at height [2] into cluster k + i of [3] shapes; each joins the closest two, by the
    mean dissimilarity of their shapes. No rows for fewer than two shapes.
    """
    values = np.asarray(matrix, dtype=np.float64)
    if len(values) < 2:
        return np.zeros((0, 4))
    condensed = squareform(values, checks=False)
    return np.asarray(hierarchy.optimal_leaf_ordering(hierarchy.average(condensed), condensed))


def leaf_order(linkage: Floats) -> Integers:
    """The shapes in the order of the leaves of a tree, so that alike ones are neighbours."""
    return np.asarray(hierarchy.leaves_list(linkage) if len(linkage) else [0], dtype=np.int64)


def plane_map(matrix: ArrayLike, dimensions: int = 2) -> Floats:
    """A point (k, dimensions) for each shape, so that distances in the plane come near the dissimilarities (k, k).

    By classical multidimensional scaling (`gmds.canonical_forms.classical_scaling`); one shape alone is at the origin.
    """
    if len(np.asarray(matrix)) < 2:
        return np.zeros((len(np.asarray(matrix)), dimensions))
    return classical_scaling(matrix, dimensions)


def nearest(matrix: ArrayLike, count: int = 1) -> Integers:
    """For each shape the `count` others least dissimilar to it, closest first: (k, count)."""
    values = np.array(matrix, dtype=np.float64)
    np.fill_diagonal(values, np.inf)
    return np.argsort(values, axis=1, kind="stable")[:, :count]


def families(names: Sequence[str]) -> list[str]:
    """What the names of the shapes say of what they are: the name without the digits at its end."""
    return [re.sub(r"[\W_]*\d+$", "", name) or name for name in names]


def neighbour_accuracy(matrix: ArrayLike, labels: Sequence[str]) -> float | None:
    """The share of shapes whose nearest other shape has the same label (leave one out); None where no label repeats.

    Shapes that are alone with their label cannot be right, and do not count.
    """
    label = np.asarray(labels)
    asked = np.array([np.count_nonzero(label == one) > 1 for one in label], dtype=bool)
    if not asked.any():
        return None
    return float((label[nearest(matrix)[:, 0]] == label)[asked].mean())
