"""Curvature: exactly as in (4.5), and smoothed."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import (
    bumpy_sphere,
    cube,
    cylinder,
    disc,
    ellipsoid,
    icosphere,
    jittered,
    joined,
    moved,
    rectangle,
    tetrahedron,
    torus,
    with_isolated,
)

from geodesics import Mesh, embedded
from geodesics.curvature import angle_defect, gaussian_curvature, mean_curvature, principal_curvatures, vertex_normals
from geodesics.one_ring import one_ring_areas, one_ring_curvature
from geodesics.topology.components import boundary_vertices

EULER = {
    "sphere": (icosphere(2), 2),
    "bumpy": (bumpy_sphere(2), 2),
    "torus": (torus(), 0),
    "disc": (disc(6), 1),
    "cylinder": (cylinder(), 0),
    "two": (joined(icosphere(1), torus()), 2),
    "isolated": (with_isolated(icosphere(1)), 2),
}


@pytest.mark.parametrize(("mesh", "euler"), EULER.values(), ids=EULER.keys())
def test_gauss_bonnet(mesh, euler):
    assert angle_defect(mesh).sum() == pytest.approx(2 * np.pi * euler, abs=1e-9)


@pytest.mark.parametrize("smoothing", [0.0, 1e-3, 8e-3, 0.1])
@pytest.mark.parametrize("name", ["sphere", "bumpy", "torus", "two", "isolated"])
def test_smoothing_keeps_total_curvature(name, smoothing):
    mesh, euler = EULER[name]
    total = gaussian_curvature(mesh, smoothing) @ embedded(mesh).mass
    assert total == pytest.approx(2 * np.pi * euler, abs=1e-9)


def test_defect_of_a_cube_is_at_its_corners():
    mesh = cube(4)
    corner = np.abs(mesh.vertices).min(axis=1) == 1
    np.testing.assert_allclose(angle_defect(mesh), np.where(corner, np.pi / 2, 0), atol=1e-12)


def test_formula_of_the_paper_on_a_tetrahedron():
    """Three angles of 60 degrees and three faces of area 2 sqrt 3 at each vertex: K = 3 (2 pi - pi) / (6 sqrt 3)."""
    mesh = tetrahedron()
    np.testing.assert_allclose(one_ring_areas(mesh), 6 * np.sqrt(3))
    np.testing.assert_allclose(one_ring_curvature(mesh), np.pi / (2 * np.sqrt(3)))


def test_formula_of_the_paper_on_a_sphere():
    """Right on the whole; a vertex of five neighbours has a smaller ring than its share."""
    k = one_ring_curvature(icosphere(4, radius=2.0))
    assert np.mean(k) == pytest.approx(0.25, rel=0.01)
    np.testing.assert_allclose(k, 0.25, rtol=0.2)


def test_curvatures_of_a_sphere():
    sphere = icosphere(4, radius=2.0)
    np.testing.assert_allclose(gaussian_curvature(sphere), 0.25, rtol=0.01)
    np.testing.assert_allclose(mean_curvature(sphere), 0.5, rtol=0.01)
    for k in principal_curvatures(sphere):
        np.testing.assert_allclose(k, 0.5, rtol=0.1)


def test_curvatures_of_a_cylinder():
    """K = 0, H = 1 / 2 r, away from the boundary."""
    mesh = cylinder(64, 32, radius=0.5)
    middle = abs(mesh.vertices[:, 2] - 1) < 0.6
    np.testing.assert_allclose(gaussian_curvature(mesh)[middle], 0, atol=1e-9)
    np.testing.assert_allclose(abs(mean_curvature(mesh)[middle]), 1, rtol=0.01)
    k1, k2 = principal_curvatures(mesh)
    sharp = np.where(abs(k1) > abs(k2), k1, k2)[middle]
    np.testing.assert_allclose(abs(sharp), 2, rtol=0.01)


@pytest.mark.parametrize(("refine", "smoothing", "tolerance"), [(1, 1e-3, 0.1), (2, 5e-4, 0.06), (3, 3e-4, 0.04)])
def test_converges_on_a_torus(refine, smoothing, tolerance):
    """K = cos v / (r (R + r cos v)), H = (R + 2 r cos v) / (2 r (R + r cos v)): finer and smoothed less."""
    mesh = torus(48 * refine, 24 * refine)
    ring = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    cos = (ring - 1) / 0.4
    k, h = cos / (0.4 * ring), (1 + 0.8 * cos) / (0.8 * ring)
    np.testing.assert_allclose(gaussian_curvature(mesh, smoothing), k, atol=tolerance * abs(k).max())
    np.testing.assert_allclose(mean_curvature(mesh, smoothing), h, atol=tolerance * abs(h).max())


def test_principal_curvatures_make_the_others():
    mesh = torus()
    k1, k2 = principal_curvatures(mesh)
    assert np.all(k1 >= k2)
    np.testing.assert_allclose(k1 + k2, 2 * mean_curvature(mesh))
    real = k1 > k2
    assert real.mean() > 0.9
    np.testing.assert_allclose((k1 * k2)[real], gaussian_curvature(mesh)[real], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_units(scale):
    mesh = bumpy_sphere(2)
    other = moved(mesh, scale)
    k, h = gaussian_curvature(mesh), mean_curvature(mesh)
    np.testing.assert_allclose(gaussian_curvature(other) * scale**2, k, rtol=1e-7, atol=1e-7 * abs(k).max())
    np.testing.assert_allclose(mean_curvature(other) * scale, h, rtol=1e-7, atol=1e-7 * abs(h).max())
    np.testing.assert_allclose(
        one_ring_curvature(other) * scale**2, one_ring_curvature(mesh), rtol=1e-7, atol=1e-7 * abs(k).max()
    )


def test_noise_is_smoothed_away():
    """1 % of an edge of noise: the letter is off by half, the default by a few per cent."""
    mesh = jittered(icosphere(4), 0.02)
    assert np.median(abs(one_ring_curvature(mesh) - 1)) > 0.5
    assert np.median(abs(gaussian_curvature(mesh) - 1)) < 0.1


def two_balls(scale):
    """A ball, and one `scale` times as large beside it: its part of |K| dA is the same."""
    big = moved(bumpy_sphere(3), scale, seed=None)
    return joined(bumpy_sphere(3), big, gap=10 + 5 * scale)


@pytest.mark.parametrize("scale", [0.25, 4.0])
def test_a_part_that_grows_keeps_its_curvature(scale):
    """Local scale: K times area of the scaled part hardly changes, whatever the size of the rest."""
    same, other = two_balls(1.0), two_balls(scale)
    part = np.arange(same.n_vertices) >= same.n_vertices // 2
    before = gaussian_curvature(same)[part] * embedded(same).mass[part]
    after = gaussian_curvature(other)[part] * embedded(other).mass[part]
    assert abs(after - before).sum() < 0.12 * abs(before).sum()
    fixed = gaussian_curvature(same, 0)[part] * embedded(same).mass[part]
    assert abs(fixed - before).sum() > 0.12 * abs(before).sum()  # or the first line would hold for no smoothing at all


def test_remeshed_sphere_agrees():
    """Another triangulation of the same ellipsoid, by turning the icosphere before it is stretched."""
    sphere = moved(icosphere(4), 1.0, seed=None)
    rotation = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    axes = np.array([1.0, 1.4, 2.0])
    a, b = Mesh(sphere.vertices * axes, sphere.faces), Mesh(sphere.vertices @ rotation * axes, sphere.faces)
    nearest = np.linalg.norm(a.vertices[:, None] - b.vertices[None, ::7], axis=2).argmin(axis=0)
    ratio = gaussian_curvature(a)[nearest] / gaussian_curvature(b)[::7]
    assert abs(np.log(ratio)).mean() < 0.03


def test_boundary_has_no_curvature_of_its_own():
    flat = rectangle(8, 8)
    np.testing.assert_allclose(gaussian_curvature(flat), 0, atol=1e-9)
    np.testing.assert_allclose(mean_curvature(flat), 0, atol=1e-9)
    assert np.all(one_ring_curvature(flat)[boundary_vertices(flat)] == 0)
    half = icosphere(4)
    keep = half.vertices[half.faces].mean(axis=1)[:, 2] > 0
    cap = Mesh(half.vertices, half.faces[keep])
    used = np.unique(cap.faces)
    np.testing.assert_allclose(gaussian_curvature(cap)[used], 1, rtol=0.02)


def test_no_interior_at_all():
    one = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    for values in (gaussian_curvature(one), mean_curvature(one), one_ring_curvature(one)):
        np.testing.assert_array_equal(values, 0)


def test_isolated_vertices_have_none():
    mesh = with_isolated(icosphere(1))
    lonely = np.setdiff1d(np.arange(mesh.n_vertices), mesh.faces)
    for values in (angle_defect(mesh), gaussian_curvature(mesh), mean_curvature(mesh), one_ring_curvature(mesh)):
        assert np.all(np.isfinite(values)) and np.all(values[lonely] == 0)


def test_normals_of_a_sphere_point_outwards_however_faces_are_turned():
    sphere = icosphere(2)
    turned = sphere.faces.copy()
    turned[::3] = turned[::3, ::-1]
    for faces in (sphere.faces, sphere.faces[:, ::-1], turned):
        np.testing.assert_allclose(vertex_normals(Mesh(sphere.vertices, faces)), sphere.vertices, atol=0.02)


def test_smoothing_does_not_move_the_curvature_of_a_convex_body_far():
    mesh = ellipsoid(4)
    x = mesh.vertices / np.array([1, 1.96, 4])
    exact = 1 / (1.0 * 1.96 * 4) / (x**2).sum(axis=1) ** 2
    assert abs(np.log(gaussian_curvature(mesh, 1e-3) / exact)).mean() < 0.06
    assert abs(np.log(gaussian_curvature(mesh) / exact)).mean() < 0.16
