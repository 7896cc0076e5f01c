"""The logistic model of confidence, fitted and measured: weights, calibration, and the area under the ROC."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize
from scipy.special import expit, logit
from scipy.stats import rankdata

from geodesics.arrays import Bools, Floats
from gmds.matching.weights import Weight

RIDGE = 0.01  # of the squared weights of standardised signs, against the mean loss; chosen on the development half
HELD = (0.5, 99.5)  # percentiles of a sign at which it is held
BINS = 10  # of the calibration error, as usual


class Model(NamedTuple):
    """`rating.CONSTANT` and `rating.WEIGHTS`, in the order of the signs."""

    constant: float
    weights: list[Weight]

    def confidence(self, signs: Floats) -> Floats:
        """(p,) of signs (p, k)."""
        low, high = (np.array([getattr(one, bound) for one in self.weights]) for bound in ("low", "high"))
        return np.asarray(expit(self.constant + np.clip(signs, low, high) @ [one.weight for one in self.weights]))


def fitted(signs: Floats, near: Bools, counts: Floats) -> Model:
    """The model of signs (p, k) and of whether points are `near` the truth, of which each `counts` so much."""
    counts = counts / counts.sum()
    low, high = np.percentile(signs, HELD, axis=0)
    held = np.clip(signs, low, high)
    centre = counts @ held
    spread = np.sqrt(counts @ (held - centre) ** 2) + 1e-9
    rows, signed = np.column_stack([np.ones(len(held)), (held - centre) / spread]), np.where(near, 1.0, -1.0)

    def loss(w: Floats) -> tuple[float, Floats]:
        margin = signed * (rows @ w)
        slope = -counts * signed * expit(-margin)
        decay = np.r_[0.0, w[1:]] * RIDGE
        return float(counts @ np.logaddexp(0, -margin) + decay @ w / 2), rows.T @ slope + decay

    w = minimize(loss, np.zeros(rows.shape[1]), jac=True, method="L-BFGS-B", options={"maxiter": 2000}).x
    weights = w[1:] / spread
    return Model(
        float(w[0] - weights @ centre), [Weight(*map(float, one)) for one in zip(weights, low, high, strict=True)]
    )


def shift(confidence: Floats, near: Bools, counts: Floats) -> float:
    """The a of `gmds.maps.confidence` at which points are `near` as often as the confidence with it says."""
    odds, share = logit(np.clip(confidence, 1e-6, 1 - 1e-6)), np.average(near, weights=counts)
    return float(brentq(lambda a: np.average(expit(odds + a), weights=counts) - share, -12, 12))


def calibration_error(confidence: Floats, near: Bools, counts: Floats) -> float:
    """Expected calibration error: mean over points of |mean confidence - share that is near| of their bin."""
    bins = np.minimum((confidence * BINS).astype(int), BINS - 1)
    total, sums = (np.bincount(bins, values, BINS) for values in (counts, counts * (confidence - near)))
    return float(np.abs(sums).sum() / total.sum())


def reliability(confidence: Floats, near: Bools, counts: Floats) -> list[tuple[float, float, float]]:
    """Of each bin: mean confidence, share that is near, share of all points."""
    bins = np.minimum((confidence * BINS).astype(int), BINS - 1)
    rows = [(counts[bins == k], confidence[bins == k], near[bins == k]) for k in range(BINS)]
    return [
        (float(np.average(p, weights=c)), float(np.average(y, weights=c)), float(c.sum() / counts.sum()))
        for c, p, y in rows
        if len(c)
    ]


def ranked(confidence: Floats, far: Bools) -> float:
    """Area under the ROC: how often what is `far` off has less confidence than what is not; NaN for none."""
    n = int(far.sum())
    if n in (0, len(far)):
        return float("nan")
    ranks = rankdata(-confidence)
    return float((ranks[far].sum() - n * (n + 1) / 2) / (n * (len(far) - n)))
