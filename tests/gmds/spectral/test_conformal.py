"""Metrics conformal to that of space, in the span of eigenfunctions that are there already."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, surface

from geodesics import eigenpairs
from geodesics.metric import conformal
from gmds.deformations import achieved_log_scale, local_scaling
from gmds.spectral.conformal_metrics import LARGEST_FACTOR, ConformalClass
from gmds.surface.measured import measure

TIMES = (3e-3, 1e-3)


@pytest.fixture(scope="module")
def family() -> ConformalClass:
    return ConformalClass(surface(animal()))


def test_the_basis_is_orthonormal_in_area(family: ConformalClass) -> None:
    gram = family.basis.T @ (family.surface.areas[:, None] * family.basis)
    assert np.allclose(gram, np.eye(len(gram)), atol=1e-9)


@pytest.mark.parametrize("size", [1.0, 7.3])
def test_factor_one_gives_back_the_metric_of_space(family: ConformalClass, size: float) -> None:
    regular = family.surface.regular
    view = family.view(np.full(len(regular.functions), size), 60)
    assert np.allclose(view.spectrum.mass, regular.spectrum.mass)
    assert np.allclose(view.eigenvalues, regular.eigenvalues[:60], rtol=1e-9, atol=1e-9)
    overlap = np.abs(view.functions.T @ (regular.spectrum.mass[:, None] * regular.functions[:, :60]))
    assert np.allclose(overlap, np.eye(60), atol=1e-6)


@pytest.mark.parametrize("axis", [0, 2])
def test_a_known_factor_agrees_with_finite_elements(family: ConformalClass, axis: int) -> None:
    mesh = family.surface.mesh
    x = mesh.vertices[:, axis]
    factor = np.exp(1.5 * np.tanh((x - x.mean()) / x.std()))
    exact = eigenpairs(conformal(mesh, factor), 25)
    view = family.view(factor, 25)
    assert view.eigenvalues[0] == 0
    ratio = view.eigenvalues[1:] / (exact.eigenvalues[1:] * exact.mass.sum())
    assert (ratio > 1 - 1e-6).all()  # Rayleigh-Ritz comes from above
    assert (ratio < 1.05).all()


def test_functions_are_orthonormal_in_the_new_mass(family: ConformalClass) -> None:
    factor = np.exp(np.random.default_rng(0).uniform(-1, 1, len(family.basis)))
    view = family.view(factor, 30)
    assert view.spectrum.mass.sum() == pytest.approx(1)
    gram = view.functions.T @ (view.spectrum.mass[:, None] * view.functions)
    assert np.allclose(gram, np.eye(30), atol=1e-8)


@pytest.mark.parametrize("time", TIMES)
def test_the_density_of_the_identity_is_one(family: ConformalClass, time: float) -> None:
    assert np.allclose(family.density(family.surface.areas, time), 1, atol=1e-9)


def test_density_is_linear_until_it_is_cut_off(family: ConformalClass) -> None:
    areas = family.surface.areas
    assert np.allclose(family.density(3 * areas, TIMES[0]), 3, atol=1e-8)
    assert np.allclose(family.density(1e5 * areas, TIMES[0]), LARGEST_FACTOR)
    assert np.allclose(family.density(0 * areas, TIMES[0]), 1 / LARGEST_FACTOR)


def test_density_keeps_the_amount_before_it_is_cut_off(family: ConformalClass) -> None:
    rng = np.random.default_rng(1)
    amounts = family.surface.areas * rng.uniform(0.5, 1.5, len(family.basis))
    density = family.density(amounts, TIMES[1])
    assert family.surface.areas @ density == pytest.approx(amounts.sum(), rel=0.02)
    assert np.log(density).std() < 0.5 * np.log(amounts / family.surface.areas).std()


def test_density_finds_the_local_scale_of_a_part_that_grew() -> None:
    mesh = shapes.bumpy_sphere(3)
    z = mesh.vertices[:, 2]
    log_scale = np.log(2.0) / (1 + np.exp(-6 * (z - np.median(z))))
    grown, _ = local_scaling(mesh, log_scale)
    source, target = measure(mesh), measure(grown)
    density = ConformalClass(target).density(source.areas, 1e-3)
    expected = -2 * achieved_log_scale(mesh, grown)
    expected -= expected @ source.areas
    found = np.log(density)
    found -= found @ source.areas
    assert np.ptp(expected) > 1
    assert np.corrcoef(found, expected)[0, 1] > 0.98
    assert np.polyfit(expected, found, 1)[0] == pytest.approx(1, abs=0.12)


def test_a_part_that_grew_is_shrunk_back() -> None:
    # low eigenvalues in the metric that keeps area are those of the surface before it grew
    mesh = bumpy()
    z = mesh.vertices[:, 2]
    grown, _ = local_scaling(mesh, np.log(2.0) / (1 + np.exp(-4 * (z - np.median(z)))))
    source, target = measure(mesh), measure(grown)
    family = ConformalClass(target)
    view = family.view(family.density(source.areas, 1e-3), 12)
    regular = source.regular.eigenvalues[1:12]
    aligned = np.abs(view.eigenvalues[1:] / regular - 1).mean()
    plain = np.abs(target.regular.eigenvalues[1:12] / regular - 1).mean()
    assert aligned < 0.3 * plain
