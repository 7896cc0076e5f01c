"""Sample maps: the compiled refinement against the same written out with numpy."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from matched_shapes import bumpy, surface
from scipy.spatial.distance import cdist

from gmds._kernels.sample_maps import mean_difference, minors
from gmds.spectral.orientation import orientation_forms
from gmds.spectral.sample_maps import COARSE, FORM_WEIGHT, SampledPair


@functools.cache
def pair(sense: int) -> SampledPair:
    view = surface(bumpy()).regular
    return SampledPair(view, view, view.samples(60), view.samples(150), sense)


def rooted(values: np.ndarray) -> np.ndarray:
    return np.sign(values) * np.sqrt(np.abs(values))


@pytest.mark.parametrize("sense", [1, -1, 0])
@pytest.mark.parametrize("k", [6, 14])
def test_images_agree_with_their_naive_twin(k: int, sense: int) -> None:
    both = pair(sense)
    matrix = np.diag(np.where(np.arange(k) % 3 == 1, -1.0, 1.0))
    matrix += 0.1 * np.random.default_rng(0).standard_normal((k, k))
    forms = [orientation_forms(both.source, points) for points in (both.source_samples, both.target_samples)]
    scale = FORM_WEIGHT / np.sqrt(np.abs(forms[0]).mean(axis=0))
    queries = np.hstack([both.source_rows[:, :k], abs(sense) * rooted(forms[0]) * scale])
    rows = np.hstack([both.target_rows[:, :k] @ matrix.T, rooted(sense * forms[1] @ minors(matrix).T) * scale])
    gaps = cdist(queries, rows)
    found = both.images(matrix)
    assert np.allclose(gaps[np.arange(len(found)), found], gaps.min(axis=1), atol=1e-4)
    assert (found == gaps.argmin(axis=1)).mean() > 0.95


def test_refinement_goes_from_images_to_matrix_and_back() -> None:
    both = pair(1)
    images = np.random.default_rng(0).integers(0, 150, 60)
    expected = images
    for k in (6, 10):
        expected = both.images(both.matrix(expected, k))
    assert both.refined(images, (6, 10)).tolist() == expected.tolist()
    assert both.refined(images, ()).tolist() == images.tolist()
    assert [each.tolist() for each in both.all_refined([images, expected], COARSE)] == [
        both.refined(each).tolist() for each in (images, expected)
    ]


def test_stress_is_the_mean_difference_of_distances() -> None:
    both, images = pair(1), np.random.default_rng(0).integers(0, 150, 60)
    rows = both.target.commute_time_embedding[both.target_samples, :40]
    there = cdist(rows[images], rows[images])
    expected = np.abs(both.source_distances - there).mean()
    assert mean_difference(both.source_distances, cdist(rows, rows), images) == pytest.approx(expected)
    assert both.stress(images) == pytest.approx(expected / both.source_distances.mean(), rel=1e-5)
