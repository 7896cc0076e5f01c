"""Finite elements: against the formulas of the paper, exact integrals, and other libraries."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from generated_shapes import (
    bumpy_sphere,
    cylinder,
    disc,
    icosphere,
    joined,
    rectangle,
    tetrahedron,
    torus,
    with_isolated,
)

from geodesics import Mesh, Metric, embedded, galerkin_mass, intrinsic, lumped_mass, scale_invariant, stiffness
from geodesics.delaunay import IntrinsicTriangulation, intrinsic_delaunay
from geodesics.intrinsic import vertex_areas
from geodesics.laplacian import cotangent_matrix, tensor_stiffness
from geodesics.metric import conformal
from geodesics.one_ring import cotangent_operator, one_ring_curvature

SHAPES = {
    "bumpy": bumpy_sphere(2),
    "torus": torus(),
    "disc": disc(6),
    "cylinder": cylinder(),
    "two": joined(icosphere(1), rectangle(3, 4)),
    "isolated": with_isolated(icosphere(1)),
}
each_shape = pytest.mark.parametrize("mesh", SHAPES.values(), ids=SHAPES.keys())


def own_faces(mesh):
    return IntrinsicTriangulation(mesh.faces, intrinsic.squared_lengths(mesh.vertices, mesh.faces))


def random_tensors(m, seed=0):
    factor = np.random.default_rng(seed).standard_normal((m, 2, 2))
    return factor @ factor.transpose(0, 2, 1) + 0.1 * np.eye(2)


@each_shape
@pytest.mark.parametrize("metric", [embedded, scale_invariant])
def test_stiffness_is_positive_semidefinite_with_constants_in_its_kernel(mesh, metric):
    w = stiffness(metric(mesh)).toarray()
    np.testing.assert_allclose(w, w.T, atol=1e-12)
    np.testing.assert_allclose(w.sum(axis=1), 0, atol=1e-10)
    values = np.linalg.eigvalsh(w)
    assert values[0] > -1e-10
    assert np.count_nonzero(values < 1e-9) == {"two": 2, "isolated": 4}.get(_name(mesh), 1)


def _name(mesh):
    return next(name for name, shape in SHAPES.items() if shape is mesh)


@each_shape
def test_on_delaunay_edges_no_weight_is_negative(mesh):
    off = stiffness(embedded(mesh)).tocoo()
    assert off.data[off.row != off.col].max() < 1e-12


@each_shape
def test_dirichlet_energy_of_a_coordinate_is_exact(mesh):
    """Linear elements are exact on linear functions: the energies of x, y, z add up to twice the area."""
    w = cotangent_matrix(own_faces(mesh), mesh.n_vertices)
    energy = sum(x @ w @ x for x in mesh.vertices.T)
    assert energy == pytest.approx(2 * embedded(mesh).mass.sum(), rel=1e-9)


def test_stiffness_of_one_triangle_to_the_letter():
    """Right isosceles: cot 45 = 1, cot 90 = 0, so W = [[1, -1/2, -1/2], [-1/2, 1/2, 0], [-1/2, 0, 1/2]]."""
    mesh = Mesh([[0, 0, 0], [3, 0, 0], [0, 3, 0]], [[0, 1, 2]])
    np.testing.assert_allclose(
        stiffness(embedded(mesh)).toarray(), [[1, -0.5, -0.5], [-0.5, 0.5, 0], [-0.5, 0, 0.5]], atol=1e-12
    )


def test_tensor_form_of_4_4_equals_the_cotangents_of_its_lengths():
    mesh = torus(12, 8)
    tensor = random_tensors(mesh.n_faces)
    by_tensor = tensor_stiffness(mesh.faces, tensor, mesh.n_vertices)
    l_sq = intrinsic.lengths_from_tensor(tensor)
    by_lengths = cotangent_matrix(IntrinsicTriangulation(mesh.faces, l_sq), mesh.n_vertices)
    np.testing.assert_allclose(by_tensor.toarray(), by_lengths.toarray(), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(stiffness(Metric(mesh, l_sq, np.ones(mesh.n_vertices))).toarray(), by_lengths.toarray())


def test_lengths_and_tensors_say_the_same():
    tensor = random_tensors(100)
    np.testing.assert_allclose(intrinsic.tensor_from_lengths(intrinsic.lengths_from_tensor(tensor)), tensor)
    mesh = bumpy_sphere(1)
    l_sq = own_faces(mesh).l_sq
    g = intrinsic.tensor_from_lengths(l_sq)
    np.testing.assert_allclose(0.5 * np.sqrt(np.linalg.det(g)), intrinsic.areas(l_sq))
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    np.testing.assert_allclose(g[:, 0, 1], ((b - a) * (c - a)).sum(axis=1))


def test_conformal_invariance_of_the_dirichlet_energy():
    """One slowness a face leaves the stiffness of (4.4) as it is."""
    mesh = bumpy_sphere(2)
    faces, l_sq = own_faces(mesh)
    scaled = l_sq * np.random.default_rng(0).uniform(0.1, 10, (len(faces), 1))
    np.testing.assert_allclose(
        cotangent_matrix(IntrinsicTriangulation(faces, scaled), mesh.n_vertices).toarray(),
        cotangent_matrix(IntrinsicTriangulation(faces, l_sq), mesh.n_vertices).toarray(),
        atol=1e-12,
    )


def test_conductivity_weighs_faces():
    mesh = bumpy_sphere(1)
    c = np.random.default_rng(0).uniform(1, 2, mesh.n_faces)
    triangulation = own_faces(mesh)
    expected = sum(
        ck * cotangent_matrix(IntrinsicTriangulation(face[None], sides[None]), mesh.n_vertices)
        for ck, face, sides in zip(c, *triangulation, strict=True)
    )
    np.testing.assert_allclose(cotangent_matrix(triangulation, mesh.n_vertices, c).toarray(), expected.toarray())


@each_shape
@pytest.mark.parametrize("metric", [embedded, scale_invariant])
def test_masses_sum_to_the_area_and_to_each_other(mesh, metric):
    g = metric(mesh)
    galerkin = galerkin_mass(g)
    assert galerkin.sum() == pytest.approx(lumped_mass(g).diagonal().sum(), rel=1e-9)
    used = np.unique(mesh.faces)
    assert np.linalg.eigvalsh(galerkin.toarray()[np.ix_(used, used)])[0] > 0
    if metric is embedded:
        np.testing.assert_allclose(np.asarray(galerkin.sum(axis=1)).ravel(), g.mass, atol=1e-12)


def test_galerkin_mass_integrates_products_of_linear_functions_exactly():
    """On the unit square the integral of x y is 1/4; with rho = 1 + x that of 1 is 3/2 and that of x is 5/6."""
    mesh = rectangle(5, 7)
    x, y, _ = mesh.vertices.T
    assert x @ galerkin_mass(embedded(mesh)) @ y == pytest.approx(1 / 4)
    ones = np.ones(mesh.n_vertices)
    weighted = galerkin_mass(conformal(mesh, 1 + x))
    assert ones @ weighted @ ones == pytest.approx(3 / 2)
    assert x @ weighted @ ones == pytest.approx(1 / 2 + 1 / 3, rel=1e-12)
    assert ones @ galerkin_mass(Metric(mesh, own_faces(mesh).l_sq, ones)) @ (ones * y) == pytest.approx(1 / 2)


def test_operator_of_4_5_to_the_letter():
    """Entry by entry, from angles and areas, on a mesh small enough to see."""
    mesh, epsilon = bumpy_sphere(1), 0.3
    n, v = mesh.n_vertices, mesh.vertices
    w, ring, total = np.zeros((n, n)), np.zeros(n), np.zeros(n)
    for face in mesh.faces:
        area = np.linalg.norm(np.cross(v[face[1]] - v[face[0]], v[face[2]] - v[face[0]])) / 2
        for k in range(3):
            i, j, o = face[(k + 1) % 3], face[(k + 2) % 3], face[k]
            p, q = v[i] - v[o], v[j] - v[o]
            cot = p @ q / np.linalg.norm(np.cross(p, q))
            w[[i, j], [j, i]] -= cot
            w[[i, j], [i, j]] += cot
            ring[o] += area
            total[o] += np.arccos(p @ q / np.linalg.norm(p) / np.linalg.norm(q))
    k = np.sqrt((3 * (2 * np.pi - total) / ring) ** 2 + epsilon)
    np.testing.assert_allclose(cotangent_operator(mesh, epsilon).toarray(), w / (k * ring)[:, None], atol=1e-10)


def test_operator_of_4_5_is_two_thirds_of_the_consistent_one():
    mesh = bumpy_sphere(2)
    triangulation = own_faces(mesh)
    k = np.sqrt(one_ring_curvature(mesh) ** 2 + 1)
    mass = k * vertex_areas(*triangulation, mesh.n_vertices)
    consistent = sp.diags(1 / mass) @ cotangent_matrix(triangulation, mesh.n_vertices)
    np.testing.assert_allclose(
        cotangent_operator(mesh, 1.0).toarray(), 2 / 3 * consistent.toarray(), rtol=1e-9, atol=1e-12
    )


def test_operator_of_4_5_on_isolated_vertices_is_zero():
    mesh = with_isolated(icosphere(1))
    assert np.all(np.isfinite(cotangent_operator(mesh, 1.0).data))


@pytest.mark.parametrize("name", ["bumpy", "torus", "disc"])
def test_against_igl(name):
    igl = pytest.importorskip("igl")
    mesh = SHAPES[name]
    w = cotangent_matrix(own_faces(mesh), mesh.n_vertices)
    np.testing.assert_allclose(w.toarray(), -igl.cotmatrix(mesh.vertices, mesh.faces).toarray(), atol=1e-10)
    full = galerkin_mass(Metric(mesh, own_faces(mesh).l_sq, np.ones(mesh.n_vertices)))
    theirs = igl.massmatrix(mesh.vertices, mesh.faces, igl.MASSMATRIX_TYPE_FULL)
    np.testing.assert_allclose(full.toarray(), theirs.toarray(), atol=1e-12)
    theirs = igl.massmatrix(mesh.vertices, mesh.faces, igl.MASSMATRIX_TYPE_BARYCENTRIC)
    areas = vertex_areas(*own_faces(mesh), mesh.n_vertices)
    np.testing.assert_allclose(areas, theirs.diagonal(), atol=1e-12)


def test_intrinsic_delaunay_stiffness_against_igl():
    igl = pytest.importorskip("igl")
    mesh = Mesh(bumpy_sphere(2).vertices * [1, 1, 6], bumpy_sphere(2).faces)  # stretched: many edges flip
    lengths, faces = igl.intrinsic_delaunay_triangulation(np.sqrt(own_faces(mesh).l_sq), mesh.faces)[:2]
    assert np.any(np.sort(faces, axis=1) != np.sort(mesh.faces, axis=1))
    expected = cotangent_matrix(IntrinsicTriangulation(faces, lengths**2), mesh.n_vertices)
    np.testing.assert_allclose(stiffness(embedded(mesh)).toarray(), expected.toarray(), atol=1e-8)
    assert intrinsic_delaunay(mesh).faces.shape == mesh.faces.shape


def test_against_robust_laplacian():
    robust_laplacian = pytest.importorskip("robust_laplacian")
    mesh = SHAPES["bumpy"]
    w, m = robust_laplacian.mesh_laplacian(mesh.vertices, mesh.faces, mollify_factor=0)
    np.testing.assert_allclose(stiffness(embedded(mesh)).toarray(), w.toarray(), atol=1e-8)
    np.testing.assert_allclose(embedded(mesh).mass, m.diagonal(), rtol=1e-8)


BAD = {
    "needle": Mesh([[0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0], [0.5, 1, 0]], [[0, 1, 2], [0, 2, 3], [2, 1, 3]]),
    "zero area": Mesh([[0, 0, 0], [1, 0, 0], [0.5, 0, 0], [0.5, 1, 0]], [[0, 1, 2], [0, 2, 3], [2, 1, 3]]),
    "coincident": Mesh([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0.5, 1, 0]], [[0, 1, 2], [0, 2, 3], [2, 1, 3]]),
    "vertex twice": Mesh(tetrahedron().vertices, np.vstack([tetrahedron().faces, [[1, 1, 2]]])),
    "face twice": Mesh(tetrahedron().vertices, np.vstack([tetrahedron().faces, tetrahedron().faces[:1]])),
    "three on an edge": Mesh(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
    ),
    "bow tie": Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], [[0, 1, 2], [0, 3, 4]]),
    "moebius": Mesh(
        np.random.default_rng(0).standard_normal((5, 3)), [[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]]
    ),
}


@pytest.mark.parametrize("mesh", BAD.values(), ids=BAD.keys())
@pytest.mark.parametrize("metric", [embedded, scale_invariant])
def test_finite_on_bad_meshes(mesh, metric):
    g = metric(mesh)
    w = stiffness(g)
    assert np.all(np.isfinite(w.data)) and np.all(np.isfinite(g.mass)) and np.all(np.isfinite(g.l_sq))
    assert np.all(np.isfinite(galerkin_mass(g).data))
    scale = max(abs(w.data).max(), 1.0)
    assert np.linalg.eigvalsh(w.toarray())[0] > -1e-9 * scale


def test_a_face_that_names_a_vertex_twice_changes_nothing():
    clean, extra = tetrahedron(), BAD["vertex twice"]
    np.testing.assert_allclose(stiffness(embedded(extra)).toarray(), stiffness(embedded(clean)).toarray(), atol=1e-9)
    np.testing.assert_allclose(embedded(extra).mass, embedded(clean).mass)
