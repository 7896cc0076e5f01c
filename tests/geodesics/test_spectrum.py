"""Eigenpairs: known spectra, multiplicities, and every kind of awkward mesh."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg
from generated_shapes import (
    bumpy_sphere,
    cube,
    disc,
    icosphere,
    joined,
    moved,
    rectangle,
    tetrahedron,
    torus,
    with_isolated,
)

import geodesics.linalg.factors
from geodesics import Mesh, Metric, eigenpairs, embedded, galerkin_mass, lumped_mass, scale_invariant, stiffness
from geodesics.errors import EigensolverFailed
from geodesics.linalg.dissection import nested_dissection
from geodesics.linalg.factors import Inverse, factorised
from geodesics.linalg.krylov import KrylovBasis
from geodesics.linalg.lanczos import smallest_eigenpairs
from geodesics.topology.components import boundary_vertices


def residual(metric, spectrum):
    """Of W phi = lambda M phi, in the norm of the mass, relative to lambda (to 1 / area for lambda = 0)."""
    phi, values, used = spectrum.eigenfunctions, spectrum.eigenvalues, spectrum.mass > 0
    rest = (stiffness(metric) @ phi - spectrum.mass[:, None] * phi * values)[used]
    size = np.linalg.norm(rest / np.sqrt(spectrum.mass[used])[:, None], axis=0)
    return size / np.maximum(values, 1 / spectrum.mass.sum())


def test_sphere_has_eigenvalues_l_times_l_plus_1_two_l_plus_1_times():
    spectrum = eigenpairs(embedded(icosphere(4)), 36)
    exact = np.repeat(np.arange(6) * (np.arange(6) + 1), 2 * np.arange(6) + 1)
    np.testing.assert_allclose(spectrum.eigenvalues, exact, rtol=0.02, atol=1e-9)
    split = [np.ptp(spectrum.eigenvalues[exact == value]) for value in np.unique(exact)]
    assert max(split[:3]) < 1e-6  # l = 1 and l = 2 are whole for the icosahedral group


def test_sphere_converges_with_the_square_of_the_edge():
    error = [abs(eigenpairs(embedded(icosphere(k)), 9).eigenvalues[4:9].mean() - 6) for k in (2, 3, 4)]
    assert 3.5 < error[0] / error[1] < 4.5 and 3.5 < error[1] / error[2] < 4.5


def test_first_eigenfunctions_of_the_sphere_are_the_coordinates():
    sphere = icosphere(4)
    spectrum = eigenpairs(embedded(sphere), 4)
    fit = np.linalg.lstsq(spectrum.eigenfunctions, sphere.vertices, rcond=None)[0]
    np.testing.assert_allclose(spectrum.eigenfunctions @ fit, sphere.vertices, atol=0.01)


def test_cube_has_eigenvalues_in_threes():
    """Every copy of a multiple eigenvalue is found, however symmetric the mesh; the dense solver agrees."""
    mesh = cube(12)
    spectrum = eigenpairs(embedded(mesh), 40)
    assert np.ptp(spectrum.eigenvalues[1:4]) < 1e-9 * spectrum.eigenvalues[1]
    np.testing.assert_allclose(spectrum.eigenvalues, dense(embedded(mesh))[:40], rtol=1e-7, atol=1e-9)


def dense(metric):
    root = 1 / np.sqrt(metric.mass)
    return np.linalg.eigvalsh(root[:, None] * stiffness(metric).toarray() * root)


@pytest.mark.parametrize("mesh", [torus(48, 24), bumpy_sphere(3), icosphere(3)], ids=["torus", "bumpy", "sphere"])
@pytest.mark.parametrize("count", [1, 10, 60])
def test_agrees_with_the_dense_solver(mesh, count):
    spectrum = eigenpairs(scale_invariant(mesh), count)
    np.testing.assert_allclose(spectrum.eigenvalues, dense(scale_invariant(mesh))[:count], rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize(
    ("neumann", "mass"), [(True, lumped_mass), (False, lumped_mass), (True, galerkin_mass), (False, galerkin_mass)]
)
def test_rectangle(neumann, mass):
    """pi^2 (i^2 / a^2 + j^2 / b^2): i, j from 0 with free boundary, from 1 when it is held fixed."""
    mesh = rectangle(40, 30, 4.0, 3.0)
    i, j = np.meshgrid(np.arange(12), np.arange(12))
    first = 0 if neumann else 1
    exact = np.sort((np.pi**2 * ((i + first) ** 2 / 16 + (j + first) ** 2 / 9)).ravel())[:12]
    fixed = None if neumann else boundary_vertices(mesh)
    spectrum = eigenpairs(embedded(mesh), 12, mass=mass, fixed=fixed)
    np.testing.assert_allclose(spectrum.eigenvalues, exact, rtol=0.03, atol=1e-9)
    if not neumann:
        assert np.all(spectrum.eigenfunctions[boundary_vertices(mesh)] == 0)
    product = spectrum.eigenfunctions.T @ mass(embedded(mesh)) @ spectrum.eigenfunctions
    np.testing.assert_allclose(product, np.eye(12), atol=1e-8)


def test_galerkin_eigenvalues_are_above_the_exact_ones_on_a_flat_square():
    """Min-max: the elements are a subspace. Lumping breaks the bound."""
    mesh = rectangle(24, 24)
    exact = np.sort(np.pi**2 * (np.arange(8)[:, None] ** 2 + np.arange(8) ** 2).ravel())[:10]
    values = eigenpairs(embedded(mesh), 10, mass=galerkin_mass).eigenvalues
    assert np.all(values >= exact - 1e-6) and np.all(values[1:] > exact[1:])
    assert eigenpairs(embedded(mesh), 10).eigenvalues[9] < values[9]


def test_disc_held_fixed_has_the_zeros_of_bessel_functions():
    mesh = disc(24)
    values = eigenpairs(embedded(mesh), 4, fixed=boundary_vertices(mesh)).eigenvalues
    np.testing.assert_allclose(values, np.array([2.404826, 3.831706, 3.831706, 5.135622]) ** 2, rtol=0.02)


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_any_unit_of_length(scale):
    mesh = bumpy_sphere(3)
    here, there = eigenpairs(embedded(mesh), 20), eigenpairs(embedded(moved(mesh, scale)), 20)
    np.testing.assert_allclose(there.eigenvalues * scale**2, here.eigenvalues, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(
        abs(there.eigenfunctions.T @ (there.mass[:, None] * there.eigenfunctions)), np.eye(20), atol=1e-9
    )
    np.testing.assert_allclose(abs(there.eigenfunctions[:, :6]) * scale, abs(here.eigenfunctions[:, :6]), atol=1e-4)


@pytest.mark.parametrize("metric", [embedded, scale_invariant])
def test_residual_and_orthonormality(metric):
    g = metric(bumpy_sphere(4))
    spectrum = eigenpairs(g, 100)
    assert residual(g, spectrum).max() < 1e-6
    gram = spectrum.eigenfunctions.T @ (g.mass[:, None] * spectrum.eigenfunctions)
    np.testing.assert_allclose(gram, np.eye(100), atol=1e-10)
    assert np.all(np.diff(spectrum.eigenvalues) >= 0)


def needle():
    """A thin tube, whose first eigenfunctions are those of an interval."""
    angle, z = np.arange(6) * np.pi / 3, np.linspace(0, 60, 1200)
    ring = 0.05 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.tile(ring, (1200, 1)), np.repeat(z, 6)[:, None]], axis=1)
    a = (6 * np.arange(1199)[:, None] + np.arange(6)).ravel()
    b = (6 * np.arange(1199)[:, None] + (np.arange(6) + 1) % 6).ravel()
    return Mesh(vertices, np.concatenate([np.stack([a, b, a + 6], 1), np.stack([b, b + 6, a + 6], 1)]))


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize(
    "make", [lambda: bumpy_sphere(4), lambda: icosphere(4), needle], ids=["bumpy", "sphere", "needle"]
)
def test_residuals_are_within_the_tolerance(make, tolerance):
    """Also those of multiple eigenvalues, and of spectra that do not grow as those of surfaces do."""
    for metric in (embedded(make()), scale_invariant(make())):
        spectrum = eigenpairs(metric, 120, tolerance=tolerance)
        assert residual(metric, spectrum).max() <= tolerance
        gram = spectrum.eigenfunctions.T @ (metric.mass[:, None] * spectrum.eigenfunctions)
        np.testing.assert_allclose(gram, np.eye(120), atol=1e-12)


def test_exact_eigenvalues_are_those_of_arpack():
    metric = scale_invariant(bumpy_sphere(4))
    start = np.random.default_rng(0).standard_normal(metric.mesh.n_vertices)
    mass = sp.diags(metric.mass).tocsc()
    values = scipy.sparse.linalg.eigsh(stiffness(metric).tocsc(), 100, mass, sigma=-1e-2, v0=start, which="LM")[0]
    np.testing.assert_allclose(
        eigenpairs(metric, 100, tolerance=1e-10).eigenvalues, np.sort(values), rtol=1e-11, atol=1e-9
    )


@pytest.mark.parametrize("large", [0, 10**9])
@pytest.mark.parametrize("columns", [1, 3, 8, 20])
def test_inverse_of_a_sparse_matrix(columns, large, monkeypatch):
    """One substitution for eight columns does what the dense solver does for each, in either order of elimination."""
    monkeypatch.setattr(geodesics.linalg.factors, "LARGE", large)
    metric = embedded(joined(bumpy_sphere(3), icosphere(2)))
    matrix = (stiffness(metric) + sp.diags(metric.mass)).tocsc()
    block = np.random.default_rng(0).standard_normal((matrix.shape[0], columns))
    given = block.copy()
    factors = factorised(matrix)
    exact = np.linalg.solve(matrix.toarray(), block)
    np.testing.assert_allclose(Inverse(factors).solve(block), exact, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(factors.solve(block), exact, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(factors.solve(block[:, 0]), exact[:, 0], rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(block, given)


def test_nested_dissection_fills_little():
    """Every row once; on a grid hardly more entries than minimum degree makes, and far fewer than row by row."""
    matrix = (stiffness(embedded(rectangle(100, 100))) + sp.identity(101**2)).tocsc()
    order = nested_dissection(matrix)
    np.testing.assert_array_equal(np.sort(order), np.arange(101**2))

    def entries(matrix, **settings):
        options = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        return scipy.sparse.linalg.splu(matrix, **options, **settings).nnz

    dissected = entries(matrix[order][:, order], permc_spec="NATURAL")
    assert dissected < 1.6 * entries(matrix, permc_spec="MMD_AT_PLUS_A")
    assert dissected < 0.5 * entries(matrix, permc_spec="NATURAL")


def test_repeatable():
    g = scale_invariant(bumpy_sphere(3))
    a, b = eigenpairs(g, 30), eigenpairs(scale_invariant(Mesh(g.mesh.vertices, g.mesh.faces)), 30)
    np.testing.assert_array_equal(a.eigenfunctions, b.eigenfunctions)


@pytest.mark.parametrize("copies", [2, 9])
def test_equal_components_repeat_every_eigenvalue(copies):
    one = eigenpairs(embedded(icosphere(3)), 10)
    g = embedded(joined(*[icosphere(3)] * copies))
    spectrum = eigenpairs(g, 10 * copies)
    np.testing.assert_allclose(spectrum.eigenvalues, np.repeat(one.eigenvalues, copies), rtol=1e-6, atol=1e-9)
    assert residual(g, spectrum).max() < 1e-6


def test_isolated_vertices_have_zero_rows():
    plain, mesh = bumpy_sphere(3), with_isolated(bumpy_sphere(3))
    a, b = eigenpairs(embedded(plain), 20), eigenpairs(embedded(mesh), 20)
    np.testing.assert_allclose(a.eigenvalues, b.eigenvalues, atol=1e-7)
    lonely = np.setdiff1d(np.arange(mesh.n_vertices), mesh.faces)
    assert len(lonely) == 3 and np.all(b.eigenfunctions[lonely] == 0)


@pytest.mark.parametrize(
    "mesh", [Mesh(np.eye(3), [[0, 1, 2]]), tetrahedron(), rectangle(1, 1)], ids=["one", "tetra", "two"]
)
def test_tiny_meshes_give_what_they_have(mesh):
    spectrum = eigenpairs(embedded(mesh), 50)
    assert spectrum.eigenfunctions.shape == (mesh.n_vertices, mesh.n_vertices)
    assert spectrum.eigenvalues[0] == pytest.approx(0, abs=1e-9)
    assert residual(embedded(mesh), spectrum).max() < 1e-9


def test_everything_fixed_gives_nothing():
    mesh = tetrahedron()
    assert eigenpairs(embedded(mesh), 3, fixed=np.ones(4, dtype=bool)).eigenvalues.shape == (0,)


def test_slivers():
    """A sphere squeezed until its faces are needles; intrinsic Delaunay keeps residual and sign."""
    mesh = icosphere(3)
    squeezed = Mesh(mesh.vertices * [1, 1, 1e-4], mesh.faces)
    spectrum = eigenpairs(embedded(squeezed), 20)
    assert residual(embedded(squeezed), spectrum).max() < 1e-6
    # two discs back to back: eigenvalues of the disc, free and fixed alternately; j'_11 = 1.8412, twice
    np.testing.assert_allclose(spectrum.eigenvalues[1:3], 1.8412**2, rtol=0.05)


def test_needles_inside_a_good_mesh_do_not_disturb_it():
    mesh = bumpy_sphere(3)
    v, f = mesh.vertices, mesh.faces
    a, b, c = v[f[0]]
    new = np.vstack([v, (a + b) / 2 + 1e-7 * (c - (a + b) / 2)])
    k = len(v)
    faces = np.vstack([f[1:], [[f[0, 0], f[0, 1], k], [f[0, 1], f[0, 2], k], [f[0, 2], f[0, 0], k]]])
    spectrum = eigenpairs(embedded(Mesh(new, faces)), 20)
    np.testing.assert_allclose(spectrum.eigenvalues, eigenpairs(embedded(mesh), 20).eigenvalues, rtol=2e-3, atol=1e-6)


def test_not_finite_is_a_typed_error():
    mesh = icosphere(2)
    metric = Metric(mesh, np.full((mesh.n_faces, 3), np.nan), np.ones(mesh.n_vertices))
    with pytest.raises(EigensolverFailed, match="E402"):
        eigenpairs(metric, 5)


def test_collapsed_faces_are_a_typed_error() -> None:
    mesh = bumpy_sphere(3)
    around = embedded(mesh)
    mass = around.mass.copy()
    mass[5] = 1e-300  # as of faces whose corners have all but met
    with pytest.raises(EigensolverFailed, match=r"E402.*coordinates too coarse"):
        eigenpairs(Metric(mesh, around.l_sq, mass, None), 30)


def test_count_below_one_is_refused():
    with pytest.raises(ValueError, match="count"):
        eigenpairs(embedded(tetrahedron()), 0)


def test_lanczos_on_a_matrix_with_few_distinct_eigenvalues():
    """The Krylov space ends long before there are enough vectors; the missing copies still come."""
    n = 1200
    rng = np.random.default_rng(0)
    blocks = [scipy.linalg.qr(rng.standard_normal((6, 6)))[0] for _ in range(n // 6)]
    parts = [sp.csr_matrix(q @ np.diag([0.0, 1, 1, 2, 2, 3]) @ q.T) for q in blocks]
    chain = sp.diags([np.full(n - 1, -1e-13), np.full(n - 1, -1e-13)], [-1, 1])  # linked, but hardly
    values, vectors = smallest_eigenpairs((sp.block_diag(parts) + chain).tocsc(), 250, shift=1e-2)
    np.testing.assert_allclose(values, np.repeat([0, 1], [200, 50]), atol=1e-7)
    np.testing.assert_allclose(vectors.T @ vectors, np.eye(250), atol=1e-9)


def test_a_krylov_basis_stays_orthonormal_when_it_outgrows_its_first_room():
    matrix = np.diag(np.linspace(0, 1, 300)) + 1e-3 * np.ones((300, 300))
    krylov = KrylovBasis(300, 4, 120, 1e-9)
    while krylov.room():
        krylov.grow(matrix @ krylov.last)
    assert krylov.size == 120
    values, coordinates, rest = krylov.ritz(0, 5)
    vectors = krylov.vectors(values, coordinates, rest)
    np.testing.assert_allclose(vectors.T @ vectors, np.eye(5), atol=1e-9)
    np.testing.assert_allclose(values, np.linalg.eigvalsh(matrix)[::-1][:5], atol=1e-4)
