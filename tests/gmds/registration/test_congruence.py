"""A surface and the same turned: what is congruent is found exactly."""

from __future__ import annotations

from collections.abc import Callable

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy

from geodesics import Mesh
from gmds.registration.deformable import DeformableMesh
from gmds.registration.energies import ALL, EnergyKind
from gmds.registration.register import assessed, register
from gmds.registration.settings import FULL, RegistrationSettings
from gmds.surface.measured import measure

Pair = tuple[DeformableMesh, DeformableMesh]
SURFACES: dict[str, Callable[[], Mesh]] = {
    "bumpy": bumpy,
    "animal": animal,
    "disc": lambda: shapes.jittered(shapes.disc(6), 0.3),
    "isolated vertices": lambda: shapes.with_isolated(bumpy()),
}


@pytest.fixture(params=SURFACES)
def pair(request: pytest.FixtureRequest) -> Pair:
    """A surface and the same turned."""
    mesh = SURFACES[request.param]()
    return DeformableMesh.of(measure(mesh)), DeformableMesh.of(measure(shapes.moved(mesh, 3.0)))


def test_features_are_the_same_however_they_are_computed(pair: Pair) -> None:
    assert np.allclose(pair[0].features, pair[0].moved_features(pair[0].mesh.vertices), atol=1e-12)


def test_a_congruence_leaves_nothing(pair: Pair) -> None:
    source, target = pair
    truth, used = target.mesh.vertices, source.usable
    found = assessed(source, target, truth, FULL)
    assert np.array_equal(found.y, truth)
    assert np.allclose(found.points.positions[used], truth[used], atol=1e-9)
    assert found.residuals.energy < 1e-9 and found.residuals.misfit < 1e-9 and found.residuals.misfit_back < 1e-9
    assert found.residuals.curvature == pytest.approx(1) and found.residuals.curvature_back == pytest.approx(1)
    assert found.strain[used].max() < 1e-6


@pytest.mark.parametrize("energy", ALL)
def test_a_congruence_stays_when_it_is_registered(pair: Pair, energy: EnergyKind) -> None:
    source, target = pair
    truth, used = target.mesh.vertices, source.usable
    found = register(source, target, truth, RegistrationSettings(energy=energy))
    assert np.abs(found.points.positions - truth)[used].max() < 2e-4
