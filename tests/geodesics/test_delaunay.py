"""The intrinsic Delaunay triangulation: same surface, better edges, any mesh."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, disc, ellipsoid, icosphere, jittered, joined, rectangle, torus, with_isolated
from hypothesis import given, settings
from hypothesis import strategies as st

from geodesics import Mesh, intrinsic
from geodesics.delaunay import GluedTriangulation, glued_delaunay, glued_faces, intrinsic_delaunay
from geodesics.intrinsic import angles, areas, squared_lengths


def flattened(mesh: Mesh, factor: float = 0.15) -> Mesh:
    """Squeezed along x: well-shaped triangles become needles."""
    return Mesh(mesh.vertices * [factor, 1.0, 1.0], mesh.faces)


SURFACES = {
    "needles": flattened(bumpy_sphere(2)),
    "ellipsoid": ellipsoid(2, (0.2, 1.0, 3.0)),
    "torus": flattened(torus(24, 12)),
    "border": flattened(jittered(rectangle(9, 9), 0.02)),
    "disc": flattened(disc(6)),
    "two": joined(icosphere(1), flattened(torus(12, 6))),
    "isolated": with_isolated(flattened(icosphere(2))),
}


@pytest.mark.parametrize("mesh", SURFACES.values(), ids=SURFACES)
def test_no_edge_has_opposite_angles_above_pi(mesh: Mesh) -> None:
    grid = glued_delaunay(mesh)
    theta, inner = angles(grid.lengths**2).ravel(), np.flatnonzero(grid.twin >= 0)
    assert (angles(glued_faces(mesh).lengths ** 2).ravel()[inner] > 0).all()
    assert (theta[inner] + theta[grid.twin[inner]]).max() <= np.pi + 1e-7


@pytest.mark.parametrize("mesh", SURFACES.values(), ids=SURFACES)
def test_area_and_angle_sums_stay(mesh: Mesh) -> None:
    before, after = glued_faces(mesh), glued_delaunay(mesh)
    assert np.isclose(areas(after.lengths**2).sum(), areas(before.lengths**2).sum(), rtol=1e-9)
    sums = [np.bincount(g.faces.ravel(), angles(g.lengths**2).ravel(), mesh.n_vertices) for g in (before, after)]
    np.testing.assert_allclose(sums[1], sums[0], atol=1e-7)
    closed = np.isfinite(after.whole)
    np.testing.assert_allclose(after.whole[closed], sums[0][closed], atol=1e-7)


@pytest.mark.parametrize("mesh", SURFACES.values(), ids=SURFACES)
def test_glued_edges_agree(mesh: Mesh) -> None:
    check_gluing(glued_delaunay(mesh))


def check_gluing(grid: GluedTriangulation) -> None:
    """Twins name each other, run between the same vertices the other way, and are as long."""
    inner = np.flatnonzero(grid.twin >= 0)
    twin = grid.twin[inner]
    assert (grid.twin[twin] == inner).all()
    tails, heads = (grid.faces[:, [1, 2, 0]].ravel(), grid.faces[:, [2, 0, 1]].ravel())
    assert (tails[inner] == heads[twin]).all() and (heads[inner] == tails[twin]).all()
    np.testing.assert_allclose(grid.lengths.ravel()[inner], grid.lengths.ravel()[twin], rtol=1e-9)


@pytest.mark.parametrize("mesh", SURFACES.values(), ids=SURFACES)
def test_directions_fit_together(mesh: Mesh) -> None:
    """Round every vertex the next corner starts where this one ends."""
    grid = glued_delaunay(mesh)
    end = grid.direction + angles(grid.lengths**2)
    for k in range(3):
        twin = grid.twin[3 * np.arange(len(grid.faces)) + (k + 1) % 3]
        met = twin >= 0
        start = grid.direction[twin[met] // 3, (twin[met] + 1) % 3]
        whole = grid.whole[grid.faces[met, k]]
        gap = end[met, k] - start
        turns = np.where(np.isfinite(whole), np.round(gap / np.where(np.isfinite(whole), whole, 1)), 0)
        np.testing.assert_allclose(gap - turns * np.where(np.isfinite(whole), whole, 0), 0, atol=1e-6)


def test_flat_lengths_are_straight_lines() -> None:
    """On a flat convex mesh every intrinsic edge is the straight segment between its ends."""
    mesh = flattened(jittered(rectangle(15, 15), 0.01))
    flat = Mesh(mesh.vertices * [1, 1, 0], mesh.faces)
    faces, l_sq = intrinsic_delaunay(flat)
    np.testing.assert_allclose(l_sq, squared_lengths(flat.vertices, faces), rtol=1e-9)
    assert (faces != flat.faces).any()


@pytest.mark.parametrize("name", ["needles", "torus", "border"])
def test_cotangents_equal_those_of_igl(name: str) -> None:
    """The matrix of an intrinsic Delaunay triangulation is unique (Bobenko, Springborn 2007)."""
    igl = pytest.importorskip("igl")
    from geodesics.delaunay import IntrinsicTriangulation
    from geodesics.laplacian import cotangent_matrix

    mesh = SURFACES[name]
    lengths, faces = igl.intrinsic_delaunay_triangulation(
        np.sqrt(squared_lengths(mesh.vertices, mesh.faces)), mesh.faces
    )[:2]
    theirs = cotangent_matrix(IntrinsicTriangulation(faces.astype(np.int64), lengths**2), mesh.n_vertices)
    ours = cotangent_matrix(intrinsic_delaunay(mesh), mesh.n_vertices)
    assert abs(ours - theirs).max() <= 1e-8 * abs(theirs).max()


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scale(scale: float) -> None:
    mesh = SURFACES["needles"]
    here, there = intrinsic_delaunay(mesh), intrinsic_delaunay(Mesh(mesh.vertices * scale, mesh.faces))
    assert (here.faces == there.faces).all()
    np.testing.assert_allclose(there.l_sq, here.l_sq * scale**2, rtol=1e-9)


def test_repeated_and_improper_faces_are_left_out() -> None:
    mesh = icosphere(1)
    faces = np.concatenate([mesh.faces, mesh.faces[:3], mesh.faces[5:6, [1, 2, 0]], [[4, 4, 9], [7, 7, 7]]])
    assert len(intrinsic_delaunay(Mesh(mesh.vertices, faces)).faces) == mesh.n_faces
    two_sided = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]])
    assert len(intrinsic_delaunay(two_sided).faces) == 2


def test_faces_turned_over_are_turned_back() -> None:
    mesh = SURFACES["needles"]
    faces = mesh.faces.copy()
    faces[::3] = faces[::3, ::-1]
    grid = glued_delaunay(Mesh(mesh.vertices, faces))
    assert (grid.twin >= 0).all()
    check_gluing(grid)
    whole = np.sort(areas(grid.lengths**2))
    np.testing.assert_allclose(whole, np.sort(areas(glued_delaunay(mesh).lengths ** 2)), rtol=1e-6)


def test_a_moebius_band_and_a_book_keep_their_odd_edges() -> None:
    t = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    rims = [
        np.stack([(2 + s * np.cos(t / 2)) * np.cos(t), (2 + s * np.cos(t / 2)) * np.sin(t), s * np.sin(t / 2)], 1)
        for s in (-1, 1)
    ]
    i = np.arange(12)
    j, top, bottom = (i + 1) % 12, np.where(i < 11, 12, 0), np.where(i < 11, 0, 12)
    faces = np.concatenate([np.stack([i, j + bottom, i + 12], 1), np.stack([j + bottom, j + top, i + 12], 1)])
    band = glued_delaunay(Mesh(np.concatenate(rims), faces))
    assert len(band.faces) == 24
    check_gluing(band)
    pages = Mesh([[0, 0, 0], [0, 0, 1], [1, 0, 0.5], [-1, 1, 0.5], [-1, -1, 0.5]], [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    assert (glued_delaunay(pages).twin == -1).all()


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 12), st.integers(1, 25), st.sampled_from([0.0, 1e-9, 1.0]))
def test_any_soup_of_triangles(seed: int, n: int, m: int, spread: float) -> None:
    """Coincident points, slivers, faces shared by many edges: always finite, glued, with positive lengths."""
    rng = np.random.default_rng(seed)
    vertices = rng.integers(0, 2, (n, 3)) + spread * rng.standard_normal((n, 3))
    vertices[0], vertices[1] = [5, 0, 0], [0, 5, 0]
    mesh = Mesh(vertices, np.concatenate([[[0, 1, 2]], rng.integers(0, n, (m, 3))]))
    grid = glued_delaunay(mesh)
    assert np.isfinite(grid.lengths).all() and (grid.lengths > 0).all() and np.isfinite(grid.direction).all()
    check_gluing(grid)


@pytest.mark.parametrize("subdivisions", [1, 3])
def test_a_sphere_is_already_delaunay(subdivisions: int) -> None:
    mesh = icosphere(subdivisions)
    assert (intrinsic_delaunay(mesh).faces == mesh.faces).all()
    np.testing.assert_allclose(
        intrinsic_delaunay(mesh).l_sq, intrinsic.squared_lengths(mesh.vertices, mesh.faces), rtol=1e-12
    )
