"""Coarse copies of meshes with very many faces."""

from __future__ import annotations

import functools

import generated_shapes as shapes
import numpy as np
import pytest

from geodesics import Mesh
from geodesics.closest import closest_on_triangles
from geodesics.repair.decimation import FEWEST_BEGUN, decimated
from geodesics.repair.splitting import several_fans
from geodesics.threads import side_by_side
from geodesics.topology.components import component_areas
from geodesics.topology.edges import edges


@functools.cache
def large() -> Mesh:
    """A sphere with bumps, of so many faces that most go by quadric collapses."""
    mesh = shapes.bumpy_sphere(6)
    assert mesh.n_faces > 2 * FEWEST_BEGUN
    return mesh


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e4])
def test_a_large_mesh_keeps_shape_and_topology_at_any_size(size: float) -> None:
    mesh = Mesh(large().vertices * size + 5 * size, large().faces)
    coarse = decimated(mesh, 10_000)
    assert coarse is not None
    assert 9_900 <= coarse.n_faces <= 10_000
    assert (edges(coarse).n_faces == 2).all()
    assert not several_fans(coarse).any()
    assert coarse.n_vertices - len(edges(coarse).ends) + coarse.n_faces == 2
    away = closest_on_triangles(coarse.vertices, mesh.vertices, mesh.faces)[2]
    assert away.max() < 2e-3 * size  # a tenth of an edge of the coarse mesh
    assert coarse.area == pytest.approx(mesh.area, rel=2e-3)


def test_holes_of_a_large_mesh_stay() -> None:
    mesh = large()
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    cut = Mesh(mesh.vertices, mesh.faces[middle[:, 2] < 0.9 * middle[:, 2].max()])
    coarse = decimated(cut, 10_000)
    assert coarse is not None
    rim = coarse.vertices[np.unique(edges(coarse).ends[edges(coarse).n_faces == 1])]
    assert len(rim) > 10
    assert coarse.n_vertices - len(edges(coarse).ends) + coarse.n_faces == 1  # a disc


def test_a_large_mesh_that_is_no_manifold_is_cut_apart() -> None:
    """A fin on an edge: three faces meet there."""
    mesh = large()
    a, b = mesh.faces[0, :2]
    tip = (mesh.vertices[a] + mesh.vertices[b]) * 0.6
    with_fin = Mesh(np.vstack([mesh.vertices, tip]), np.vstack([mesh.faces, [[a, b, mesh.n_vertices]]]))
    coarse = decimated(with_fin, 10_000)
    assert coarse is not None
    assert coarse.n_faces <= 10_000
    assert (edges(coarse).n_faces <= 2).all()


def test_halves_that_hang_together_in_vertices_alone_are_both_kept() -> None:
    """As where T-junctions are too far off to be sewn: every other vertex of a ring is shared."""
    mesh = shapes.bumpy_sphere(4)
    front = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0
    ring = np.intersect1d(mesh.faces[front], mesh.faces[~front])
    angle = np.argsort(np.arctan2(mesh.vertices[ring, 1], mesh.vertices[ring, 2]))
    doubled = ring[angle][::2]
    other = np.arange(mesh.n_vertices)
    other[doubled] = mesh.n_vertices + np.arange(len(doubled))
    vertices = np.vstack([mesh.vertices, mesh.vertices[doubled] * 1.001])
    torn = Mesh(vertices, np.where(front[:, None], other[mesh.faces], mesh.faces))
    coarse = decimated(torn, 1_000)
    assert coarse is not None and coarse.n_faces <= 1_250
    assert component_areas(coarse).max() > 0.9 * component_areas(torn).max()


def test_a_regular_grid_does_not_fold() -> None:
    """A ring of such rows of faces is left in long, thin ones by quadrics."""
    across, along = np.meshgrid(np.arange(130), np.arange(400), indexing="ij")
    start = (across * 400 + along).ravel()
    right, up = ((across + 1) % 130 * 400 + along).ravel(), (across * 400 + (along + 1) % 400).ravel()
    beyond = ((across + 1) % 130 * 400 + (along + 1) % 400).ravel()
    turn, tube = 2 * np.pi * across.ravel() / 130, 2 * np.pi * along.ravel() / 400
    out = 2 + np.cos(tube)
    vertices = np.column_stack([out * np.cos(turn), out * np.sin(turn), np.sin(tube)])
    faces = np.vstack([np.column_stack([beyond, start, right]), np.column_stack([up, start, beyond])])
    coarse = decimated(Mesh(vertices, faces), 8_000)
    assert coarse is not None
    corners = coarse.vertices[coarse.faces]
    middle = corners.mean(axis=1)
    ring = middle * [1, 1, 0]
    outwards = middle - 2 * ring / np.linalg.norm(ring, axis=1)[:, None]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sides = np.sign(np.einsum("ij,ij->i", normals, outwards))
    assert abs(sides.sum()) == coarse.n_faces  # all face one way
    assert coarse.area == pytest.approx(4 * np.pi**2 * 2, rel=5e-3)


def test_two_large_meshes_side_by_side_are_copied_as_one_after_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """The library for quadrics holds one mesh at a time: of two threads the one was handed the mesh of the other."""
    monkeypatch.setenv("GMDS_THREADS", "2")
    two = [large(), Mesh(large().vertices * [1, 2, 3], large().faces)]
    for one, alone in zip(side_by_side(lambda mesh: decimated(mesh, 10_000), two), two, strict=True):
        expected = decimated(alone, 10_000)
        assert one is not None and expected is not None
        np.testing.assert_array_equal(one.faces, expected.faces)
        np.testing.assert_array_equal(one.vertices, expected.vertices)
