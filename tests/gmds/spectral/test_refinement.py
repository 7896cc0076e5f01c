"""From a rough map to a good one."""

from __future__ import annotations

import functools

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, permuted, surface
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from gmds.deformations import local_scaling
from gmds.spectral.refinement import ROUNDS, Refiner, upsampled
from gmds.surface.measured import Surface, measure

ALL = tuple(range(len(ROUNDS)))


@functools.cache
def grown() -> tuple[Surface, Surface]:
    """A surface and the same with its upper half twice as large."""
    mesh = shapes.bumpy_sphere(3)
    z = mesh.vertices[:, 2]
    return measure(mesh), measure(local_scaling(mesh, np.log(2.0) / (1 + np.exp(-3 * (z - np.median(z)))))[0])


def disturbed(target: Surface, truth: NDArray[np.int64], amount: float = 0.08) -> NDArray[np.int64]:
    """A map with noise; the area is 1."""
    places = target.mesh.vertices
    return cdist(places[truth] + np.random.default_rng(0).normal(0, amount, (len(truth), 3)), places).argmin(axis=1)


def off(target: Surface, images: np.ndarray, truth: np.ndarray) -> float:
    """Mean distance in space, the area being 1."""
    return float(np.linalg.norm(target.mesh.vertices[images] - target.mesh.vertices[truth], axis=1).mean())


@pytest.mark.parametrize("name", ["bumpy", "animal"])
def test_the_identity_is_a_fixed_point_of_alignment_and_the_metric_that_of_space(name: str) -> None:
    mine = surface(animal() if name == "animal" else bumpy())
    same = np.arange(mine.mesh.n_vertices)
    images, view = Refiner(mine, mine).aligned(same, ALL)
    assert (images == same).mean() > 0.99
    assert off(mine, images, same) < 1e-3
    assert np.allclose(view.spectrum.mass, mine.areas, rtol=0.2)
    count = len(view.eigenvalues)
    assert np.allclose(view.eigenvalues, mine.regular.eigenvalues[:count], rtol=0.02)


def test_the_identity_of_a_surface_with_more_vertices_than_carriers_stays() -> None:
    mine = measure(shapes.torus(64, 32))
    assert mine.mesh.n_vertices > 1500
    same = np.arange(mine.mesh.n_vertices)
    images, view = Refiner(mine, mine).aligned(same, (2,))
    assert np.allclose(view.eigenvalues, mine.regular.eigenvalues[: len(view.eigenvalues)], rtol=0.05)
    assert off(mine, images, same) < 0.01


def test_alignment_repairs_a_rough_map() -> None:
    mine, same = surface(bumpy()), np.arange(bumpy().n_vertices)
    rough = disturbed(mine, same)
    assert off(mine, rough, same) > 0.08
    images, _ = Refiner(mine, mine).aligned(rough, ALL)
    assert (images == same).mean() > 0.97


def test_where_a_part_grew_alignment_does_better_than_the_metric_of_space() -> None:
    source, target = grown()
    same = np.arange(source.mesh.n_vertices)
    rough = disturbed(target, same)
    aligned, _ = Refiner(source, target).aligned(rough, ALL)
    plain = upsampled(source.regular, target.regular, rough)
    assert off(target, aligned, same) < 0.15 * off(target, rough, same)
    assert off(target, aligned, same) < 0.2 * off(target, plain, same)


def test_the_metric_found_is_the_area_the_part_had() -> None:
    source, target = grown()
    same = np.arange(source.mesh.n_vertices)
    _, view = Refiner(source, target).aligned(same, ALL)
    half = source.mesh.vertices[:, 2] > 0
    assert view.spectrum.mass[half].sum() == pytest.approx(source.areas[half].sum(), rel=0.03)
    assert target.areas[half].sum() > 1.3 * source.areas[half].sum()


def test_upsampling_repairs_a_rough_map_to_a_renumbered_copy() -> None:
    mesh, place = permuted(bumpy())
    ours, theirs = surface(bumpy()), measure(mesh)
    rough = disturbed(theirs, place)
    assert (rough == place).mean() < 0.5
    assert np.array_equal(upsampled(ours.regular, theirs.regular, rough), place)


def test_more_eigenfunctions_follow_a_map_more_closely() -> None:
    mine, same = surface(animal()), np.arange(animal().n_vertices)
    rough = disturbed(mine, same, 0.03)
    ladders = (4,), (20, 30), (40, 60, 80, 100, 120)  # there are only 100
    gaps = [off(mine, upsampled(mine.regular, mine.regular, rough, sizes), same) for sizes in ladders]
    assert gaps[0] > 3 * gaps[1] > 9 * gaps[2]
    assert gaps[2] < 1e-3


def test_rounds_are_cut_off_at_the_eigenfunctions_there_are() -> None:
    small = measure(shapes.icosphere(1))
    images, view = Refiner(small, surface(bumpy())).aligned(np.arange(42), ALL)
    assert images.shape == (42,)
    assert np.isfinite(view.functions).all()
