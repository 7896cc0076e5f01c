"""The similarity nearest to a map, which shapes without limbs and regions laid anew both begin from."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from gmds.registration.similarity import nearest_similarity

RNG = np.random.default_rng(0)
POINTS = RNG.normal(size=(40, 3))
SHARES = np.full(40, 1 / 40)
TURN = Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()


def test_a_similarity_is_its_own_nearest() -> None:
    goals = 1.7 * POINTS @ TURN.T + [0.4, -0.1, 0.2]
    found = nearest_similarity(POINTS, goals, SHARES)
    np.testing.assert_allclose(found.rotation, TURN, atol=1e-12)
    assert np.isclose(found.size, 1.7)
    np.testing.assert_allclose(found.moved(POINTS), goals, atol=1e-12)


def test_nothing_near_it_is_nearer() -> None:
    goals = POINTS @ TURN.T + 0.3 * RNG.normal(size=POINTS.shape)
    shares = RNG.uniform(size=40)
    shares /= shares.sum()
    found = nearest_similarity(POINTS, goals, shares)
    least = shares @ ((found.moved(POINTS) - goals) ** 2).sum(axis=1)
    for _ in range(50):
        turn = Rotation.from_rotvec(1e-3 * RNG.normal(size=3)).as_matrix()
        other = found._replace(rotation=turn @ found.rotation, size=found.size * (1 + 1e-3 * RNG.normal()))
        assert least <= shares @ ((other.moved(POINTS) - goals) ** 2).sum(axis=1)


def test_a_mirror_image_is_not_mirrored() -> None:
    found = nearest_similarity(POINTS, POINTS * [-1.0, 1.0, 1.0], SHARES)
    assert np.isclose(np.linalg.det(found.rotation), 1.0)


def test_points_in_one_place_stay_together() -> None:
    """Neither a region without extent nor one that is sent to a single place makes anything that is no number."""
    one = np.tile([1.0, 2.0, 3.0], (40, 1))
    for here, there in ((one, POINTS), (POINTS, one)):
        found = nearest_similarity(here, there, SHARES)
        assert np.isfinite(found.size)
        np.testing.assert_allclose(found.moved(here), np.tile(there.mean(axis=0), (40, 1)), atol=1e-12)
