"""Surfaces laid on each other from the similarity nearest to a map."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from geodesics import Mesh
from gmds.registration.deformable import DeformableMesh
from gmds.registration.in_space import bent, in_space, similar
from gmds.registration.register import register
from gmds.registration.settings import FULL
from gmds.surface.measured import measure

Array = NDArray[np.float64]
TURN = Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()
SHIFT = np.array([0.4, -0.1, 0.2])


def deformable(mesh: Mesh) -> DeformableMesh:
    return DeformableMesh.of(measure(mesh))


def test_a_similarity_is_found_again_and_is_not_bent() -> None:
    source = deformable(bumpy())
    y = 1.7 * source.mesh.vertices @ TURN.T + SHIFT
    assert np.allclose(similar(source, y), y)
    assert bent(source, y) < 1e-12


def test_the_similarity_nearest_to_a_mirror_image_does_not_mirror() -> None:
    source = deformable(bumpy())
    y = source.mesh.vertices * [-1.0, 1.0, 1.0]
    assert bent(source, y) > 0.02
    a, b, c = (similar(source, y)[corner] for corner in source.mesh.faces.T)
    assert (np.cross(b - a, c - a) * a).sum() > 0  # the volume keeps its sign


def test_what_is_bent_lies_as_far_from_a_similarity_as_it_was_moved() -> None:
    source = deformable(shapes.ellipsoid())
    x = source.mesh.vertices
    y = x + 0.05 * np.column_stack([np.zeros(len(x)), np.zeros(len(x)), x[:, 1] ** 2])
    moved = source.areas @ (y - x) ** 2
    assert 0 < bent(source, y) < np.sqrt(moved.sum())


@pytest.mark.parametrize("slid", [0.0, 0.15])
def test_a_sheared_copy_is_found_from_a_map_that_slides(slid: float) -> None:
    mesh = bumpy()
    source = deformable(mesh)
    matrix = np.array([[1.1, 0.15, 0.0], [0.0, 0.95, 0.1], [0.0, 0.0, 1.0]])
    target = deformable(Mesh(mesh.vertices @ matrix.T, mesh.faces))
    x, truth = source.mesh.vertices, target.mesh.vertices
    turn = Rotation.from_rotvec([0.0, 0.0, slid]).as_matrix()
    near = target.places.query(x @ turn.T)[1]
    begun = register(source, target, truth[near], FULL)
    before = np.linalg.norm(begun.points.positions - truth, axis=1).mean()
    after = np.linalg.norm(in_space(source, target, begun.y).points.positions - truth, axis=1).mean()
    assert after < 0.01
    assert after < before / 2
