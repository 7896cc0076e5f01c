"""Cutting meshes where they are no manifold, there and nowhere else; faces that continue each other stay together."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from generated_shapes import icosphere, joined, moved, rectangle, torus
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh_facts import warnings
from odd_shapes import Odd, bow_tie, fin
from rare_shapes import strip

from geodesics import Mesh
from geodesics.repair import splitting
from geodesics.repair.repairing import repair
from geodesics.repair.splitting import split
from geodesics.topology.edges import face_components


def book(*pages: tuple[float, float, bool], lean: float = 3.0) -> Mesh:
    """Triangles on one edge, each at an angle (degrees) and of a width, running along the edge one way or the other.

    Each leans along the edge by another amount and begins at another corner.
    """
    angle, width, forward = np.array(pages).T
    x, y = width * np.cos(np.deg2rad(angle)), width * np.sin(np.deg2rad(angle))
    tips = np.stack([x, y, lean * np.arange(len(pages)) - 4], axis=1)
    faces = [np.roll([0, 1, k] if way else [1, 0, k], k) for k, way in enumerate(forward, 2)]
    return Mesh(np.vstack([[0, 0, 0], [0, 0, 1], tips]), faces)


def together(mesh: Mesh) -> list[list[int]]:
    """Faces that are connected."""
    label = face_components(mesh)
    return [np.flatnonzero(label == part).tolist() for part in np.unique(label)]


@pytest.mark.parametrize("make", [fin, bow_tie])
def test_a_mesh_is_cut_where_it_is_no_surface_and_nowhere_else(make: Callable[[], Odd]) -> None:
    mesh = make().mesh
    apart, vertex = split(mesh)
    assert apart.n_vertices == mesh.n_vertices + (2 if make is fin else 1)
    assert np.array_equal(apart.vertices, mesh.vertices[vertex])
    assert np.array_equal(vertex[apart.faces], mesh.faces)
    assert np.array_equal(vertex[: mesh.n_vertices], np.arange(mesh.n_vertices))
    assert not warnings(apart) & {"W213", "W214"}
    sizes = np.bincount(face_components(apart))
    assert sorted(sizes) == ([1, 320] if make is fin else [320, 320])


def test_sound_meshes_are_not_cut() -> None:
    for mesh in (icosphere(1), torus(), rectangle(4, 4), strip(), joined(icosphere(0), icosphere(0))):
        assert split(mesh)[0] is mesh


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**31), n=st.integers(4, 9), m=st.integers(2, 30))
def test_any_soup_of_triangles_is_cut_into_surfaces(seed: int, n: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    soup = repair(Mesh(rng.standard_normal((n, 3)), [rng.choice(n, 3, replace=False) for _ in range(m)]))
    apart, vertex = split(soup.mesh)
    assert not warnings(apart) & {"W213", "W214"}
    assert np.array_equal(vertex[apart.faces], soup.mesh.faces)
    again = repair(apart, cut=True)
    assert np.array_equal(again.vertex, np.arange(apart.n_vertices))


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize(
    ("pages", "parts"),
    [
        ([(0, 1, True), (180, 1, False), (90, 1, True)], [[0, 1], [2]]),
        ([(0, 1, True), (90, 1, False), (275, 1, True), (170, 1, False)], [[0, 3], [1, 2]]),
        ([(0, 1, True), (60, 1, True), (178, 1, False), (120, 1, True), (235, 1, False)], [[0, 2], [1, 4], [3]]),
        ([(0, 0.1, True), (100, 10, False), (180, 0.1, False)], [[0, 2], [1]]),  # the angle decides, not the width
        ([(0, 1, True), (180, 1, True), (150, 1, False)], [[0, 2], [1]]),  # the flattest two run against each other
    ],
)
def test_at_an_edge_of_many_faces_those_that_go_on_flat_stay_together(
    pages: list[tuple[float, float, bool]], parts: list[list[int]], scale: float
) -> None:
    mesh = moved(book(*pages), scale)
    apart, vertex = split(mesh)
    assert together(apart) == parts
    assert apart.n_vertices == mesh.n_vertices + 2 * (len(parts) - 1)
    assert np.array_equal(apart.faces[0], mesh.faces[0])  # the first face keeps the numbers of its corners
    assert np.array_equal(vertex[apart.faces], mesh.faces)


def test_what_would_become_one_sided_is_cut_where_it_may_be_cut() -> None:
    """A Moebius strip with a fin on its seam: the strip goes on flat there, but is cut; not so what is elsewhere."""
    n = 40
    closed = strip(n)
    half = np.where(closed.faces.max(axis=1) // 9 < n // 2, 1, -1)
    faces = np.where(half[:, None] > 0, closed.faces, closed.faces[:, ::-1])
    seam = np.array([[k, k + 1] for k in range(8)])
    tips = closed.vertices[seam].mean(axis=1) + np.array([0, 1, 0])
    fins = np.column_stack([seam, closed.n_vertices + np.arange(8)])
    finned = Mesh(np.vstack([closed.vertices, tips]), np.vstack([faces, fins]))
    apart, _ = split(joined(finned, book((0, 1, True), (180, 1, False), (90, 1, True))))
    assert not warnings(apart) & {"W212", "W213", "W214"}
    assert len(together(apart)[0]) == closed.n_faces  # one strip still
    assert [len(part) for part in together(apart)[-2:]] == [2, 1]


def test_when_nothing_else_helps_faces_stand_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """After the last round: the faces at what is no surface are cut loose, and only they."""
    monkeypatch.setattr(splitting, "ROUNDS", 1)
    centre = np.bincount(bow_tie().mesh.faces.ravel()).argmax()
    fans = int((bow_tie().mesh.faces == centre).sum())
    for mesh, crowd in ((fin().mesh, 3), (bow_tie().mesh, fans)):
        apart, vertex = split(mesh)
        assert not warnings(apart) & {"W213", "W214"}
        assert np.array_equal(vertex[apart.faces], mesh.faces) and np.array_equal(apart.vertices, mesh.vertices[vertex])
        assert sum(len(part) == 1 for part in together(apart)) == crowd
        assert apart.n_vertices == mesh.n_vertices + 3 * crowd
