"""The answer object: its guarantees, and values carried along."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import icosphere, with_isolated
from known_maps import identity, subvertex_map

from geodesics import Mesh, SurfacePoints
from gmds.correspondence import Correspondence
from gmds.errors import MapError
from gmds.maps.point_map import Candidate, MatchStatus

RNG = np.random.default_rng(5)


def random_points(mesh: Mesh, count: int) -> SurfacePoints:
    return SurfacePoints(mesh, RNG.integers(0, mesh.n_faces, count), RNG.dirichlet(np.ones(3), count))


def test_one_row_per_source_vertex() -> None:
    source, target = icosphere(1), icosphere(2)
    points = random_points(target, source.n_vertices - 1)
    with pytest.raises(MapError, match=r"41 rows.*42 vertices"):
        Correspondence(source, target, points, np.ones(42, bool), np.zeros(42))
    points = random_points(target, 42)
    with pytest.raises(MapError, match="valid has 3 rows"):
        Correspondence(source, target, points, np.ones(3, bool), np.zeros(42))
    with pytest.raises(MapError, match="another mesh"):
        Correspondence(source, source, points, np.ones(42, bool), np.zeros(42))


def test_nothing_that_is_not_finite_gets_in() -> None:
    source, target = icosphere(1), icosphere(2)
    points = random_points(target, 42)
    distortion = np.zeros(42)
    distortion[7] = np.nan
    with pytest.raises(MapError, match="distortion of row 7"):
        Correspondence(source, target, points, np.ones(42, bool), distortion)


def test_arrays_are_frozen_copies() -> None:
    source = icosphere(1)
    valid = np.ones(42, dtype=bool)
    answer = Correspondence.from_points(source, random_points(source, 42), valid=valid)
    valid[0] = False
    assert answer.valid[0]
    with pytest.raises(ValueError, match="read-only"):
        answer.valid[0] = False


def test_vertices_on_no_face_are_not_valid() -> None:
    source = with_isolated(icosphere(1))
    answer = Correspondence.from_points(source, random_points(icosphere(2), source.n_vertices))
    assert (~answer.valid).sum() == 3
    assert np.isnan(answer.stress)  # nobody measured it


def test_every_status_is_a_sentence_and_ranked() -> None:
    assert all(status.value.endswith(".") and " " in status.value for status in MatchStatus)
    assert MatchStatus.GOOD.rank < MatchStatus.AMBIGUOUS.rank < MatchStatus.POOR.rank


def test_vertex_map_is_the_heaviest_corner() -> None:
    target = icosphere(2)
    points = SurfacePoints(target, [3, 8, 8], [[0.2, 0.7, 0.1], [0.1, 0.3, 0.6], [1, 0, 0]])
    answer = Correspondence.from_points(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), points)
    assert answer.vertex_map().tolist() == [target.faces[3, 1], target.faces[8, 2], target.faces[8, 0]]


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.complex128])
def test_linear_functions_are_transferred_exactly(dtype: type) -> None:
    answer, source, target = subvertex_map()
    direction = np.array([0.3, -1, 2])
    moved_values = answer.transfer((target.vertices @ direction).astype(dtype))
    assert moved_values.dtype == dtype
    np.testing.assert_allclose(moved_values, source.vertices @ direction, atol=1e-6)
    np.testing.assert_allclose(answer.transfer(target.vertices), source.vertices, atol=1e-12)


def test_labels_keep_their_dtype_and_the_majority_wins() -> None:
    target = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    points = SurfacePoints(target, [0, 0, 0], [[0.4, 0.3, 0.3], [0.5, 0.3, 0.2], [0.2, 0.2, 0.6]])
    answer = Correspondence.from_points(target, points)
    assert answer.transfer(np.array([7, 9, 9], dtype=np.int16)).tolist() == [9, 7, 9]  # 0.6 against 0.4; a tie; 0.8
    assert answer.transfer(np.array([7, 9, 9], dtype=np.int16)).dtype == np.int16
    assert answer.transfer(np.array(["leg", "arm", "arm"])).tolist() == ["arm", "leg", "arm"]
    assert answer.transfer(np.array([True, False, False])).dtype == bool
    assert answer.transfer(np.array([7, 9, 9]), labels=False).tolist() == pytest.approx([8.2, 8.0, 8.6])


def test_colours_are_blended_and_stay_bytes() -> None:
    target = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    points = SurfacePoints(target, [0, 0, 0], np.array([[0.5, 0.5, 0], [0, 1, 0], [1, 1, 1]]) / [[1], [1], [3]])
    colours = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], dtype=np.uint8)
    moved_colours = Correspondence.from_points(target, points).transfer(colours)
    assert moved_colours.dtype == np.uint8
    assert moved_colours.tolist() == [[128, 128, 0], [0, 255, 0], [85, 85, 85]]


def test_a_corner_of_weight_zero_has_no_say() -> None:
    target = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    answer = Correspondence.from_points(target, SurfacePoints(target, [0] * 3, [[0, 0.5, 0.5]] * 3))
    assert answer.transfer(np.array([np.nan, 1.0, 3.0])).tolist() == [2.0] * 3


def test_fill_marks_rows_without_counterpart() -> None:
    mesh = icosphere(1)
    valid = np.arange(42) % 2 == 0
    answer = Correspondence.from_points(mesh, random_points(mesh, 42), valid=valid)
    assert (answer.transfer(np.arange(42), fill=-1)[~valid] == -1).all()


def test_transfer_names_the_wrong_count() -> None:
    mesh = icosphere(1)
    with pytest.raises(MapError, match=r"41 rows.*42 vertices"):
        identity(mesh).transfer(np.zeros(41))
    with pytest.raises(MapError, match="a single value"):
        identity(mesh).transfer(3.0)


def test_candidates_are_a_tuple_of_maps() -> None:
    mesh = icosphere(1)
    other = Candidate(random_points(mesh, 42), stress=0.5, orientation=-0.7)
    answer = Correspondence.from_points(mesh, random_points(mesh, 42), candidates=[other])
    assert answer.candidates == (other,)
