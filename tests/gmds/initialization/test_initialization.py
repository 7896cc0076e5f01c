"""Starts: the right one must be among them."""

from __future__ import annotations

from collections.abc import Callable

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, permuted, surface
from numpy.typing import NDArray

import gmds
from geodesics import Mesh
from gmds.initialization import ALL, eigenfunction_signs, extremities
from gmds.initialization.extremities import surface_extremities, trilaterated
from gmds.initialization.from_landmarks import landmarks
from gmds.spectral.sample_maps import SampledPair
from gmds.surface.measured import measure
from gmds.surface.view import View


def copied(mesh: Mesh) -> tuple[SampledPair, NDArray[np.int64]]:
    """The mesh with a turned, resized and renumbered copy of it, and the true sample map, as nearest samples."""
    copy, place = permuted(shapes.moved(mesh, 3.7, seed=5), seed=6)
    pair = SampledPair.of(surface(mesh).regular, measure(copy).regular)
    images = pair.target.commute_time_embedding[place[pair.source_samples]]
    samples = pair.target.commute_time_embedding[pair.target_samples]
    return pair, np.array([np.linalg.norm(samples - x, axis=1).argmin() for x in images])


@pytest.fixture(scope="module", params=["animal", "bumpy"])
def isometric(request: pytest.FixtureRequest) -> tuple[SampledPair, NDArray[np.int64]]:
    return copied(animal() if request.param == "animal" else bumpy())


@pytest.mark.parametrize("start", ALL, ids=lambda f: f.__name__)
def test_the_right_start_of_an_isometric_copy_is_among_them(
    start: Callable[[SampledPair], list[NDArray[np.int64]]], isometric: tuple[SampledPair, NDArray[np.int64]]
) -> None:
    pair, truth = isometric
    starts = start(pair)
    assert all(len(images) == len(pair.source_samples) for images in starts)
    assert min(pair.gap(images, truth) for images in starts) < 0.15


def test_signs_are_all_tried_once(isometric: tuple[SampledPair, NDArray[np.int64]]) -> None:
    starts = eigenfunction_signs(isometric[0])
    assert len(starts) in (32, 64, 96, 128)
    assert len({images.tobytes() for images in starts}) == len(starts)


def test_the_signs_of_the_eigenfunctions_do_not_matter(isometric: tuple[SampledPair, NDArray[np.int64]]) -> None:
    pair, _ = isometric
    spectrum = pair.target.spectrum
    signs = np.resize([1.0, 1, -1, -1, 1, -1], len(spectrum.eigenvalues))
    other = View(
        pair.target.mesh,
        type(spectrum)(spectrum.mesh, spectrum.mass, spectrum.eigenvalues, spectrum.eigenfunctions * signs),
    )
    turned = SampledPair(pair.source, other, pair.source_samples, pair.target_samples)
    before, after = ({images.tobytes() for images in eigenfunction_signs(p)} for p in (pair, turned))
    assert before == after


def test_extremities_of_a_person_are_hands_feet_and_head() -> None:
    person = gmds.shapes.humanoid(n_vertices=600)
    found = surface_extremities(measure(person).regular)
    rest = person.rest[found]
    tips = {"head": rest[:, 2] > 1.6, "hands": np.abs(rest[:, 1]) > 0.55, "feet": rest[:, 2] < 0.1}
    assert [int(mask.sum()) for mask in tips.values()] == [1, 2, 2]
    for mask in (tips["hands"], tips["feet"]):
        assert sorted(np.sign(rest[mask, 1])) == [-1, 1]


def test_extremities_of_a_dumbbell_are_on_both_balls() -> None:
    found = surface_extremities(measure(shapes.dumbbell(2.0)).regular)
    mesh = shapes.dumbbell(2.0)
    ends = mesh.vertices[found, 2] > np.median(mesh.vertices[:, 2])
    assert len(found) >= 2
    assert ends.any() and not ends.all()


def test_extremities_follow_the_surface_when_it_is_moved_and_renumbered() -> None:
    copy, place = permuted(shapes.moved(animal(), 1e-4, seed=1), seed=2)
    here, there = surface_extremities(surface(animal()).regular), surface_extremities(measure(copy).regular)
    assert np.array_equal(place[here], there)


def test_extremities_of_a_round_sphere_are_no_start_or_a_whole_one() -> None:
    view = measure(shapes.icosphere(2)).regular
    pair = SampledPair.of(view, view)
    assert all((images >= 0).all() and len(images) == len(pair.source_samples) for images in extremities(pair))


@pytest.mark.parametrize("count", [2, 3, 5, 8])
def test_a_start_from_landmarks_comes_near_the_truth(count: int) -> None:
    pair, truth = copied(animal())
    ours = pair.source_samples[:count]
    theirs = pair.target_samples[truth[:count]]
    starts = landmarks(ours, theirs)(pair)
    assert min(pair.gap(images, truth) for images in starts) < 0.3


def test_trilateration_sends_landmarks_to_their_images() -> None:
    pair, truth = copied(animal())
    ours, theirs = pair.source_samples[:6], pair.target_samples[truth[:6]]
    assert np.array_equal(trilaterated(pair, ours, theirs)[:6], truth[:6])
