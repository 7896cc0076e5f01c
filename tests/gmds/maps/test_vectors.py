"""Vectors carried along maps: turned as the surface is."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, with_isolated

from geodesics import Mesh, SurfacePoints, vertex_normals
from gmds import Correspondence
from gmds.deformations import bending
from gmds.errors import MapError
from gmds.maps.vectors import carry_vectors, turns
from gmds.shapes import quadruped

MESH = bumpy_sphere(3)
RNG = np.random.default_rng(2)


def to(target: Mesh, source: Mesh = MESH) -> Correspondence:
    return Correspondence.from_points(source, SurfacePoints.at_vertices(target, np.arange(source.n_vertices)))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("scale", [1.0, 1e-6])
def test_a_congruence_turns_every_vector_alike(sign: float, scale: float) -> None:
    turn = np.linalg.qr(RNG.standard_normal((3, 3)))[0]
    turn *= sign * np.linalg.det(turn)
    faces = MESH.faces if sign > 0 else MESH.faces[:, ::-1]  # a mirror image, facing outward again
    answer = to(Mesh(scale * MESH.vertices @ turn.T + 3 * scale, faces))
    assert np.abs(turns(answer) - turn).max() < 1e-9
    vectors = RNG.standard_normal((MESH.n_vertices, 3))
    assert np.abs(carry_vectors(answer, vectors @ turn.T) - vectors).max() < 1e-9


def test_normals_stay_normals_and_tangents_tangent_when_the_surface_bends() -> None:
    source = quadruped(n_vertices=1500)
    answer = to(bending(source, 60.0)[0], source)
    here, there = vertex_normals(source), vertex_normals(answer.target)
    assert np.linalg.norm(carry_vectors(answer, there) - here, axis=1).mean() < 0.02
    tangent = np.cross(there, RNG.standard_normal(there.shape))
    carried = carry_vectors(answer, tangent)
    assert np.allclose(np.linalg.norm(carried, axis=1), np.linalg.norm(tangent, axis=1))
    assert np.abs(np.einsum("na,na->n", carried, here)).mean() < 0.03 * np.linalg.norm(tangent, axis=1).mean()


def test_the_tangents_of_a_curve_follow_its_image() -> None:
    source = quadruped(n_vertices=1500)
    answer = to(bending(source, 60.0)[0], source)
    start, end = source.faces[:, 0], source.faces[:, 1]
    along = [mesh.vertices[end] - mesh.vertices[start] for mesh in (answer.target, source)]
    given = np.zeros((source.n_vertices, 3))
    given[start] = along[0]
    expected = np.zeros_like(given)
    expected[start] = along[1]
    length = np.linalg.norm(along[1], axis=1).mean()
    assert np.linalg.norm(carry_vectors(answer, given) - expected, axis=1).mean() < 0.15 * length


def test_vertices_on_no_face_and_wrong_shapes() -> None:
    lonely = with_isolated(bumpy_sphere(1))
    points = SurfacePoints(lonely, np.zeros(lonely.n_vertices, dtype=int), np.eye(3)[np.zeros(lonely.n_vertices, int)])
    assert np.isfinite(turns(Correspondence.from_points(lonely, points))).all()
    with pytest.raises(MapError, match=r"must have shape \(642, 3\)"):
        carry_vectors(to(MESH), np.zeros((642, 2)))
