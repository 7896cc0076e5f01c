"""Closest points of a deformed surface and another."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest

from gmds.registration.closest_points import Pairing
from gmds.registration.deformable import Geometry
from gmds.surface.measured import Surface, measure


@pytest.fixture(scope="module")
def surface() -> Surface:
    return measure(shapes.bumpy_sphere(4))


def test_a_surface_on_itself_is_paired_with_itself(surface: Surface) -> None:
    geometry = Geometry.of(surface)
    for views in (None, (surface.regular, surface.regular)):
        found = Pairing.of(geometry, geometry, geometry.mesh.vertices, False, views)
        assert np.abs(found.points.positions - geometry.mesh.vertices).max() < 1e-6
        assert np.array_equal(found.back, np.arange(len(found.back)))


def test_eigenfunctions_see_through_noise(surface: Surface) -> None:
    geometry = Geometry.of(surface)
    truth = geometry.mesh.vertices
    y = truth + np.random.default_rng(0).normal(0, 0.03, truth.shape)

    def error(views: tuple | None) -> float:
        found = Pairing.of(geometry, geometry, y, False, views)
        return float(np.linalg.norm(found.points.positions - truth, axis=1).mean())

    assert error((surface.regular, surface.regular)) < 0.7 * error(None)


def test_springs_weigh_each_surface_once(surface: Surface) -> None:
    geometry = Geometry.of(surface)
    weights, ends = Pairing.of(geometry, geometry, geometry.mesh.vertices, False).springs(geometry, geometry)
    assert weights.sum() == pytest.approx(2)
    assert np.abs(ends - geometry.mesh.vertices).max() < 1e-6
