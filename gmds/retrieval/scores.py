"""How good a ranking is, from distances between shapes and their class names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Bools
from geodesics.errors import BadArgument


@dataclass(frozen=True)
class RetrievalScores:
    """Percentages over the queries: `nearest_neighbour` of the same class; `first_tier`, the share of the class among
    as many first results as the class has members; `mean_average_precision`. `queries`: how many could be judged.
    """

    nearest_neighbour: float
    first_tier: float
    mean_average_precision: float
    queries: int


def retrieval_scores(
    distances: ArrayLike, query_labels: Sequence[str], labels: Sequence[str], *, leave_out_self: bool = False
) -> RetrievalScores:
    """Scores of distances (q, n) from queries to a collection; of equals, the first in the collection comes first.

    With `leave_out_self`, query i is member i of the collection and not among its own results. Queries of a class
    without (other) members are not counted. Raises ValueError when there are no others.
    """
    d = np.array(distances, dtype=np.float64)
    judged = []
    for i, label in enumerate(query_labels):
        order = np.argsort(d[i], kind="stable")
        order = order[order != i] if leave_out_self else order
        relevant = np.array([labels[j] == label for j in order])
        if relevant.any():
            judged.append(_judge(relevant))
    if not judged:
        raise BadArgument("no query has a shape of its class in the collection")
    nearest, tier, precision = 100 * np.mean(judged, axis=0)
    return RetrievalScores(float(nearest), float(tier), float(precision), len(judged))


def _judge(relevant: Bools) -> tuple[float, float, float]:
    """Nearest neighbour, first tier and average precision of one ranking, each from 0 to 1."""
    found = np.flatnonzero(relevant)
    precision = np.arange(1, len(found) + 1) / (found + 1)
    return float(relevant[0]), float(relevant[: len(found)].mean()), float(precision.mean())
