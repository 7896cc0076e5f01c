"""The rotation nearest to a matrix, as Kabsch finds it by singular values."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from gmds._kernels.rotations import nearest_rotations

Array = NDArray[np.float64]
RNG = np.random.default_rng(0)
TURNS = Rotation.random(40, random_state=1).as_matrix()
HALF_TURNS = np.array([np.diag(d) for d in ([1.0, -1, -1], [-1.0, 1, -1], [-1.0, -1, 1])])
ROWS = RNG.standard_normal((2, 40, 3, 1))


def rank_one() -> Array:
    return np.asarray(ROWS[0] @ ROWS[1].transpose(0, 2, 1))


def symmetric() -> Array:
    any_ = RNG.standard_normal((20, 3, 3))
    return np.asarray(any_ + any_.transpose(0, 2, 1))


def with_singular_values(*values: float) -> Array:
    return np.asarray(TURNS @ np.diag(values) @ TURNS[::-1])


MATRICES = {
    "random": RNG.standard_normal((200, 3, 3)),
    "turns": TURNS,
    "half turns": HALF_TURNS,
    "reflections": -TURNS,
    "reflection in a plane": TURNS * [1, 1, -1],
    "singular": with_singular_values(2, 1, 0),
    "nearly singular": with_singular_values(2, 1, 1e-9),
    "rank one": rank_one(),
    "nearly rank one": rank_one() + 1e-9 * RNG.standard_normal((40, 3, 3)),
    "needles": with_singular_values(1, 1e-6, 1e-12),
    "two alike, reflected": with_singular_values(3, 1, -1),
    "diagonal": np.array([np.diag(d) for d in RNG.standard_normal((20, 3))]),
    "symmetric": symmetric(),
    "zero": np.zeros((2, 3, 3)),
}
UNIQUE = ("random", "turns", "half turns", "singular", "nearly singular", "symmetric", "diagonal")


def by_singular_values(products: Array) -> tuple[Array, Array]:
    """Kabsch 1976: S = U D V^T gives R = V diag(1, 1, det(V U)) U^T, and the sum s_1 + s_2 +- s_3."""
    u, values, vt = np.linalg.svd(products)
    signs = np.ones((len(u), 3))
    signs[:, 2] = np.sign(np.linalg.det(u) * np.linalg.det(vt))
    rotations = (vt.transpose(0, 2, 1) * signs[:, None]) @ u.transpose(0, 2, 1)
    return rotations, (values * signs).sum(axis=1)


def largest(products: Array) -> Array:
    return np.maximum(np.abs(products).max(axis=(1, 2)), np.finfo(float).tiny)


@pytest.mark.parametrize("name", MATRICES)
def test_what_comes_back_is_a_rotation_and_never_a_reflection(name: str) -> None:
    rotations, _ = nearest_rotations(MATRICES[name])
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3), atol=1e-13)
    assert np.allclose(np.linalg.det(rotations), 1, atol=1e-13)


@pytest.mark.parametrize("scale", [1e-30, 1e-9, 1.0, 1e9, 1e30])
@pytest.mark.parametrize("name", MATRICES)
def test_the_sum_is_the_largest_there_is(name: str, scale: float) -> None:
    products = scale * MATRICES[name]
    rotations, sums = nearest_rotations(products)
    expected = by_singular_values(products)[1]
    assert np.allclose((sums - expected) / largest(products), 0, atol=1e-13)
    attained = np.einsum("nab,nba->n", rotations, products)
    assert np.allclose((attained - expected) / largest(products), 0, atol=1e-13)


@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e30])
@pytest.mark.parametrize("name", UNIQUE)
def test_where_there_is_one_best_rotation_it_is_found(name: str, scale: float) -> None:
    products = scale * MATRICES[name]
    expected = by_singular_values(products)[0]
    assert np.allclose(nearest_rotations(products)[0], expected, atol=1e-11)


def test_points_that_were_turned_are_turned_back() -> None:
    x = RNG.standard_normal((30, 3)) * [1, 2, 0.3]
    products = np.array([x.T @ (x @ turn.T) for turn in TURNS])
    rotations, sums = nearest_rotations(products)
    assert np.allclose(rotations, TURNS, atol=1e-12)
    assert np.allclose(sums, (x**2).sum())


def test_no_other_rotation_does_better() -> None:
    products = MATRICES["random"][:20]
    _, sums = nearest_rotations(products)
    others = Rotation.random(500, random_state=2).as_matrix()
    assert (np.einsum("kab,nba->nk", others, products) <= sums[:, None] + 1e-12).all()


def test_each_matrix_is_on_its_own_and_none_is_no_trouble() -> None:
    products = MATRICES["random"]
    rotations, sums = nearest_rotations(products)
    order = RNG.permutation(len(products))
    again = nearest_rotations(products[order])
    assert np.array_equal(again[0], rotations[order]) and np.array_equal(again[1], sums[order])
    assert nearest_rotations(np.empty((0, 3, 3)))[0].shape == (0, 3, 3)


def test_the_matrices_given_are_not_changed() -> None:
    products = MATRICES["random"].copy()
    nearest_rotations(products)
    assert np.array_equal(products, MATRICES["random"])
