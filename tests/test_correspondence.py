"""The answer object: its guarantees, the algebra of maps, and values carried along."""

from __future__ import annotations

import numpy as np
import pytest
from shapes import bumpy_sphere, ellipsoid, icosphere, moved, subdivided, with_isolated

from geodesics import Mesh, SurfacePoints
from geodesics.closest import closest_on_triangles, closest_weights
from gmds.correspondence import Candidate, Correspondence, MatchStatus
from gmds.errors import MapError

RNG = np.random.default_rng(5)


def identity(mesh: Mesh) -> Correspondence:
    return Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))


def subvertex_map(coarse: int = 2) -> tuple[Correspondence, Mesh, Mesh]:
    """The exact map from a subdivided surface to the surface it was cut from: points at vertices and edge midpoints."""
    target = bumpy_sphere(coarse)
    source = subdivided(target)
    face, weights, gap = closest_on_triangles(source.vertices, target.vertices, target.faces)
    assert gap.max() < 1e-12
    return Correspondence.from_points(source, SurfacePoints(target, face, weights)), source, target


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
    with pytest.raises(MapError, match="row 7"):
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


def test_inverse_of_a_permutation_is_the_inverse_permutation() -> None:
    source = bumpy_sphere(2)
    order = RNG.permutation(source.n_vertices)
    rank = np.argsort(order)
    target = Mesh(source.vertices[order], rank[source.faces])
    answer = Correspondence.from_points(source, SurfacePoints.at_vertices(target, rank))
    back = answer.inverse()
    assert back.valid.all()
    assert (back.vertex_map() == order).all()
    np.testing.assert_allclose(back.points.positions, target.vertices, atol=1e-12)
    assert (answer.compose(back).vertex_map() == np.arange(source.n_vertices)).all()


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_inverse_does_not_depend_on_where_the_target_lies_or_how_large_it_is(scale: float) -> None:
    answer, source, target = subvertex_map()
    other = Correspondence.from_points(
        source, SurfacePoints(moved(target, scale), answer.points.face, answer.points.barycentric)
    )
    np.testing.assert_allclose(other.inverse().points.positions, answer.inverse().points.positions, atol=1e-9)


def test_inverse_of_a_subvertex_map_is_subvertex() -> None:
    answer, _, target = subvertex_map()
    np.testing.assert_allclose(answer.inverse().points.positions, target.vertices, atol=1e-12)


def test_inverse_is_not_valid_where_nothing_is_mapped() -> None:
    answer, source, target = subvertex_map()
    half = Correspondence.from_points(source, answer.points, valid=source.vertices[:, 0] > 0)
    back = half.inverse()
    assert back.valid[target.vertices[:, 0] > 0.2].all()
    assert not back.valid[target.vertices[:, 0] < -0.6].any()
    assert np.isfinite(back.points.positions).all()
    nothing = Correspondence.from_points(source, answer.points, valid=np.zeros(source.n_vertices, bool)).inverse()
    assert not nothing.valid.any()
    assert len(nothing.points) == target.n_vertices


def test_torn_triangles_do_not_bridge_the_gap() -> None:
    """The right half goes to where it is, the left half to one point: the fan between them must not fill the sphere."""
    mesh = icosphere(3)
    indices = np.where(mesh.vertices[:, 0] > 0, np.arange(mesh.n_vertices), int(mesh.vertices[:, 0].argmax()))
    back = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, indices)).inverse()
    assert not back.valid[mesh.vertices[:, 0] < -0.5].any()
    assert back.valid[mesh.vertices[:, 0] > 0.2].all()


def test_composition_with_the_identity_changes_nothing() -> None:
    answer, source, target = subvertex_map()
    left, right = identity(source).compose(answer), answer.compose(identity(target))
    for other in (left, right):
        np.testing.assert_allclose(other.points.positions, answer.points.positions, atol=1e-12)
        assert other.valid.all()


def test_composition_is_associative_to_second_order() -> None:
    sphere, middle, end = subdivided(icosphere(2)), icosphere(2), ellipsoid(2)
    face, weights, _ = closest_on_triangles(sphere.vertices, middle.vertices, middle.faces)
    first = Correspondence.from_points(sphere, SurfacePoints(middle, face, weights))
    second = Correspondence.from_points(middle, SurfacePoints.at_vertices(end, np.arange(end.n_vertices)))
    straight = end.vertices[middle.faces[face]]
    expected = np.einsum("pk,pkj->pj", weights, straight)
    np.testing.assert_allclose(first.compose(second).points.positions, expected, atol=1e-12)
    third = identity(end)
    one, two = first.compose(second).compose(third), first.compose(second.compose(third))
    np.testing.assert_allclose(one.points.positions, two.points.positions, atol=1e-12)


def test_composition_across_a_tear_keeps_to_the_heaviest_corner() -> None:
    mesh = icosphere(3)
    corner = mesh.faces[0]
    far = int((mesh.vertices @ mesh.vertices[corner[0]]).argmin())
    indices = np.arange(mesh.n_vertices)
    indices[corner[0]] = far
    second = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, indices))
    points = SurfacePoints(mesh, np.zeros(mesh.n_vertices, int), np.tile([0.4, 0.35, 0.25], (mesh.n_vertices, 1)))
    result = Correspondence.from_points(mesh, points).compose(second)
    assert (result.vertex_map() == far).all()


def test_composition_carries_validity_distortion_and_status() -> None:
    mesh = icosphere(1)
    n = mesh.n_vertices
    at = SurfacePoints.at_vertices(mesh, np.arange(n))
    first = Correspondence(mesh, mesh, at, np.arange(n) != 3, np.full(n, 0.1), MatchStatus.GOOD)
    second = Correspondence(mesh, mesh, at, np.arange(n) != 5, np.full(n, 0.2), MatchStatus.AMBIGUOUS)
    both = first.compose(second)
    assert np.flatnonzero(~both.valid).tolist() == [3, 5]
    np.testing.assert_allclose(both.distortion, 0.3)
    assert both.status is MatchStatus.AMBIGUOUS
    with pytest.raises(MapError, match="same object"):
        first.compose(identity(icosphere(1)))


def test_candidates_are_a_tuple_of_maps() -> None:
    mesh = icosphere(1)
    other = Candidate(random_points(mesh, 42), stress=0.5, orientation=-0.7)
    answer = Correspondence.from_points(mesh, random_points(mesh, 42), candidates=[other])
    assert answer.candidates == (other,)


def test_closest_weights_against_a_dense_search() -> None:
    """Random triangles, and flat ones of every kind: two equal corners, three in a row, all equal."""
    triangles = RNG.standard_normal((60, 3, 3))
    triangles[40:45, 1] = triangles[40:45, 0]
    triangles[45:50, 2] = triangles[45:50, 1]
    triangles[50:55, 2] = 2 * triangles[50:55, 1] - triangles[50:55, 0]
    triangles[55:] = triangles[55:, :1]
    queries = RNG.standard_normal((60, 3)) * 2
    weights = closest_weights(queries, triangles)
    assert (weights >= 0).all()
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    i, j = np.triu_indices(81)
    dense = np.stack([i, j - i, 80 - j], axis=1) / 80
    best = np.linalg.norm(np.einsum("dk,pkj->pdj", dense, triangles) - queries[:, None], axis=2).min(axis=1)
    found = np.linalg.norm(np.einsum("pk,pkj->pj", weights, triangles) - queries, axis=1)
    assert (found <= best + 1e-9).all()
    assert (found >= best - 0.05).all()


def test_degenerate_triangles_do_not_lose_queries() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5.0]])
    faces = np.array([[0, 0, 1], [3, 3, 3], [0, 1, 2]])
    queries = RNG.standard_normal((200, 3)) * 3
    _, weights, gap = closest_on_triangles(queries, vertices, faces)
    assert np.isfinite(weights).all()
    clipped = closest_weights(queries, np.tile(vertices[[0, 1, 2]], (200, 1, 1)))
    at_face = np.linalg.norm(np.einsum("pk,kj->pj", clipped, vertices[:3]) - queries, axis=1)
    np.testing.assert_allclose(gap, np.minimum(at_face, np.linalg.norm(queries - 5, axis=1)), atol=1e-9)
