r"""How confident one can be of a map: a logistic model of its signs, fitted to maps of which the truth is known.

.. math:: \log \frac{p}{1 - p} = c + \sum_k w_k \min(\max(x_k, l_k), u_k)

with the signs :math:`x_k` of `gmds.matching.signs`, held within the range [l, u] that they had where it was fitted:
`python -m benchmarks.trust.fit` does that, and writes `gmds.matching.weights`. Maps of distances that were given, which
nothing registers, have a model of their own (`python -m benchmarks.trust.plain`, `gmds.matching.plain_weights`). Where
maps that are nearly as likely lead elsewhere, p is multiplied by the probability of `gmds.matching.rivals`.
"""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Bools, Floats
from gmds.maps.point_map import MatchStatus
from gmds.matching.candidates import MapCandidate
from gmds.matching.plain_weights import PLAIN_CONSTANT, PLAIN_WEIGHTS
from gmds.matching.rivals import Rivals
from gmds.matching.signs import signs_of
from gmds.matching.weights import CONSTANT, WEIGHTS

# A map is POOR when fewer of its points than this are expected to be right; or than the second, where by distances,
# curvature or lengths it looks wrong: a right map of a skull full of folds does.
AS_LIKELY_AS_NOT = 0.5
SURE = 0.75  # set by hand
# Difference of log-likelihood below which another map may be the right one: it was 0.06 to 0.65 where the map was wrong
# and, with two exceptions, 0.79 to 6.2 where it was right (benchmarks/results/notes.md, "Trust").
AMBIGUOUS_MARGIN = 0.7


def confidence_of(candidate: MapCandidate, rivals: Rivals) -> Floats:
    """The confidence (n,) of a candidate at the vertices of the source, less where `rivals` dispute it.

    It is 0 at vertices of no area, and where a sign is no number, so that nothing can be said.
    """
    signs = signs_of(candidate, rivals)
    constant, weights = (PLAIN_CONSTANT, PLAIN_WEIGHTS) if candidate.is_plain else (CONSTANT, WEIGHTS)
    odds = np.full(candidate.pair.source.mesh.n_vertices, constant)
    for name, (weight, low, high) in weights.items():
        odds += weight * np.clip(signs[name], low, high)
    result = rivals.undisputed / (1 + np.exp(-odds))
    result[(candidate.pair.full[0].areas <= 0) | np.isnan(result)] = 0.0
    return np.asarray(result, dtype=np.float64)


def expected_share(confidence: Floats, areas: Floats, valid: Bools) -> float:
    """The share of the `valid` area that is expected within 0.05 root areas of the truth; 0 where nothing is valid."""
    weights = np.where(valid, areas, 0.0)
    return float(confidence @ weights / weights.sum()) if weights.sum() > 0 else 0.0


def status_of(expected: float, margin: float, *, badly_kept: bool) -> MatchStatus:
    """POOR where few points are expected to be right, AMBIGUOUS where another map is nearly as likely, else GOOD.

    `expected` is the `expected_share`; `badly_kept`: whether distances, curvature or lengths are kept so badly that it
    takes more than that to be believed; `margin`: how much likelier the map is than any other.
    """
    if expected < (SURE if badly_kept else AS_LIKELY_AS_NOT):
        return MatchStatus.POOR
    return MatchStatus.AMBIGUOUS if margin < AMBIGUOUS_MARGIN else MatchStatus.GOOD
