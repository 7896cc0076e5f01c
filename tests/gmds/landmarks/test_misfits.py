"""How far landmarks are from where what is around them goes, of maps that are known."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, joined
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints
from gmds import Correspondence
from gmds.landmarks.checking import place_landmarks
from gmds.landmarks.misfits import MISFIT, misfits, named

MESH = bumpy_sphere(4)
TURN = Rotation.from_rotvec([0.4, -1.0, 0.3]).as_matrix()
ROWS = np.array([5, 700, 1500])
FAR = int(np.linalg.norm(MESH.vertices - MESH.vertices[700], axis=1).argmax())


def carried(mesh: Mesh, factor: float = 3.0, valid: np.ndarray | None = None) -> Correspondence:
    """A mesh and itself, turned and resized."""
    target = Mesh(factor * mesh.vertices @ TURN.T + 1.0, mesh.faces)
    points = SurfacePoints.at_vertices(target, np.arange(mesh.n_vertices))
    return Correspondence.from_points(mesh, points, **({} if valid is None else {"valid": valid}))


def gaps(answer: Correspondence, there: np.ndarray) -> np.ndarray:
    here = SurfacePoints.at_vertices(answer.source, ROWS)
    return misfits(answer, here, SurfacePoints.at_vertices(answer.target, there))


@pytest.mark.parametrize("factor", [1e-3, 3.0])
def test_right_landmarks_of_a_similarity_fit(factor: float) -> None:
    np.testing.assert_allclose(gaps(carried(MESH, factor), ROWS), 0, atol=1e-9)


def test_a_wrong_one_is_as_far_off_as_it_is() -> None:
    answer, there = carried(MESH), ROWS.copy()
    there[1] = FAR
    off = np.linalg.norm(np.subtract(*answer.target.vertices[[700, FAR]])) / np.sqrt(answer.target.area)
    found = gaps(answer, there)
    np.testing.assert_allclose(found, [0, off, 0], atol=1e-9)
    assert off > MISFIT


def test_a_map_that_is_torn_to_it_does_not_hide_it() -> None:
    """The vertices next to the landmark follow it; those around them do not."""
    answer, there = carried(MESH), ROWS.copy()
    there[1] = FAR
    near = np.linalg.norm(MESH.vertices - MESH.vertices[700], axis=1) < 0.05 * np.sqrt(MESH.area)
    images = np.where(near, FAR, np.arange(MESH.n_vertices))
    torn = Correspondence.from_points(MESH, SurfacePoints.at_vertices(answer.target, images))
    np.testing.assert_allclose(gaps(torn, there), gaps(answer, there), atol=1e-9)


def test_what_is_not_valid_has_no_say_and_nothing_is_said_where_nothing_is() -> None:
    valid = np.linalg.norm(MESH.vertices - MESH.vertices[700], axis=1) > 0.22 * np.sqrt(MESH.area)
    found = gaps(carried(MESH, valid=valid), ROWS)
    assert np.isnan(found[1]) and np.isfinite(found[[0, 2]]).all()
    assert not found[1] > MISFIT


def test_another_body_around_it_has_no_say() -> None:
    two = joined(MESH, Mesh(1.01 * MESH.vertices, MESH.faces))
    np.testing.assert_allclose(gaps(carried(two), ROWS), 0, atol=1e-9)


def test_right_landmarks_of_a_mirror_image_fit_a_map_that_says_it_reverses() -> None:
    target = Mesh(MESH.vertices * [1.0, -1.0, 1.0], MESH.faces)
    points = SurfacePoints.at_vertices(target, np.arange(MESH.n_vertices))
    answer = Correspondence.from_points(MESH, points, meta={"evidence": {"orientation": -1.0}})
    np.testing.assert_allclose(gaps(answer, ROWS), 0, atol=1e-9)


def test_landmarks_are_called_by_their_names() -> None:
    far = np.array([0.3, 0.1, 0.25])
    assert named(np.array([0, 2]), far, ("nose", "hand", "foot")) == "nose by 0.30, foot by 0.25"
    assert named(np.array([2]), far, ("nose", "hand", "foot")) == "foot by 0.25"


def test_landmarks_without_names_are_called_by_their_vertices() -> None:
    assert place_landmarks([[7, 9], [0, 3]], MESH, MESH).called == ("vertex 7 on vertex 9", "vertex 0 on vertex 3")
    inside = MESH.vertices[MESH.faces[[4, 20]]].mean(axis=1)
    assert place_landmarks(([7, 9], inside), MESH, MESH).called == ("vertex 7", "vertex 9")
    assert place_landmarks((inside, [7, 9]), MESH, MESH).called[1] == "landmark 1 (counted from 0)"
