"""Local stress puts an isometric copy back, whatever a few images say that are not believed."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

from geodesics import Mesh
from gmds.parts.local_stress import ANCHORS, LocalStress, farthest, mutual_distances
from gmds.registration.deformable import DeformableMesh
from gmds.shapes import quadruped
from gmds.surface.measured import measure


@pytest.fixture(scope="module")
def animal() -> DeformableMesh:
    return DeformableMesh.of(measure(quadruped(n_vertices=500)))


@pytest.fixture(scope="module")
def copy(animal: DeformableMesh) -> tuple[LocalStress, np.ndarray]:
    """An animal, and the same turned, resized and renumbered; and where its vertices are."""
    order = np.random.default_rng(0).permutation(500)
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    other = Mesh(7 * animal.mesh.vertices[order] @ turn.T, np.argsort(order)[animal.mesh.faces])
    return LocalStress(animal, DeformableMesh.of(measure(other))), np.argsort(order)


def test_an_isometric_copy_is_left_where_it_is(copy: tuple[LocalStress, np.ndarray]) -> None:
    stress, true = copy
    assert np.array_equal(stress.placed(true, np.ones(500), 1.0), true)


def test_images_that_are_not_believed_have_no_say(copy: tuple[LocalStress, np.ndarray]) -> None:
    stress, true = copy
    wrong = np.random.default_rng(2).uniform(size=500) < 0.3
    images = np.where(wrong, np.random.default_rng(3).integers(0, 500, 500), true)
    assert np.array_equal(stress.placed(images, np.where(wrong, 0.0, 1.0), 1.0), true)


def test_noise_in_the_images_becomes_smaller(copy: tuple[LocalStress, np.ndarray]) -> None:
    stress, true = copy
    near = mutual_distances(stress.target).argsort(axis=1)[true, np.random.default_rng(4).integers(0, 25, 500)]
    there = mutual_distances(stress.target)
    before, after = (there[true, images] for images in (near, stress.placed(near, np.ones(500), 1.0)))
    assert after.mean() < before.mean() / 2


def test_distances_are_symmetric_and_anchors_are_apart(animal: DeformableMesh) -> None:
    distances, chosen = mutual_distances(animal), farthest(animal)
    assert np.allclose(distances, distances.T, rtol=0.02, atol=0.02) and np.allclose(np.diag(distances), 0)
    assert len(set(chosen.tolist())) == ANCHORS
    apart = distances[np.ix_(chosen, chosen)] + 9 * np.eye(ANCHORS)
    assert distances[chosen].min(axis=0).max() <= apart.min() + 1e-9  # nobody is farther off than they from each other
    assert len(farthest(DeformableMesh.of(measure(bumpy_sphere(1))))) == 42
