"""Landmarks, sample counts and option names at the door of the matcher (rows V17-V20 of the reliability table)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, with_isolated

from geodesics import Mesh, SurfacePoints
from gmds.errors import LandmarkError, SampleCountError, UnknownKey
from gmds.landmarks.checking import check_landmarks, place_landmarks
from gmds.landmarks.soft import SoftLandmarks
from gmds.matching.pipeline import check_sample_count
from gmds.suggestions import check_keys, suggest_keywords

A, B = bumpy_sphere(2), icosphere(2)
PAIRS = np.array([[3, 5], [10, 1], [20, 30]])
LONELY = with_isolated(icosphere(1))  # its first vertex is on no face


def on_faces(mesh: Mesh, vertices: Any) -> Any:
    """Rows of a face and three weights."""
    points = SurfacePoints.at_vertices(mesh, vertices)
    return np.column_stack([points.face, points.barycentric])


@pytest.mark.parametrize(
    "given",
    [
        PAIRS,
        PAIRS.tolist(),
        PAIRS.astype(float),
        (PAIRS[:, 0], PAIRS[:, 1]),
        (PAIRS[:, 0].tolist(), PAIRS[:, 1].tolist()),
        [PAIRS[:, 0], PAIRS[:, 1]],
        (A.vertices[PAIRS[:, 0]], B.vertices[PAIRS[:, 1]]),
        (A.vertices[PAIRS[:, 0]].tolist(), B.vertices[PAIRS[:, 1]].tolist()),
        (A.vertices[PAIRS[:, 0]], PAIRS[:, 1]),
        (SurfacePoints.at_vertices(A, PAIRS[:, 0]), PAIRS[:, 1]),
        (on_faces(A, PAIRS[:, 0]), on_faces(B, PAIRS[:, 1])),
        SoftLandmarks(PAIRS),
        SoftLandmarks((PAIRS[:, 0], B.vertices[PAIRS[:, 1]]), 0.1),
    ],
)
def test_every_form_gives_the_same_points(given: Any) -> None:
    on_a, on_b = check_landmarks(given, A, B)
    assert on_a.mesh is A and on_b.mesh is B
    assert np.allclose(on_a.positions, A.vertices[PAIRS[:, 0]], atol=1e-12)
    assert np.allclose(on_b.positions, B.vertices[PAIRS[:, 1]], atol=1e-12)


def test_two_by_two_lists_are_pairs_and_two_arrays_are_sides() -> None:
    as_pairs = check_landmarks([[3, 5], [10, 1]], A, B)
    assert as_pairs[0].nearest_vertices().tolist() == [3, 10]
    as_sides = check_landmarks((np.array([3, 10]), np.array([5, 1])), A, B)
    assert as_sides[0].nearest_vertices().tolist() == [3, 10]


REFUSED: list[tuple[str, Any, str]] = [
    ("E301", [[3, 5], [A.n_vertices, 1]], "landmark 1"),
    ("E301", [[3, 5], [10, -1]], "landmark 1"),
    ("E301", [[3, 5], [10, 2**62]], "target"),
    ("E302", [[3, 5], [10, 1], [3, 7]], "landmark 0 (counted from 0) and landmark 2"),
    ("E302", [[3, 5], [10, 5]], "of the target"),
    ("E302", (A.vertices[[1, 2, 1]], [1, 2, 3]), "of the source"),
    ("E303", (np.arange(4), np.arange(3)), "4 landmarks on the source but 3"),
    ("E305", (A.vertices[[1, 2]] + [[0, 0, 0], [0, 0, 9]], [1, 2]), "landmark 1"),
    ("E300", np.ma.masked_equal(PAIRS, 3), "indices or positions"),
    ("E300", (np.zeros((2, 5)), [1, 2]), "(k, 4), not (2, 5)"),
    ("E300", (np.zeros((1, 1, 3)), [1]), "(k, 4), not (1, 1, 3)"),
    ("E300", "nose", "indices or positions"),
    ("E300", [], "(k, 2)"),
    ("E300", [[1, 2, 3], [4, 5, 6], [7, 8, 9]], "(k, 2)"),
    ("E300", [[0.5, 1]], "whole numbers"),
    ("E300", [[np.nan, 1]], "whole numbers"),
    ("E300", (A.vertices[[1, 2]] * np.nan, [1, 2]), "E101"),
    ("E303", [[1, 2], [3]], "2 landmarks on the source but 1"),
    ("E300", [[1, 2], [3], [4, 5]], "rectangular"),
    ("E300", (SurfacePoints.at_vertices(B, [1, 2]), [1, 2]), "another mesh"),
    ("E300", {"nose": 3}, "indices or positions"),
    ("E301", ([[0, 1, 0, 0], [A.n_faces, 1, 0, 0]], [1, 2]), "faces 0 to 319"),
    *[("E301", ([[face, 1, 0, 0]], [1]), "the source has faces") for face in (0.5, -1, np.nan, np.inf)],
    ("E300", ([[0, 0.7, 0.7, 0]], [1]), "barycentric weights of the source"),
    ("E302", ([[0, 0.5, 0.5, 0], [0, 0.5, 0.5, 0]], [1, 2]), "landmark 0 (counted from 0) and landmark 1"),
    ("E300", SoftLandmarks(PAIRS, [0.1, 0.2]), "or 3 of them"),
    ("E300", SoftLandmarks(PAIRS, -0.1), "0 or a positive number"),
    ("E300", SoftLandmarks(PAIRS, np.nan), "0 or a positive number"),
    ("E300", SoftLandmarks(PAIRS, np.inf), "0 or a positive number"),
    ("E300", SoftLandmarks(PAIRS, "soft"), "must be a number"),
    ("E301", SoftLandmarks([[3, 5], [A.n_vertices, 1]]), "landmark 1"),
]


@pytest.mark.parametrize(("code", "given", "says"), REFUSED)
def test_v17_v18_refused(code: str, given: Any, says: str) -> None:
    with pytest.raises(LandmarkError) as caught:
        check_landmarks(given, A, B)
    assert caught.value.code == code
    assert str(caught.value).startswith(code) and says in str(caught.value)


def test_v17_a_vertex_on_no_face() -> None:
    with pytest.raises(LandmarkError, match=r"E304: landmark 1 \(counted from 0\): vertex 0 of the source"):
        check_landmarks([[1, 1], [0, 2]], LONELY, B)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_v18_positions_near_the_surface_are_moved_to_it_and_the_move_is_told(scale: float) -> None:
    a = Mesh(scale * B.vertices, B.faces)
    index = np.array([4, 40, 90])
    lifted = a.vertices[index] * [[1.02], [1.0], [1.0]]
    placed = place_landmarks((lifted, index), a, B)
    assert np.linalg.norm(placed.on_source.positions - a.vertices[index], axis=1).max() < 0.03 * scale
    assert [note.code for note in placed.notes] == ["W301"] and placed.notes[0].indices == (0,)
    assert place_landmarks((a.vertices[index], index), a, B).notes == ()


def test_v18_five_percent_of_the_diagonal_of_the_surface_is_the_most() -> None:
    """Vertices on no face are no part of the surface."""
    for mesh in (icosphere(2), with_isolated(icosphere(2))):
        index = mesh.faces[5]
        diagonal = np.linalg.norm(np.ptp(mesh.vertices[mesh.faces], axis=(0, 1)))
        out = mesh.vertices[index] / np.linalg.norm(mesh.vertices[index], axis=1, keepdims=True) * diagonal
        placed = place_landmarks((index, mesh.vertices[index] + [[0.049], [0], [0.02]] * out), mesh, mesh)
        assert placed.notes[0].indices == (0, 2) and "by up to 4.90% of" in placed.notes[0].message
        assert "of the target" in placed.notes[0].message
        with pytest.raises(LandmarkError, match=r"E305: landmark 1 \(counted from 0\) lies 5\.1%"):
            place_landmarks((index, mesh.vertices[index] + [[0.049], [0.051], [0.0]] * out), mesh, mesh)


def test_tolerances_are_one_each() -> None:
    assert place_landmarks(SoftLandmarks(PAIRS, 0.1), A, B).tolerance.tolist() == [0.1] * 3
    assert place_landmarks(SoftLandmarks(PAIRS, [0, 0.2, 0.3]), A, B).tolerance.tolist() == [0, 0.2, 0.3]
    assert place_landmarks(PAIRS, A, B).tolerance.tolist() == [0] * 3
    assert (place_landmarks(SoftLandmarks(PAIRS), A, B).tolerance > 0).all()
    assert np.isfinite(place_landmarks(SoftLandmarks(PAIRS, 1e300), A, B).tolerance ** 2).all()


def test_the_last_face_and_the_last_vertex_carry_landmarks() -> None:
    given = ([[A.n_faces - 1, 0.5, 0.5, 0]], [B.n_vertices - 1])
    on_a, on_b = check_landmarks(given, A, B)
    assert on_a.face.tolist() == [A.n_faces - 1] and on_b.nearest_vertices().tolist() == [B.n_vertices - 1]


@pytest.mark.parametrize("wrong", [0, -1, 2, B.n_vertices + 1, 10**30, 5.0, "5", True, None, np.nan, np.float64(5)])
def test_v19_sample_counts_are_refused_never_clamped(wrong: Any) -> None:
    with pytest.raises(SampleCountError, match=rf"E401.*3 to {B.n_vertices}"):
        check_sample_count(wrong, B)


def test_v19_the_range_counts_vertices_on_faces() -> None:
    assert check_sample_count(np.int32(3), B) == 3
    assert check_sample_count(LONELY.n_vertices - 3, LONELY) == LONELY.n_vertices - 3
    with pytest.raises(SampleCountError):
        check_sample_count(LONELY.n_vertices - 2, LONELY)


def test_v20_did_you_mean() -> None:
    @suggest_keywords
    def match(source: int, target: int, *, n_samples: int = 1, landmarks: int = 0) -> int:
        """A stand-in."""
        return source + target + n_samples

    assert match(1, target=2, n_samples=3) == 6
    assert match.__doc__ == "A stand-in."
    with pytest.raises(TypeError, match=r"match\(\) has no argument 'n_sample'; did you mean 'n_samples'"):
        match(1, 2, n_sample=3)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="there are source, target, n_samples, landmarks"):
        match(1, 2, zzz=3)  # type: ignore[call-arg]
    check_keys(["loss"], ["loss", "metric"], "the configuration")
    with pytest.raises(UnknownKey, match="E601: the configuration has no key 'metrc'; did you mean 'metric'"):
        check_keys(["loss", "metrc"], ["loss", "metric"], "the configuration")
