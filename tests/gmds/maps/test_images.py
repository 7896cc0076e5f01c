"""Maps made of maps: the inverse, one after another, and where points between the vertices go."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, ellipsoid, icosphere, joined, moved, subdivided
from known_maps import identity, subvertex_map

from geodesics import Mesh, SurfacePoints
from geodesics.closest import closest_on_triangles
from gmds.correspondence import Correspondence
from gmds.errors import MapError
from gmds.maps.images import image, preimage
from gmds.maps.point_map import MatchStatus

RNG = np.random.default_rng(5)


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
    assert not nothing.valid.any() and len(nothing.points) == target.n_vertices


def test_inverse_of_a_map_between_sizes() -> None:
    """Nothing is stretched when everything is."""
    mesh = bumpy_sphere(2)
    for scale in (1e-3, 1e3):
        small = Mesh(scale * mesh.vertices, mesh.faces)
        answer = Correspondence.from_points(small, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))
        back = answer.inverse()
        assert back.valid.all() and (back.vertex_map() == np.arange(mesh.n_vertices)).all()


def test_what_is_stretched_a_lot_and_long_is_torn_but_not_one_of_the_two() -> None:
    """A cap that was small: its triangles go far apart in a coarse mesh, and not far in a fine one."""
    for fineness, shrunk, whole in ((1, 0.05, False), (1, 0.4, True), (3, 0.05, True)):
        mesh = icosphere(fineness)
        pole = mesh.vertices[0]
        cap = mesh.vertices @ pole > 0.8
        before = np.where(cap[:, None], pole + shrunk * (mesh.vertices - pole), mesh.vertices)
        answer = Correspondence.from_points(
            Mesh(before, mesh.faces), SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
        )
        back = answer.inverse()
        assert back.valid[0] == whole and back.valid.all() == whole
        np.testing.assert_allclose(back.points.positions[back.valid], before[back.valid], atol=1e-12)


def test_inverse_tells_distortion_status_and_meta() -> None:
    """A sphere lies inside a finer one: images are a little off, and that adds to the distortion."""
    coarse, fine = icosphere(1), icosphere(2)
    n = coarse.n_vertices
    at = SurfacePoints.at_vertices(fine, np.arange(n))  # the finer one begins with the vertices of the coarser
    told = np.linspace(0.1, 0.2, n)
    answer = Correspondence(coarse, fine, at, np.ones(n, bool), told, MatchStatus.POOR, (), {"seed": 3})
    back = answer.inverse()
    off = np.linalg.norm(fine.vertices - back.points.positions, axis=1) / np.sqrt(fine.area)
    assert off.max() > 0.005
    np.testing.assert_allclose(back.distortion, back.points.interpolate(told) + off)
    assert (back.status, back.meta) == (MatchStatus.POOR, {"seed": 3})
    nothing = Correspondence(coarse, fine, at, np.zeros(n, bool), told).inverse()
    assert (nothing.distortion == 1).all()
    some, gap = preimage(answer, [40, 7])
    assert np.array_equal(some.positions, back.points.positions[[40, 7]]) and np.allclose(gap, off[[40, 7]])


def test_a_target_vertex_on_no_face_has_no_source_even_on_the_surface() -> None:
    mesh = icosphere(2)
    target = Mesh(np.vstack([mesh.vertices, mesh.vertices[mesh.faces[5]].mean(axis=0)]), mesh.faces)
    back = Correspondence.from_points(mesh, SurfacePoints.at_vertices(target, np.arange(mesh.n_vertices))).inverse()
    assert np.flatnonzero(~back.valid).tolist() == [mesh.n_vertices]


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


def test_the_image_of_a_point_minds_only_corners_that_have_weight() -> None:
    mesh = icosphere(2)
    corner = mesh.faces[7]
    valid = np.arange(mesh.n_vertices) != corner[2]
    answer = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)), valid=valid)
    points = SurfacePoints(mesh, [7] * 4, [[1, 0, 0], [0.5, 0.5, 0], [0.5, 0.4, 0.1], [0, 0, 1]])
    found, there, _ = image(answer, points)
    np.testing.assert_allclose(found.positions, points.positions, atol=1e-12)
    assert there.tolist() == [True, True, False, False]
    with pytest.raises(MapError, match="same object"):
        image(answer, SurfacePoints(icosphere(2), [7], [[1, 0, 0]]))


def test_what_lies_on_one_face_follows_exactly_and_what_does_not_lies_on_the_surface() -> None:
    """Even where another sheet of the target lies in the same place."""
    mesh, rng = icosphere(2), np.random.default_rng(0)
    weights = rng.dirichlet(np.ones(3), 3)
    sheets = joined(mesh, mesh, gap=0)
    for face in (11, 11 + mesh.n_faces):
        barycentric = np.tile([1.0, 0, 0], (mesh.n_vertices, 1))
        barycentric[mesh.faces[7]] = weights
        answer = Correspondence.from_points(mesh, SurfacePoints(sheets, [face] * mesh.n_vertices, barycentric))
        found, _, _ = image(answer, SurfacePoints(mesh, [7], [[0.2, 0.3, 0.5]]))
        assert found.face.tolist() == [face]
        np.testing.assert_allclose(found.barycentric[0], np.array([0.2, 0.3, 0.5]) @ weights, atol=1e-15)
    fine = icosphere(3)  # begins with the vertices of the coarser one
    onto = Correspondence.from_points(mesh, SurfacePoints.at_vertices(fine, np.arange(mesh.n_vertices)))
    points = SurfacePoints(mesh, rng.integers(0, mesh.n_faces, 200), rng.dirichlet(np.ones(3), 200))
    nearest = SurfacePoints.closest(fine, points.positions).positions
    np.testing.assert_allclose(image(onto, points)[0].positions, nearest, atol=1e-9)


@pytest.mark.parametrize("order", [1, -1])
def test_a_map_made_of_maps_is_trusted_as_the_worse_one(order: int) -> None:
    mesh = icosphere(1)
    at = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    statuses = (MatchStatus.GOOD, MatchStatus.AMBIGUOUS)[::order]
    one, two = (Correspondence.from_points(mesh, at, status=status) for status in statuses)
    assert one.compose(two).status is MatchStatus.AMBIGUOUS
