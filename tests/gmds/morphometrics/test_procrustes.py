"""Superposition takes out place, rotation and size, and nothing else; missing points have no say."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import procrustes
from scipy.spatial.transform import Rotation

from geodesics.errors import BadArgument, BadShape
from gmds.morphometrics.procrustes import superimposed

RNG = np.random.default_rng(3)


def moved(points: np.ndarray, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.uniform(0.5, 3) * Rotation.random(random_state=seed).apply(points) + rng.normal(size=3)


def test_copies_in_other_places_become_one() -> None:
    shape = RNG.normal(size=(12, 3))
    found = superimposed([moved(shape, seed) for seed in range(5)])
    assert found.distances.max() < 1e-12 and np.allclose(np.linalg.norm(found.mean), 1)
    assert found.rounds < 5 and found.change < 1e-10


def test_of_two_shapes_it_is_what_scipy_says() -> None:
    one, other = RNG.normal(size=(2, 10, 3))
    found = superimposed([one, other])
    full = np.sum((found.aligned[0] - found.aligned[1]) ** 2)
    cosine = 1 - full / 2 / np.prod([np.linalg.norm(x) for x in found.aligned])
    assert procrustes(one, other)[2] > 0 and 0 < cosine <= 1
    assert np.allclose(found.sizes, [np.linalg.norm(x - x.mean(axis=0)) for x in (one, other)])


def test_a_mirror_image_stays_one_unless_reflections_are_allowed() -> None:
    shape = RNG.normal(size=(12, 3))
    pair = [shape, shape * [-1, 1, 1]]
    assert superimposed(pair).distances.max() > 0.05
    assert superimposed(pair, reflect=True).distances.max() < 1e-12


def test_missing_points_have_no_say_and_take_the_place_of_the_mean() -> None:
    shape = RNG.normal(size=(12, 3))
    configurations = np.stack([moved(shape, seed) for seed in range(4)])
    wrong = configurations.copy()
    wrong[1, :4] = 1e3
    valid = np.ones((4, 12), dtype=bool)
    valid[1, :4] = False
    found = superimposed(wrong, valid)
    assert found.distances.max() < 1e-10
    assert np.allclose(found.sizes, superimposed(configurations).sizes)
    back = found.moves[1].inverse(found.mean)
    assert np.allclose(back[:4], configurations[1, :4])
    nan = np.where(valid[:, :, None], configurations, np.nan)
    assert np.allclose(superimposed(nan).mean, found.mean)


def test_size_stays_where_it_is_wanted() -> None:
    shape = RNG.normal(size=(12, 3))
    found = superimposed([shape, 2 * shape + 1], scale=False)
    assert np.allclose(found.distances, np.linalg.norm(shape - shape.mean(axis=0)) / 2)


def test_what_cannot_be_superimposed_is_refused() -> None:
    with pytest.raises(BadShape, match="E108"):
        superimposed(np.zeros((3, 4)))
    few = np.ones((2, 5), dtype=bool)
    few[1, 2:] = False
    with pytest.raises(BadArgument, match="configuration 1 has 2 points"):
        superimposed(RNG.normal(size=(2, 5, 3)), few)
    nowhere = np.ones((2, 5), dtype=bool)
    nowhere[:, 3] = False
    with pytest.raises(BadArgument, match="point 3 is missing in all"):
        superimposed(RNG.normal(size=(2, 5, 3)), nowhere)
