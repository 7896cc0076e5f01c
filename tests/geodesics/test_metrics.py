"""Every metric in `metrics.ALL` through the same tests; then what each one promises."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import (
    bumpy_sphere,
    cylinder,
    ellipsoid,
    grid,
    icosphere,
    joined,
    moved,
    rectangle,
    tetrahedron,
    torus,
    with_isolated,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from geodesics import Mesh, MeshError, eigenpairs, embedded, intrinsic, scale_invariant, stiffness
from geodesics.metrics import (
    ALL,
    affine,
    curvature_ratio_length,
    equi_affine,
    first_curvature_length,
    gaussian_curvature_length,
    min_curvature,
    second_curvature_length,
)

each_metric = pytest.mark.parametrize("metric", ALL, ids=lambda f: f.__name__)
UNITS = {embedded: 2.0, equi_affine: 1.5}  # power of length in l_sq; 0 for the scale-invariant ones
SHAPES = {
    "bumpy": bumpy_sphere(2),
    "torus": torus(24, 12),
    "flat": rectangle(6, 6),
    "cylinder": cylinder(16, 6),
    "two": joined(icosphere(1), bumpy_sphere(1)),
    "isolated": with_isolated(icosphere(2)),
    "one face": Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    "needle": Mesh([[0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0], [0.5, 1, 0]], [[0, 1, 2], [0, 2, 3], [2, 1, 3]]),
    "coincident": Mesh([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0.5, 1, 0]], [[0, 1, 2], [0, 2, 3], [2, 1, 3]]),
    "three on an edge": Mesh(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
    ),
    "moebius": Mesh(
        np.random.default_rng(0).standard_normal((5, 3)), [[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]]
    ),
}


@each_metric
@pytest.mark.parametrize("mesh", SHAPES.values(), ids=SHAPES.keys())
def test_is_a_metric(mesh, metric):
    """Lengths that make triangles, a mass where there are faces, an operator with eigenpairs; finite on anything."""
    g = metric(mesh)
    assert g.mesh is mesh and g.l_sq.shape == (mesh.n_faces, 3) and g.mass.shape == (mesh.n_vertices,)
    assert np.all(np.isfinite(g.l_sq)) and np.all(g.l_sq >= 0)
    length = np.sort(np.sqrt(g.l_sq), axis=1)
    assert np.all(length[:, 2] <= (length[:, 0] + length[:, 1]) * (1 + 1e-6))
    used = np.zeros(mesh.n_vertices, dtype=bool)
    used[mesh.faces] = True
    assert np.all(np.isfinite(g.mass)) and np.all(g.mass[used] > 0) and np.all(g.mass[~used] == 0)
    spectrum = eigenpairs(g, 4)
    assert np.all(np.isfinite(spectrum.eigenfunctions)) and spectrum.eigenvalues[0] * g.mass.sum() < 1e-6


@each_metric
@pytest.mark.parametrize("scale", [1e-6, 1e-2, 1e2, 1e6])
def test_global_scale_and_rigid_motion(metric, scale):
    """Theorem 2.1: lengths and mass do not change at all, or by the power of the unit that the metric has."""
    mesh = SHAPES["bumpy"]
    here, there = metric(mesh), metric(moved(mesh, scale))
    unit = scale ** UNITS.get(metric, 0.0)
    np.testing.assert_allclose(there.l_sq, here.l_sq * unit, rtol=1e-6)
    np.testing.assert_allclose(there.mass, here.mass * unit, rtol=1e-6)


@each_metric
def test_order_of_vertices_and_faces_does_not_matter(metric):
    mesh = SHAPES["bumpy"]
    rng = np.random.default_rng(0)
    vertex, face = rng.permutation(mesh.n_vertices), rng.permutation(mesh.n_faces)
    back = np.argsort(vertex)
    here, there = metric(mesh), metric(Mesh(mesh.vertices[vertex], np.roll(back[mesh.faces[face]], 1, axis=1)))
    np.testing.assert_allclose(there.mass, here.mass[vertex], rtol=1e-6)
    np.testing.assert_allclose(there.l_sq, np.roll(here.l_sq[face], 1, axis=1), rtol=1e-6)


@each_metric
def test_mirror_image_measures_the_same(metric):
    mesh = SHAPES["bumpy"]
    here, there = metric(mesh), metric(Mesh(mesh.vertices * [-1, 1, 1], mesh.faces))
    np.testing.assert_allclose(there.l_sq, here.l_sq, rtol=1e-6)


@each_metric
def test_on_a_sphere_it_is_the_embedded_one_times_a_constant(metric):
    sphere = icosphere(4)
    ratio = metric(sphere).mass / embedded(sphere).mass
    np.testing.assert_allclose(ratio, np.broadcast_to(ratio.mean(), ratio.shape), rtol=0.1)


@each_metric
def test_input_is_left_alone(metric):
    mesh = bumpy_sphere(1)
    before = mesh.vertices.copy(), mesh.faces.copy()
    metric(mesh)
    np.testing.assert_array_equal(mesh.vertices, before[0])
    np.testing.assert_array_equal(mesh.faces, before[1])


def test_unit_sphere_keeps_its_size_in_the_scale_invariant_metric():
    """|K| = 1; with eps = 1 the factor is sqrt 2, whatever the radius."""
    sphere = icosphere(4, radius=3.0)
    np.testing.assert_allclose(scale_invariant(sphere, regularisation=0).mass.sum(), 4 * np.pi, rtol=0.01)
    np.testing.assert_allclose(scale_invariant(sphere).mass.sum(), 4 * np.pi * np.sqrt(2), rtol=0.01)


@pytest.mark.parametrize("exponent", [0.0, 0.3, 1.0])
def test_exponent_interpolates(exponent):
    """|K|^a g from the embedded metric (a = 0) to the scale-invariant one (a = 1)."""
    mesh = bumpy_sphere(2)
    full, part = scale_invariant(mesh), scale_invariant(mesh, exponent=exponent)
    assert full.conformal_factor is not None and part.conformal_factor is not None
    np.testing.assert_allclose(part.conformal_factor, full.conformal_factor**exponent)
    np.testing.assert_allclose(part.mass, part.conformal_factor * embedded(mesh).mass)


def test_conformal_metrics_have_the_embedded_stiffness():
    mesh = bumpy_sphere(2)
    for metric in ALL:
        if metric(mesh).conformal_factor is not None:
            np.testing.assert_array_equal(stiffness(metric(mesh)).toarray(), stiffness(embedded(mesh)).toarray())


def test_embedded_measures_area():
    mesh = SHAPES["torus"]
    assert embedded(mesh).mass.sum() == pytest.approx(intrinsic.areas(embedded(mesh).l_sq).sum())


def bent_sphere_patch(c, n=40):
    """Part of a surface of revolution with K = 1 everywhere: profile c cos u, angle v / c; c = 1 is the unit sphere.

    All c give the same lengths on the surface (isometric bending), and other principal curvatures.
    """
    u, v, faces = grid(n, n)
    u, v = 1.2 * (u - 0.5), 1.2 * (v - 0.5)
    fine = np.linspace(-0.6, 0.6, 4001)
    slope = np.sqrt(1 - (c * np.sin(fine)) ** 2)
    height = np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(fine))])
    r, z = c * np.cos(u), np.interp(u, fine, height)
    return Mesh(np.stack([r * np.cos(v / c), r * np.sin(v / c), z], axis=1), faces)


LENGTHS = (first_curvature_length, second_curvature_length, curvature_ratio_length, gaussian_curvature_length)


@pytest.mark.parametrize("metric", [*LENGTHS, min_curvature, scale_invariant], ids=lambda f: f.__name__)
def test_only_the_gaussian_curvature_survives_isometric_bending(metric):
    """Sec. 2: of the four arc lengths, sqrt|K| ds alone is also invariant to isometries."""
    straight, bent = (metric(bent_sphere_patch(c), regularisation=0.1).conformal_factor for c in (1.0, 0.6))
    inner = np.abs(np.stack(grid(40, 40)[:2]) - 0.5).max(axis=0) < 0.3
    change = np.median(np.abs(np.log(bent / straight))[inner])
    if metric in (gaussian_curvature_length, scale_invariant):
        assert change < 0.02
    else:
        assert change > 0.1


def test_bent_patches_are_isometric():
    """The claim behind the test above."""
    a, b = (intrinsic.squared_lengths(m.vertices, m.faces) for m in (bent_sphere_patch(1.0), bent_sphere_patch(0.6)))
    np.testing.assert_allclose(a, b, rtol=2e-3)


def test_arc_lengths_on_a_cylinder():
    """k1 and k2 are 1 / r and 0: one of the first two lengths is d s / r, the others are the regularisation only."""
    mesh = cylinder(64, 32, radius=0.5)
    middle = abs(mesh.vertices[:, 2] - 1) < 0.5
    factor = {f: f(mesh, regularisation=1e-3).conformal_factor[middle] for f in (*LENGTHS, min_curvature)}
    sharp = np.maximum(factor[first_curvature_length], factor[second_curvature_length])
    np.testing.assert_allclose(sharp, 4, rtol=0.05)
    for f in (curvature_ratio_length, gaussian_curvature_length, min_curvature):
        assert factor[f].max() < 0.05


def test_min_curvature_is_equation_7_1():
    """kappa_min^2 = (sqrt(H^2 - K) - |H|)^2 on a torus, where K changes sign."""
    from geodesics import gaussian_curvature
    from geodesics.curvature import mean_curvature

    mesh = torus()
    h, k = mean_curvature(mesh), gaussian_curvature(mesh)
    root = np.sqrt(np.maximum(h**2 - k, 0))
    expected = (root - abs(h)) ** 2
    np.testing.assert_allclose(min_curvature(mesh, regularisation=0).conformal_factor, expected, rtol=1e-6, atol=1e-9)


UNIMODULAR = np.array([[1.3, 0.4, 0.0], [0.0, 0.8, 0.3], [0.2, 0.0, 1.0]])
UNIMODULAR /= np.cbrt(np.linalg.det(UNIMODULAR))


def change(metric, mesh, transform):
    """Mean relative change of areas of faces, and of the first eigenvalues, under a linear map."""
    here, there = metric(mesh), metric(Mesh(mesh.vertices @ transform.T, mesh.faces))
    a, b = eigenpairs(here, 12).eigenvalues[1:], eigenpairs(there, 12).eigenvalues[1:]
    return np.mean(abs(there.mass / here.mass - 1)), np.mean(abs(b / a - 1))


@pytest.mark.parametrize(("subdivisions", "bound"), [(3, 0.03), (4, 0.015)])
def test_equi_affine_under_a_unimodular_map(subdivisions, bound):
    mesh = ellipsoid(subdivisions, (1.0, 1.1, 1.2))
    assert max(change(equi_affine, mesh, UNIMODULAR)) < bound
    assert max(change(embedded, mesh, UNIMODULAR)) > 0.1


@pytest.mark.parametrize("scale", [0.1, 1.0, 10.0])
def test_affine_under_any_linear_map(scale):
    mesh = ellipsoid(4, (1.0, 1.1, 1.2))
    area, eigen = change(affine, mesh, scale * UNIMODULAR)
    assert area < 0.04 and eigen < 0.02
    assert max(change(embedded, mesh, scale * UNIMODULAR)) > 0.1


def test_equi_affine_metric_of_an_ellipsoid_is_that_of_a_sphere():
    """The ellipsoid with half axes a, b, c is a unimodular image of the sphere of radius r = (a b c)^(1/3).

    There b_ij = g_ij / r and K = 1 / r^2: the metric is r^(-1/2) g, eigenvalues l (l + 1) r^(-3/2), area 4 pi r^(3/2).
    """
    g = equi_affine(ellipsoid(4, (1.0, 1.4, 2.0)))
    r = (1.0 * 1.4 * 2.0) ** (1 / 3)
    assert g.mass.sum() == pytest.approx(4 * np.pi * r**1.5, rel=0.02)
    np.testing.assert_allclose(eigenpairs(g, 9).eigenvalues * r**1.5, [0, 2, 2, 2, 6, 6, 6, 6, 6], rtol=0.04, atol=1e-9)


def test_affine_metric_keeps_its_eigenvalues_when_the_mesh_is_refined():
    """Curvature of the equi-affine metric is four derivatives of position: smoothed enough, it still converges."""
    coarse, fine = (eigenpairs(affine(bumpy_sphere(k)), 8).eigenvalues[1:] for k in (3, 4))
    np.testing.assert_allclose(coarse, fine, rtol=0.1)


def test_affine_metric_of_an_ellipsoid_is_that_of_the_unit_sphere():
    g = affine(ellipsoid(4, (1.0, 1.4, 2.0)), regularisation=1e-3)
    assert g.mass.sum() == pytest.approx(4 * np.pi, rel=0.05)
    np.testing.assert_allclose(eigenpairs(g, 4).eigenvalues, [0, 2, 2, 2], rtol=0.08, atol=1e-9)


@st.composite
def soups(draw):
    """Any faces over a few vertices on a coarse lattice: coincident points, copies, fans of faces on one edge."""
    n = draw(st.integers(3, 9))
    points = draw(st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=n, max_size=n))
    faces = draw(st.lists(st.tuples(*[st.integers(0, n - 1)] * 3), min_size=1, max_size=14))
    scale = draw(st.sampled_from([1e-6, 1.0, 1e6]))
    try:
        return Mesh(scale * np.array(points, dtype=float), faces)
    except MeshError:
        return tetrahedron()


@settings(max_examples=60, deadline=None, derandomize=True)
@given(mesh=soups(), metric=st.sampled_from(ALL))
def test_nothing_crashes_and_all_is_finite_on_a_soup_of_triangles(mesh, metric):
    g = metric(mesh)
    assert np.all(np.isfinite(g.l_sq)) and np.all(np.isfinite(g.mass)) and np.all(g.mass >= 0)
    spectrum = eigenpairs(g, 5)
    assert np.all(np.isfinite(spectrum.eigenvalues)) and np.all(np.isfinite(spectrum.eigenfunctions))
    assert np.all(spectrum.eigenvalues >= 0)
