"""A map as a matrix between eigenfunctions, and back."""

from __future__ import annotations

import numpy as np
import pytest
from matched_shapes import bumpy, permuted, surface
from scipy.spatial.distance import cdist

from gmds.spectral import functional_maps
from gmds.spectral.functional_maps import functional_map, nearest_rows, spectral_upsampling


@pytest.mark.parametrize("k", [1, 3, 40])
def test_nearest_rows_agrees_with_its_naive_twin(k: int) -> None:
    rng = np.random.default_rng(k)
    queries, rows = rng.standard_normal((80, k)), rng.standard_normal((150, k))
    found, distances = nearest_rows(queries, rows), cdist(queries, rows)
    chosen = distances[np.arange(80), found]
    assert np.allclose(chosen, distances.min(axis=1), rtol=0, atol=1e-3)
    assert (found == distances.argmin(axis=1)).mean() > 0.97


def test_nearest_rows_does_not_depend_on_the_size_of_its_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    queries, rows = rng.standard_normal((101, 6)), rng.standard_normal((70, 6))
    whole = nearest_rows(queries, rows)
    monkeypatch.setattr(functional_maps, "_BLOCK", 70 * 7)
    assert np.array_equal(nearest_rows(queries, rows), whole)
    monkeypatch.setattr(functional_maps, "_BLOCK", 1)
    assert np.array_equal(nearest_rows(queries, rows), whole)


@pytest.mark.parametrize(("k", "m"), [(6, 6), (9, 5), (4, 8)])
def test_functional_map_finds_the_matrix_that_made_the_rows(k: int, m: int) -> None:
    rng = np.random.default_rng(1)
    rows, matrix = rng.standard_normal((40, k)), rng.standard_normal((k, m))
    assert np.allclose(functional_map(rows, rows @ matrix), matrix, atol=1e-10)


def test_functional_map_is_the_least_squares_answer() -> None:
    rng = np.random.default_rng(2)
    rows, target = rng.standard_normal((40, 5)), rng.standard_normal((40, 4))
    residual = rows @ functional_map(rows, target) - target
    assert np.allclose(rows.T @ residual, 0, atol=1e-10)


def test_functional_map_of_a_renumbering_is_the_identity() -> None:
    mesh, place = permuted(bumpy())
    ours = surface(bumpy()).regular.functions
    theirs = np.empty_like(ours)
    theirs[place] = ours
    assert np.allclose(functional_map(ours, theirs[place]), np.eye(ours.shape[1]), atol=1e-9)
    assert mesh.n_vertices == len(ours)


@pytest.mark.parametrize("stretch", [0.0, 0.15], ids=["orthogonal", "not orthogonal"])
def test_upsampling_recovers_a_map_through_a_known_matrix(stretch: float) -> None:
    # Y[place] = X C with C a turn (not symmetric, so the transpose would be another map), or a stretched one
    rng = np.random.default_rng(3)
    k, n = 12, 300
    rows = rng.standard_normal((n, k))
    turn = np.linalg.qr(rng.standard_normal((k, k)))[0]
    matrix = turn @ np.diag(np.exp(stretch * rng.uniform(-1, 1, k)))
    place = rng.permutation(n)
    functions = np.empty((n, k))
    functions[place] = rows @ matrix
    start = place.copy()
    start[:30] = rng.permutation(start[:30])  # a tenth of the points begin in a wrong place
    found, images = spectral_upsampling(rows, functions, start, [k, k, k], np.arange(n))
    assert np.array_equal(images, place)
    assert np.allclose(found, matrix, atol=1e-8)


def test_upsampling_keeps_to_the_goals() -> None:
    rng = np.random.default_rng(4)
    rows, functions = rng.standard_normal((50, 6)), rng.standard_normal((200, 6))
    goals = rng.choice(200, 40, replace=False)
    _, images = spectral_upsampling(rows, functions, goals[rng.integers(0, 40, 50)], [3, 6], goals)
    assert np.isin(images, goals).all()


def test_upsampling_climbs_from_few_functions_to_the_right_map() -> None:
    view = surface(bumpy()).regular
    n = len(view.functions)
    mesh = view.mesh.vertices
    start = cdist(mesh, mesh + 0.1).argmin(axis=1)  # a shifted map, wrong nearly everywhere
    assert (start == np.arange(n)).mean() < 0.5
    _, images = spectral_upsampling(view.functions, view.functions, start, (4, 8, 16, 32, 64), np.arange(n))
    assert np.array_equal(images, np.arange(n))
