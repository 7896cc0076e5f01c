"""Trilateration: 2-forms are sines of angles, reflections change their sign, and a copy is placed on itself."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import disc
from hypothesis import given
from hypothesis import strategies as st

from geodesics import Mesh
from gmds.parts.assignments import Assignment
from gmds.parts.extremities import Anchors, inner_extremities
from gmds.parts.trilateration import Trilateration, distance_forms
from gmds.shapes import quadruped
from gmds.surface.measured import measure

FLAT = disc(24)


@given(angles=st.lists(st.floats(0, 2 * np.pi), min_size=2, max_size=4), far=st.floats(2, 50))
def test_forms_on_a_flat_disc_are_sines_of_the_angles_between_directions(angles: list[float], far: float) -> None:
    anchors = far * np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)
    offset = FLAT.vertices - anchors[:, None]
    distances = np.linalg.norm(offset, axis=2)
    unit = offset / distances[:, :, None]
    sines = unit[:, None, :, 0] * unit[None, :, :, 1] - unit[:, None, :, 1] * unit[None, :, :, 0]
    up = np.sign(np.cross(*(FLAT.vertices[FLAT.faces[0][1:]] - FLAT.vertices[FLAT.faces[0][0]]))[2])
    inside = np.linalg.norm(FLAT.vertices, axis=1) < 0.9
    np.testing.assert_allclose(distance_forms(FLAT, distances)[:, :, inside], up * sines[:, :, inside], atol=0.02)


def test_forms_are_antisymmetric_and_change_sign_under_a_reflection() -> None:
    distances = np.random.default_rng(0).uniform(size=(4, FLAT.n_vertices))
    forms = distance_forms(FLAT, distances)
    assert np.array_equal(forms, -forms.transpose(1, 0, 2)) and np.abs(forms).max() > 0
    reflected = Mesh(FLAT.vertices * [-1, 1, 1], FLAT.faces[:, [0, 2, 1]])
    np.testing.assert_allclose(distance_forms(reflected, distances), -forms, atol=1e-12)


def test_forms_have_no_unit() -> None:
    distances = np.random.default_rng(0).uniform(size=(3, FLAT.n_vertices))
    larger = Mesh(1e3 * FLAT.vertices, FLAT.faces)
    np.testing.assert_allclose(distance_forms(larger, 1e3 * distances), distance_forms(FLAT, distances), rtol=1e-9)


@pytest.fixture(scope="module")
def on_itself() -> Trilateration:
    """An animal and itself in another order of vertices: rows are every third vertex."""
    surface = measure(quadruped(n_vertices=600))
    anchors, rows = inner_extremities(surface), np.arange(0, 600, 3)
    return Trilateration(surface.mesh, surface.mesh, anchors, anchors, rows, rows)


def test_a_surface_is_placed_on_itself(on_itself: Trilateration) -> None:
    ends = tuple(range(len(on_itself.ours.vertices)))
    assert len(ends) >= 5
    for chosen in (ends, ends[:3]):
        same = Assignment(chosen, chosen, 1.0, 0.0)
        assert np.array_equal(on_itself.images(same), np.arange(len(on_itself.source_rows)))
    wrong = Assignment(ends, tuple(np.roll(ends, 1).tolist()), 1.0, 0.0)
    assert on_itself.residual(Assignment(ends, ends, 1.0, 0.0)) < on_itself.residual(wrong) - 0.01


def test_the_scale_of_distances_is_taken_out(on_itself: Trilateration) -> None:
    surface, anchors = on_itself.source, on_itself.ours
    larger = Anchors(anchors.vertices, 1.7 * anchors.distances)
    rows = on_itself.source_rows
    both = Trilateration(Mesh(1.7 * surface.vertices, surface.faces), surface, larger, anchors, rows, rows)
    ends = tuple(range(len(anchors.vertices)))
    assert np.array_equal(both.images(Assignment(ends, ends, 1.7, 0.0)), np.arange(len(rows)))


def test_forms_tell_left_from_right_where_distances_do_not() -> None:
    """Two anchors on the axis of a disc: only the sign of their form tells a point from its mirror image."""
    at = np.array([[-3.0, 0, 0], [3.5, 0, 0]])
    anchors = Anchors(np.array([0, 1]), np.linalg.norm(FLAT.vertices - at[:, None], axis=2))
    rows = np.flatnonzero((np.abs(FLAT.vertices[:, 1]) > 0.3) & (np.linalg.norm(FLAT.vertices, axis=1) < 0.9))
    here = Trilateration(FLAT, FLAT, anchors, anchors, rows, rows)
    places = FLAT.vertices[rows][here.images(Assignment((0, 1), (0, 1), 1.0, 0.0))]
    assert (places[:, 1] * FLAT.vertices[rows][:, 1] > 0).all()
