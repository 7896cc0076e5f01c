"""Signatures: what the heat and wave equation promise."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, joined, moved, with_isolated

from geodesics import Mesh, SurfacePoints, eigenpairs, embedded, scale_invariant
from geodesics.signatures import (
    heat_kernel,
    heat_kernel_signature,
    resolved_times,
    scale_invariant_heat_kernel_signature,
    scaled_heat_kernel_signature,
)
from geodesics.wave_signature import wave_kernel_signature

TIMES = [1e-3, 1e-2, 0.1]
SIGNATURES = {
    "hks": lambda s: heat_kernel_signature(s, TIMES),
    "scaled": lambda s: scaled_heat_kernel_signature(s, TIMES),
    "si": scale_invariant_heat_kernel_signature,
    "wks": lambda s: wave_kernel_signature(s, 20),
}
each_signature = pytest.mark.parametrize("signature", SIGNATURES.values(), ids=SIGNATURES.keys())


@pytest.fixture(scope="module")
def mesh():
    return bumpy_sphere(2)


@pytest.fixture(scope="module")
def spectrum(mesh):
    return eigenpairs(embedded(mesh), mesh.n_vertices)


def full_kernel(spectrum, time):
    mesh = spectrum.mesh
    return heat_kernel(spectrum, time, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))


def test_heat_is_conserved(spectrum):
    np.testing.assert_allclose(full_kernel(spectrum, 0.01) @ spectrum.mass, 1, rtol=1e-9)


def test_semigroup(spectrum):
    """Flowing for s and then for t is flowing for s + t."""
    first, second = full_kernel(spectrum, 0.01), full_kernel(spectrum, 0.02)
    both = full_kernel(spectrum, 0.03)
    np.testing.assert_allclose(first * spectrum.mass @ second, both, rtol=1e-8, atol=1e-10 * both.max())


def test_at_time_zero_all_heat_is_at_the_source(spectrum):
    np.testing.assert_allclose(full_kernel(spectrum, 0) * spectrum.mass, np.eye(len(spectrum.mass)), atol=1e-9)


def test_heat_spreads_evenly_in_the_end(spectrum):
    np.testing.assert_allclose(full_kernel(spectrum, 10.0), 1 / spectrum.mass.sum(), rtol=1e-9)


def test_kernel_is_positive_and_symmetric(spectrum):
    """The maximum principle holds because intrinsic Delaunay edges have no negative weight."""
    kernel = full_kernel(spectrum, 1e-3)
    assert kernel.min() > -1e-12 * kernel.max()
    np.testing.assert_allclose(kernel, kernel.T, atol=1e-10 * kernel.max())


def test_heat_equation(spectrum):
    """d h / d t = -L h, by central differences (sec. 3)."""
    step, area = 1e-6, spectrum.mass.sum()
    slope = (full_kernel(spectrum, 0.01 + step) - full_kernel(spectrum, 0.01 - step)) / (2 * step * area)
    laplacian = (spectrum.eigenfunctions * spectrum.eigenvalues) @ (spectrum.eigenfunctions.T * spectrum.mass)
    np.testing.assert_allclose(slope, -laplacian @ full_kernel(spectrum, 0.01), rtol=1e-4, atol=1e-6 * abs(slope).max())


def test_kernel_at_points_on_faces_is_interpolated(spectrum, mesh):
    points = SurfacePoints(mesh, [3, 50], [[0.2, 0.3, 0.5], [1 / 3, 1 / 3, 1 / 3]])
    expected = points.interpolate(full_kernel(spectrum, 0.01))
    np.testing.assert_allclose(heat_kernel(spectrum, 0.01, points), expected, atol=1e-12)


def test_signature_is_the_diagonal_of_the_kernel(spectrum):
    expected = np.stack([np.diag(full_kernel(spectrum, t)) for t in TIMES], axis=1)
    np.testing.assert_allclose(heat_kernel_signature(spectrum, TIMES), expected, rtol=1e-10)


def test_integral_of_the_signature_is_the_heat_trace(spectrum):
    trace = np.exp(-np.outer(TIMES, spectrum.eigenvalues * spectrum.mass.sum())).sum(axis=1)
    np.testing.assert_allclose(spectrum.mass @ heat_kernel_signature(spectrum, TIMES), trace, rtol=1e-9)


def test_signature_falls_with_time(spectrum):
    signature = heat_kernel_signature(spectrum, np.geomspace(1e-4, 1, 20))
    assert np.all(np.diff(signature, axis=1) <= 1e-14 * signature.max())


def test_scaled_signature_integrates_to_one(spectrum):
    np.testing.assert_allclose(spectrum.mass @ scaled_heat_kernel_signature(spectrum, TIMES), 1, rtol=1e-12)


def test_short_time_signature_of_a_sphere_is_that_of_the_plane_plus_curvature():
    """h_t(s, s) = (1 + K t / 3 + ...) / (4 pi t); the term in K is 3 % of it at this time."""
    sphere = icosphere(4)
    spectrum = eigenpairs(embedded(sphere), 300)
    t = 0.1
    signature = heat_kernel_signature(spectrum, t / spectrum.mass.sum())[:, 0]
    np.testing.assert_allclose(signature * 4 * np.pi * t, 1 + t / 3 + t * t / 15, rtol=0.01)


@each_signature
def test_every_vertex_of_a_sphere_has_the_same_signature(signature):
    """Only if whole eigenspaces come out orthonormal: 25 = 1 + 3 + 5 + 7 + 9."""
    values = signature(eigenpairs(embedded(icosphere(3)), 25))
    np.testing.assert_allclose(values, np.broadcast_to(values.mean(axis=0), values.shape), rtol=0.05, atol=1e-3)


@each_signature
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_invariant_in_the_scale_invariant_metric(mesh, signature, scale):
    here = signature(eigenpairs(scale_invariant(mesh), 30))
    there = signature(eigenpairs(scale_invariant(moved(mesh, scale)), 30))
    np.testing.assert_allclose(there, here, rtol=1e-6, atol=1e-9)


def test_footnote_1_is_invariant_to_global_scale_in_the_embedded_metric(mesh):
    """With the same absolute times on both, up to what falls off the ends of the window."""
    a, b = eigenpairs(embedded(mesh), 100), eigenpairs(embedded(moved(mesh, 1.5)), 100)
    times = np.geomspace(1e-4, 10, 256)
    here = scale_invariant_heat_kernel_signature(a, times / a.mass.sum() * a.mass.sum(), 5)
    there = scale_invariant_heat_kernel_signature(b, times * a.mass.sum() / b.mass.sum(), 5)
    np.testing.assert_allclose(there, here, rtol=0.05, atol=0.01 * here.max())
    plain = heat_kernel_signature(a, times), heat_kernel_signature(b, times * a.mass.sum() / b.mass.sum())
    assert abs(plain[1] / plain[0] - 1).max() > 0.3


def test_slope_is_the_derivative_of_the_log(spectrum):
    """One frequency, the mean of d log HKS / d eta, telescopes to the difference of the ends."""
    times = np.geomspace(1e-3, 1e-1, 2001)
    ends = np.log(heat_kernel_signature(spectrum, times[[0, -1]]))
    mean_slope = abs(ends[:, 1] - ends[:, 0]) / np.log(100)
    signature = scale_invariant_heat_kernel_signature(spectrum, times, 1)[:, 0]
    np.testing.assert_allclose(signature, mean_slope, rtol=2e-3)


def test_wave_kernel_weights_sum_to_one(spectrum):
    """So its integral over the surface is 1 at every energy."""
    np.testing.assert_allclose(spectrum.mass @ wave_kernel_signature(spectrum, 30), 1, rtol=1e-9)


def test_wave_kernel_is_the_naive_sum(spectrum):
    log = np.log(spectrum.eigenvalues[1:])
    sigma = 7 * (log[-1] - log[0]) / (9 + 28)
    energy = log[0] + 2 * sigma
    weight = np.exp(-((energy - log) ** 2) / (2 * sigma**2))
    expected = (spectrum.eigenfunctions[:, 1:] ** 2 * weight).sum(axis=1) / weight.sum()
    np.testing.assert_allclose(wave_kernel_signature(spectrum, 10)[:, 0], expected, rtol=1e-9)


@each_signature
def test_nothing_non_finite(signature):
    for shape in (with_isolated(bumpy_sphere(1)), joined(icosphere(1), bumpy_sphere(1)), icosphere(0)):
        assert np.all(np.isfinite(signature(eigenpairs(embedded(shape), 12))))


def test_default_times_fit_the_spectrum(spectrum):
    times = resolved_times(spectrum, 5)
    faded = np.exp(-spectrum.eigenvalues[[-1, 1]] * spectrum.mass.sum() * times[[0, -1]])
    np.testing.assert_allclose(faded, 1e-4)


@pytest.mark.parametrize("times", [-1.0, [0.1, np.nan], [[1.0]]])
def test_bad_times_are_refused(spectrum, times):
    with pytest.raises(ValueError, match="times"):
        heat_kernel_signature(spectrum, times)


@pytest.mark.parametrize("time", [-1.0, np.nan, [0.1, 0.2], "a", None])
def test_a_kernel_has_one_time(spectrum, time):
    with pytest.raises(ValueError, match=r"time .*must be a finite number >= 0"):
        heat_kernel(spectrum, time, [0])


def test_there_are_no_more_frequencies_than_times(spectrum):
    assert scale_invariant_heat_kernel_signature(spectrum, [0.1, 0.2, 0.4], 3).shape[1] == 3
    with pytest.raises(ValueError, match="n_frequencies must be from 0 to 3"):
        scale_invariant_heat_kernel_signature(spectrum, [0.1, 0.2, 0.4])


def test_uneven_times_are_refused(spectrum):
    with pytest.raises(ValueError, match="constant factor"):
        scale_invariant_heat_kernel_signature(spectrum, [1.0, 2.0, 3.0])


def test_wave_kernel_of_repeated_eigenvalues_is_the_mean_of_the_squares():
    """A regular tetrahedron has one positive eigenvalue, three times: all energies are that one."""
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    spectrum = eigenpairs(Mesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]), 4)
    assert np.ptp(spectrum.eigenvalues[1:]) < 1e-9 * spectrum.eigenvalues[3]
    found = wave_kernel_signature(spectrum, 10)
    assert np.allclose(found, (spectrum.eigenfunctions[:, 1:] ** 2).mean(axis=1, keepdims=True), rtol=1e-6)


@pytest.mark.parametrize(
    "settings",
    [
        {"n_energies": [0.01, 0.1]},
        {"n_energies": 0},
        {"n_energies": 2.5},
        {"width": -1},
        {"width": 1e-320},
        {"width": [1, 2]},
    ],
    ids=repr,
)
def test_energies_and_widths_that_are_none_are_refused(spectrum, settings):
    with pytest.raises(ValueError, match="must be"):
        wave_kernel_signature(spectrum, **settings)
