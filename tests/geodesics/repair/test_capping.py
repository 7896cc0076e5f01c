"""Holes closed by cones: the mesh stays, the boundary goes, distances cross."""

from __future__ import annotations

import numpy as np
from generated_shapes import disc, icosphere

from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded
from geodesics.repair.capping import capped
from geodesics.topology import boundary_vertices


def with_hole() -> Mesh:
    ball = icosphere(3)
    return Mesh(ball.vertices, ball.faces[ball.vertices[ball.faces].mean(axis=1)[:, 2] < 0.8])


def test_a_closed_surface_stays_as_it_is() -> None:
    ball = icosphere(2)
    assert capped(ball, 10.0) is ball


def test_vertices_and_faces_stay_and_the_boundary_goes() -> None:
    mesh = with_hole()
    whole = capped(mesh, 10.0)
    assert np.array_equal(whole.vertices[: mesh.n_vertices], mesh.vertices)
    assert np.array_equal(whole.faces[: mesh.n_faces], mesh.faces)
    assert not boundary_vertices(whole).any() and boundary_vertices(mesh).any()


def test_new_faces_turn_as_their_neighbours_do() -> None:
    whole = capped(with_hole(), 10.0)
    a, b, c = (whole.vertices[corner] for corner in whole.faces.T)
    assert (np.einsum("mj,mj->m", np.cross(b - a, c - a), a + b + c) > 0).all(), "outward, as on the ball"


def test_long_boundaries_are_left_open() -> None:
    around = 2 * np.pi * 0.6  # of the hole of the ball, about
    assert boundary_vertices(capped(with_hole(), 0.5 * around)).any()
    assert boundary_vertices(capped(disc(6), 0.1)).any()


def test_distances_cross_the_hole() -> None:
    mesh = with_hole()
    rim = np.flatnonzero(boundary_vertices(mesh))
    first, second = rim[mesh.vertices[rim][:, 0].argmin()], rim[mesh.vertices[rim][:, 0].argmax()]
    straight = np.linalg.norm(mesh.vertices[first] - mesh.vertices[second])
    around, across = (
        float(GeodesicDistance(embedded(one)).field(SurfacePoints.at_vertices(one, np.array([first])))[0, second])
        for one in (mesh, capped(mesh, 10.0))
    )
    assert straight <= across * 1.01 and across < 1.1 * straight and around > 1.3 * across
