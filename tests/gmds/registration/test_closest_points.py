"""Closest points of a deformed surface and another."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest

from gmds.registration.closest_points import ClosestPoints
from gmds.registration.deformable import DeformableMesh
from gmds.registration.settings import RegistrationSettings
from gmds.surface.measured import Surface, measure


@pytest.fixture(scope="module")
def surface() -> Surface:
    return measure(shapes.bumpy_sphere(4))


def test_a_surface_on_itself_is_paired_with_itself(surface: Surface) -> None:
    deformable = DeformableMesh.of(surface)
    for views in (None, (surface.regular, surface.regular)):
        found = ClosestPoints.of(deformable, deformable, deformable.mesh.vertices, RegistrationSettings(views=views))
        assert np.abs(found.points.positions - deformable.mesh.vertices).max() < 1e-6
        assert np.array_equal(found.back, np.arange(len(found.back)))


def test_eigenfunctions_see_through_noise(surface: Surface) -> None:
    deformable = DeformableMesh.of(surface)
    truth = deformable.mesh.vertices
    y = truth + np.random.default_rng(0).normal(0, 0.03, truth.shape)

    def error(views: tuple | None) -> float:
        found = ClosestPoints.of(deformable, deformable, y, RegistrationSettings(views=views))
        return float(np.linalg.norm(found.points.positions - truth, axis=1).mean())

    assert error((surface.regular, surface.regular)) < 0.7 * error(None)


def test_point_constraints_weigh_each_surface_once(surface: Surface) -> None:
    deformable = DeformableMesh.of(surface)
    closest = ClosestPoints.of(deformable, deformable, deformable.mesh.vertices, RegistrationSettings())
    weights, ends = closest.point_constraints(deformable)
    assert weights.sum() == pytest.approx(2)
    assert np.abs(ends - deformable.mesh.vertices).max() < 1e-6
