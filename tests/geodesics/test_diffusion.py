"""Diffusion, commute-time and biharmonic distances."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, joined, moved, with_isolated

from geodesics import SurfacePoints, eigenpairs, embedded, lumped_mass, scale_invariant, stiffness
from geodesics.diffusion import BiharmonicDistance, CommuteTimeDistance, DiffusionDistance

DISTANCES = {
    "diffusion": lambda spectrum: DiffusionDistance(spectrum, 0.03),
    "commute": CommuteTimeDistance,
    "biharmonic": BiharmonicDistance,
}
each_distance = pytest.mark.parametrize("make", DISTANCES.values(), ids=DISTANCES.keys())


def every_vertex(mesh):
    return SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))


@pytest.fixture(scope="module")
def bumpy():
    return bumpy_sphere(2)


@pytest.fixture(scope="module")
def spectrum(bumpy):
    return eigenpairs(embedded(bumpy), bumpy.n_vertices - 2)


@each_distance
def test_metric_axioms(bumpy, spectrum, make):
    d = make(spectrum).field(every_vertex(bumpy))
    assert np.all(np.diag(d) == 0)
    np.testing.assert_allclose(d, d.T, rtol=1e-9, atol=0)
    assert np.all(d + 10 * np.eye(len(d)) * d.max() > 0)
    through = d[:40, :, None] + d[None, :, :40]
    assert np.all(through.min(axis=1) >= d[:40, :40] * (1 - 1e-12))


@each_distance
def test_between_vertices_it_is_the_distance_of_interpolated_rows(bumpy, spectrum, make):
    distance = make(spectrum)
    rng = np.random.default_rng(0)
    points = SurfacePoints(bumpy, rng.integers(0, bumpy.n_faces, 300), rng.dirichlet(np.ones(3), 300))
    rows = points.interpolate(distance.embedding)
    naive = np.linalg.norm(rows[:, None] - distance.embedding[None], axis=2)
    np.testing.assert_allclose(distance.field(points), naive, rtol=1e-9)


def test_diffusion_distance_is_the_difference_of_two_heat_profiles(bumpy, spectrum):
    """(3.1): the L2 distance of the heat flows that start at the two points, here by the dense matrix exponential."""
    metric = embedded(bumpy)
    root = 1 / np.sqrt(metric.mass)
    values, vectors = np.linalg.eigh(root[:, None] * stiffness(metric).toarray() * root)
    kernel = (root[:, None] * vectors) * np.exp(-0.01 * metric.mass.sum() * values) @ (root[:, None] * vectors).T
    difference = kernel[:5, None, :] - kernel[None, :, :]
    expected = np.sqrt((difference**2 * metric.mass).sum(axis=2))
    d = DiffusionDistance(spectrum, 0.01).field(SurfacePoints.at_vertices(bumpy, np.arange(5)))
    np.testing.assert_allclose(d, expected, rtol=1e-6, atol=1e-7 * expected.max())


def test_commute_time_is_the_effective_resistance(bumpy):
    """d^2 = (e_s - e_s')^T W^+ (e_s - e_s') / 2, from the pseudo-inverse."""
    metric = embedded(bumpy)
    full = eigenpairs(metric, bumpy.n_vertices)
    inverse = np.linalg.pinv(stiffness(metric).toarray(), hermitian=True)
    diagonal = np.diag(inverse)
    expected = np.sqrt(np.maximum((diagonal[:, None] + diagonal - 2 * inverse) / 2, 0))
    d = CommuteTimeDistance(full).field(every_vertex(bumpy))
    np.testing.assert_allclose(d, expected, rtol=1e-6, atol=1e-6)


def test_biharmonic_solves_the_laplacian_twice(bumpy):
    """d^2 = difference of the Green function of the squared Laplacian, W^+ M W^+ up to constants."""
    metric = embedded(bumpy)
    full = eigenpairs(metric, bumpy.n_vertices)
    s, t = 3, 77
    source = np.zeros(bumpy.n_vertices)
    source[[s, t]] = 1, -1
    green = np.linalg.pinv(stiffness(metric).toarray(), hermitian=True) @ source
    green -= (green * metric.mass).sum() / metric.mass.sum()
    expected = np.sqrt(green @ (lumped_mass(metric) @ green))
    d = BiharmonicDistance(full).field(SurfacePoints.at_vertices(bumpy, [s]))[0, t]
    assert d == pytest.approx(expected, rel=1e-6)


@each_distance
@pytest.mark.parametrize("scale", [1e-6, 1e-2, 1e6])
def test_invariant_in_the_scale_invariant_metric(bumpy, make, scale):
    points = np.arange(0, bumpy.n_vertices, 10)
    here = make(eigenpairs(scale_invariant(bumpy), 30)).field(SurfacePoints.at_vertices(bumpy, points))
    other = moved(bumpy, scale)
    there = make(eigenpairs(scale_invariant(other), 30)).field(SurfacePoints.at_vertices(other, points))
    np.testing.assert_allclose(there, here, rtol=1e-6, atol=1e-9 * here.max())


@pytest.mark.parametrize(
    ("make", "power"), [(DISTANCES["diffusion"], -1), (CommuteTimeDistance, 0), (BiharmonicDistance, 1)]
)
def test_units_in_the_embedded_metric(bumpy, make, power):
    here = make(eigenpairs(embedded(bumpy), 30)).field(SurfacePoints.at_vertices(bumpy, [0]))
    other = moved(bumpy, 1e3)
    there = make(eigenpairs(embedded(other), 30)).field(SurfacePoints.at_vertices(other, [0]))
    np.testing.assert_allclose(there, here * 1e3**power, rtol=1e-6, atol=1e-9 * here.max() * 1e3**power)


@each_distance
def test_a_sphere_looks_the_same_from_everywhere(make):
    """Antipodes are farthest, and the profile depends on the angle only, although eigenspaces are degenerate."""
    sphere = icosphere(3)
    vertices = [0, 5, 11]
    d = make(eigenpairs(embedded(sphere), 36)).field(SurfacePoints.at_vertices(sphere, vertices))
    for row, v in zip(d, vertices, strict=True):
        assert sphere.vertices[row.argmax()] @ sphere.vertices[v] == pytest.approx(-1)
    profiles = d[np.arange(3)[:, None], np.argsort(sphere.vertices[vertices] @ sphere.vertices.T, axis=1)]
    np.testing.assert_allclose(profiles[0], profiles[1], atol=0.02 * d.max())


@each_distance
def test_components_are_infinitely_far_apart(make):
    mesh = joined(bumpy_sphere(1), icosphere(1))
    n = mesh.n_vertices // 2
    d = make(eigenpairs(embedded(mesh), 12)).field(SurfacePoints.at_vertices(mesh, [0, n]))
    assert np.all(np.isfinite(d) == (np.arange(2 * n) < n)[None] ^ np.array([[False], [True]]))
    assert d[np.isfinite(d)].max() < 10


@each_distance
def test_isolated_vertices_are_unreachable(make):
    mesh = with_isolated(bumpy_sphere(1))
    d = make(eigenpairs(embedded(mesh), 12)).field(SurfacePoints.at_vertices(mesh, [1]))
    assert np.flatnonzero(~np.isfinite(d[0])).tolist() == [0, mesh.n_vertices // 2, mesh.n_vertices - 1]


def test_negative_time_is_refused(spectrum):
    with pytest.raises(ValueError, match="time"):
        DiffusionDistance(spectrum, -1)


@each_distance
def test_points_on_vertices_and_blocks_agree(bumpy, spectrum, make):
    """More points than one block: the same rows as one at a time."""
    distance = make(spectrum)
    points = SurfacePoints.at_vertices(bumpy, np.resize(np.arange(bumpy.n_vertices), 600))
    assert len(points) == 600
    np.testing.assert_allclose(distance.field(points)[[0, 300, 599]], distance.field(points[[0, 300, 599]]), rtol=1e-9)
