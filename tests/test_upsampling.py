"""Sample maps and their spectral refinement."""

from __future__ import annotations

import numpy as np
import pytest
import shapes
from matched import animal, bumpy, permuted, surface
from scipy.spatial.distance import cdist

from gmds.functional_maps import functional_map
from gmds.surface import measure
from gmds.upsampling import COARSE, FUNCTIONS, JUDGED, SampledPair


@pytest.fixture(scope="module")
def pair() -> SampledPair:
    """The animal with itself; its first samples are the same on both sides."""
    view = surface(animal()).regular
    return SampledPair.of(view, view)


@pytest.fixture(scope="module")
def same(pair: SampledPair) -> np.ndarray:
    """The identity as a sample map."""
    return np.arange(len(pair.source_samples))


def test_fewer_samples_are_the_first_of_more(pair: SampledPair, same: np.ndarray) -> None:
    assert len(pair.target_samples) > len(pair.source_samples) > JUDGED
    assert np.array_equal(pair.target_samples[same], pair.source_samples)


@pytest.mark.parametrize("k", [COARSE[0], COARSE[-1], 31])
def test_the_matrix_of_the_identity_is_the_identity(pair: SampledPair, same: np.ndarray, k: int) -> None:
    assert np.allclose(pair.matrix(same, k), np.eye(k), atol=1e-9)


@pytest.mark.parametrize("k", [COARSE[1], 31])
def test_the_matrix_is_the_least_squares_functional_map(pair: SampledPair, k: int) -> None:
    images = np.random.default_rng(0).integers(0, len(pair.target_samples), len(pair.source_samples))
    expected = functional_map(pair.source_rows[:, :k], pair.target_rows[images, :k])
    assert np.allclose(pair.matrix(images, k), expected, atol=1e-8 * np.abs(expected).max())


def test_the_identity_stays_when_refined_and_carried_to_all_vertices(pair: SampledPair, same: np.ndarray) -> None:
    assert np.array_equal(pair.images(np.eye(COARSE[-1])), same)
    refined = pair.refined(same)
    assert (refined == same).mean() > 0.95
    vertices = pair.source.mesh.vertices
    off = np.linalg.norm(vertices[pair.dense(refined)] - vertices, axis=1)
    assert np.median(off) == 0
    assert off.max() < 0.15 * np.ptp(vertices)


def test_a_map_is_carried_to_some_vertices_as_to_all_and_to_goals_only(pair: SampledPair, same: np.ndarray) -> None:
    rng = np.random.default_rng(4)
    some = rng.choice(pair.source.mesh.n_vertices, 50, replace=False)
    assert np.array_equal(pair.carried(same, some, pair.target.usable), pair.dense(same)[some])
    goals = rng.choice(pair.target.usable, 80, replace=False)
    found, place = pair.carried(same, some, goals), pair.target.mesh.vertices
    assert np.isin(found, goals).all()
    nearest = cdist(place[some], place[goals]).min(axis=1)
    assert np.median(np.linalg.norm(place[found] - place[some], axis=1)) < 1.2 * np.median(nearest)


def test_refinement_repairs_a_disturbed_map(pair: SampledPair, same: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    places = pair.target.mesh.vertices[pair.target_samples]
    start = cdist(places[same] + rng.normal(0, 0.1 * places.std(), (len(same), 3)), places).argmin(axis=1)
    before, after = pair.gap(start, same), pair.gap(pair.refined(start), same)
    assert after < 0.2 * before


def test_stress_and_gap_are_zero_for_the_identity_only(pair: SampledPair, same: np.ndarray) -> None:
    assert pair.stress(same) == pytest.approx(0, abs=1e-7)
    assert pair.gap(same, same) == 0
    other = np.roll(same, 1)
    assert pair.stress(other) > 0.1
    assert pair.gap(same, other) == pair.gap(other, same) > 0.1


def test_stress_agrees_with_its_naive_twin(pair: SampledPair) -> None:
    images = np.random.default_rng(2).integers(0, len(pair.target_samples), len(pair.source_samples))
    ours = pair.source.embedding[pair.source_samples[:JUDGED], :FUNCTIONS]
    theirs = pair.target.embedding[pair.target_samples[images[:JUDGED]], :FUNCTIONS]
    here, there = cdist(ours, ours), cdist(theirs, theirs)
    assert pair.stress(images) == pytest.approx(np.abs(here - there).mean() / here.mean(), rel=1e-6)


def test_gap_obeys_the_triangle_inequality(pair: SampledPair) -> None:
    rng = np.random.default_rng(3)
    a, b, c = (rng.integers(0, len(pair.target_samples), len(pair.source_samples)) for _ in range(3))
    assert pair.gap(a, c) <= pair.gap(a, b) + pair.gap(b, c)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_stress_does_not_depend_on_size_or_numbering(scale: float) -> None:
    mesh, place = permuted(shapes.moved(bumpy(), scale, seed=2))
    other = measure(mesh).regular
    view = surface(bumpy()).regular
    pair = SampledPair.of(view, other)
    index = np.full(mesh.n_vertices, -1)
    index[pair.target_samples] = np.arange(len(pair.target_samples))
    truth = index[place[pair.source_samples]]
    assert (truth >= 0).all()
    assert pair.stress(truth) < 1e-6
