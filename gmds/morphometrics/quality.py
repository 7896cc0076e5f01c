"""How good a shape model is: compactness, generalisation and specificity (Davies, Twining, Taylor 2008)."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.morphometrics.components import principal_components
from gmds.morphometrics.shape_model import ShapeModel

DRAWN = 200  # random shapes for the specificity; set by hand


def compactness(model: ShapeModel) -> Floats:
    """The share of the variance (c,) that the first 1, 2, ... components explain."""
    return np.cumsum(model.explained_variance_ratio_)


def broken_stick(model: ShapeModel) -> Floats:
    """The shares (c,) that the pieces of a stick broken at random have, the largest first (Jackson 1993).

    A component that explains less than its piece is no more than chance.
    """
    count = model.n_components_
    return np.array([sum(1 / np.arange(i, count + 1)) / count for i in range(1, count + 1)])


def generalisation(model: ShapeModel) -> Floats:
    """How far a shape is from what a model of all others makes of it (c,), with 1, 2, ... components.

    The mean distance of points, in units of the aligned configurations, over all shapes left out in turn.
    """
    x = model.aligned_.reshape(len(model.aligned_), -1)
    count = min(model.n_components_, len(x) - 2)
    found = np.zeros((len(x), max(count, 0)))
    for i, one in enumerate(x):
        others = np.delete(x, i, axis=0)
        mean = others.mean(axis=0)
        _, axes = principal_components(others - mean, count)
        for c in range(count):
            some = axes[: c + 1]
            rest = one - mean - ((one - mean) @ some.T) @ some
            found[i, c] = np.linalg.norm(rest.reshape(-1, 3), axis=1).mean()
    return np.asarray(found.mean(axis=0), dtype=np.float64)


def specificity(model: ShapeModel, *, drawn: int = DRAWN, rng: int = 0) -> Floats:
    """How far random shapes of the model are from the nearest of those it was made of (c,), with 1, 2, ... components.

    Scores are drawn as independent normal variables of the explained variances; the mean distance of points, in units
    of the aligned configurations.
    """
    random = np.random.default_rng(rng).standard_normal((drawn, model.n_components_))
    scores, known = random * np.sqrt(model.explained_variance_), model.aligned_
    found = np.zeros(model.n_components_)
    for c in range(model.n_components_):
        for one in model.inverse_transform(scores[:, : c + 1]).reshape(drawn, -1, 3):
            found[c] += np.linalg.norm(known - one, axis=2).mean(axis=1).min() / drawn
    return found
