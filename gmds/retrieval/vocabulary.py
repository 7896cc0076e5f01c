"""Geometric words: what is common among the descriptors of many surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import BadArgument


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """Words (w, k) in units of the spread, the mean (k,) and spread (k,) of descriptors, and the softness.

    Softness 0 gives every point to its nearest word alone (equally, where several are as near).
    """

    words: Floats
    mean: Floats
    spread: Floats
    softness: float

    def assign(self, descriptors: Floats) -> Floats:
        """Soft vector quantisation theta_i(x) ~ exp(-|p(x) - w_i|^2 / (2 softness^2)), rows sum to 1: (n, words).

        For Table 1, as in Bronstein, Bronstein, Guibas, Ovsjanikov 2011 (ShapeGoogle).
        """
        squared = _squared_distances((descriptors - self.mean) / self.spread, self.words)
        beyond = squared - squared.min(axis=1, keepdims=True)
        with np.errstate(under="ignore"):
            weight = np.exp(-beyond / (2 * self.softness**2)) if self.softness > 0 else (beyond == 0).astype(float)
        return weight / weight.sum(axis=1, keepdims=True)


def learn_vocabulary(
    samples: Sequence[tuple[Floats, Floats]],
    n_words: int = 48,
    *,
    softness: float = 1.0,
    per_surface: int = 300,
    rng: int = 0,
) -> Vocabulary:
    """Words by k-means from (descriptors (n, k), weights (n,)) of some surfaces, the same for the same seed.

    From each surface `per_surface` vertices are drawn, with probability proportional to their weight, so that the
    words do not depend on where vertices are dense. `softness` is in units of the median distance from a word to its
    nearest other word. Raises ValueError without samples, or for n_words < 1 or softness < 0.
    """
    if not samples or n_words < 1 or not softness >= 0:
        raise BadArgument("a vocabulary needs descriptors of a surface, n_words >= 1 and softness >= 0")
    random = np.random.default_rng(rng)
    drawn = np.concatenate(
        [values[random.choice(len(values), per_surface, p=weight / weight.sum())] for values, weight in samples]
    )
    mean, spread = drawn.mean(axis=0), drawn.std(axis=0)
    spread = np.where(spread > 1e-9 * (1 + np.abs(mean)), spread, 1.0)  # what is the same everywhere says nothing
    words = k_means((drawn - mean) / spread, n_words, random)
    return Vocabulary(words, mean, spread, softness * _spacing(words))


def k_means(points: Floats, count: int, random: np.random.Generator, iterations: int = 50) -> Floats:
    """Up to `count` centres (c, k) of clusters of points (n, k): Lloyd's iteration from a k-means++ start.

    Each start is a point drawn with probability proportional to its squared distance from those before. There are
    fewer centres where there are fewer different points. A centre that no point is nearest to stays where it is.
    """
    centres = points[[random.integers(len(points))]]
    nearest = _squared_distances(points, centres)[:, 0]
    while len(centres) < count and nearest.max() > 1e-18 * max(1.0, float((points**2).max())):
        new = points[[random.choice(len(points), p=nearest / nearest.sum())]]
        centres = np.vstack([centres, new])
        nearest = np.minimum(nearest, _squared_distances(points, new)[:, 0])
    for _ in range(iterations):
        label = _squared_distances(points, centres).argmin(axis=1)
        size = np.bincount(label, minlength=len(centres))
        total = np.zeros_like(centres)
        np.add.at(total, label, points)
        moved = np.where(size[:, None] > 0, total / np.maximum(size, 1)[:, None], centres)
        if np.array_equal(moved, centres):
            break
        centres = moved
    return centres


def _squared_distances(points: Floats, centres: Floats) -> Floats:
    """|p - c|^2 of points (n, k) and centres (c, k): (n, c)."""
    squared = (points**2).sum(axis=1)[:, None] - 2 * points @ centres.T + (centres**2).sum(axis=1)
    return np.maximum(squared, 0)


def _spacing(words: Floats) -> float:
    """The median distance from a word to its nearest other word; 1 where there is one word."""
    if len(words) == 1:
        return 1.0
    squared = _squared_distances(words, words)
    np.fill_diagonal(squared, np.inf)
    return float(np.median(np.sqrt(squared.min(axis=1))))
