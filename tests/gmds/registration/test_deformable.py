"""A surface as registration sees it: simplified, closest points, what moves with it."""

from __future__ import annotations

from collections.abc import Callable

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, surface
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints
from geodesics.closest import closest_on_triangles
from geodesics.curvature import vertex_normals
from geodesics.intrinsic import areas, squared_lengths
from gmds.registration.deformable import NORMAL_WEIGHT, DeformableMesh
from gmds.surface.measured import measure

Array = NDArray[np.float64]
FACES = 300
TURN = Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()
SURFACES: dict[str, Callable[[], Mesh]] = {
    "bumpy": lambda: shapes.bumpy_sphere(3),
    "animal": lambda: animal(n_vertices=900),
    "torus": shapes.torus,
    "disc": lambda: shapes.disc(20),
    "cylinder": lambda: shapes.cylinder(48, 24),
    "isolated vertices": lambda: shapes.with_isolated(shapes.bumpy_sphere(3)),
    "edge of three faces": lambda: finned(shapes.bumpy_sphere(3)),
}


def finned(mesh: Mesh) -> Mesh:
    a, b, _ = mesh.faces[10]
    fin = np.concatenate([mesh.vertices, 1.3 * mesh.vertices[[a]]])
    return Mesh(fin, np.concatenate([mesh.faces, [[a, b, mesh.n_vertices]]]))


def area(mesh: Mesh) -> float:
    return float(areas(squared_lengths(mesh.vertices, mesh.faces)).sum())


def euler_number(mesh: Mesh) -> int:
    pairs = np.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return len(np.unique(mesh.faces)) - len(np.unique(pairs, axis=0)) + mesh.n_faces


def somewhere(mesh: Mesh, count: int = 200, seed: int = 0) -> SurfacePoints:
    rng = np.random.default_rng(seed)
    return SurfacePoints(mesh, rng.integers(0, mesh.n_faces, count), rng.dirichlet(np.ones(3), count))


@pytest.mark.parametrize("name", SURFACES)
def test_an_outline_is_the_surface_in_few_faces(name: str) -> None:
    whole = measure(SURFACES[name]())
    simplified = DeformableMesh.simplified(whole, FACES)
    if name != "edge of three faces":
        assert FACES - 3 <= simplified.mesh.n_faces <= FACES
        assert euler_number(simplified.mesh) == euler_number(whole.mesh)
        assert simplified.boundary.any() == (name in ("disc", "cylinder"))
    assert 0.75 < area(simplified.mesh) < 1.01
    assert simplified.areas.sum() == pytest.approx(1)
    assert (simplified.areas > 0).all() or name == "edge of three faces"
    _, _, gap = closest_on_triangles(simplified.mesh.vertices, whole.mesh.vertices, whole.mesh.faces)
    assert gap.max() < 0.04  # in root areas; an edge is 0.1


@pytest.mark.parametrize("name", SURFACES)
def test_the_vertices_of_an_outline_stand_for_vertices_nearby_that_face_the_same_way(name: str) -> None:
    whole = measure(SURFACES[name]())
    simplified = DeformableMesh.simplified(whole, FACES)
    assert np.isin(simplified.origin, whole.regular.usable).all()
    place = whole.mesh.vertices[simplified.origin]
    assert np.linalg.norm(place - simplified.mesh.vertices, axis=1).max() < 0.06
    same = (vertex_normals(whole.mesh)[simplified.origin] * simplified.normals).sum(axis=1)
    assert same.mean() > 0.9 and (same > 0).mean() > 0.98
    assert np.array_equal(simplified.curvature, whole.squashed_curvature[simplified.origin])


@pytest.mark.parametrize("count", [260, 320, 5000])
def test_a_surface_with_few_faces_is_its_own_outline(count: int) -> None:
    mine = surface(bumpy())  # 320 faces
    simplified = DeformableMesh.simplified(mine, count)
    assert simplified.mesh is mine.mesh
    assert np.array_equal(simplified.origin, np.arange(mine.mesh.n_vertices))


def test_outlines_are_the_same_again() -> None:
    mesh = shapes.bumpy_sphere(3)
    one, other = (DeformableMesh.simplified(measure(m), FACES) for m in (mesh, Mesh(mesh.vertices, mesh.faces)))
    assert np.array_equal(one.mesh.vertices, other.mesh.vertices) and np.array_equal(one.mesh.faces, other.mesh.faces)


def test_vertices_on_no_face_are_not_usable() -> None:
    deformable = DeformableMesh.of(measure(shapes.with_isolated(bumpy())))
    assert len(deformable.usable) == bumpy().n_vertices == deformable.mesh.n_vertices - 3
    assert (deformable.areas[deformable.usable] > 0).all()


def test_points_on_a_surface_that_did_not_move_stay() -> None:
    deformable = DeformableMesh.of(surface(bumpy()))
    points = somewhere(deformable.mesh).positions
    assert np.allclose(deformable.deformed(deformable.mesh.vertices, points), points, atol=1e-12)


def test_what_is_carried_goes_with_the_vertices() -> None:
    deformable = DeformableMesh.of(surface(bumpy()))
    points = somewhere(deformable.mesh).positions
    matrix, shift = np.random.default_rng(1).standard_normal((3, 3)), np.array([1.0, 2, 3])
    moved = deformable.deformed(deformable.mesh.vertices @ matrix + shift, points)
    assert np.allclose(moved, points @ matrix + shift, atol=1e-12)


def test_an_outline_carries_the_whole_surface_nearly_to_itself() -> None:
    whole = measure(shapes.bumpy_sphere(3))
    simplified = DeformableMesh.simplified(whole, FACES)
    gap = np.linalg.norm(
        simplified.deformed(simplified.mesh.vertices, whole.mesh.vertices) - whole.mesh.vertices, axis=1
    )
    assert 0 < gap.mean() < 0.01 and gap.max() < 0.03


@pytest.mark.parametrize("name", SURFACES)
def test_features_turn_with_the_surface(name: str) -> None:
    deformable = DeformableMesh.of(measure(SURFACES[name]()))
    x, used = deformable.mesh.vertices, deformable.usable
    still, moved = deformable.moved_features(x), deformable.moved_features(2 * x @ TURN.T + 1)
    assert np.array_equal(still[:, :3], x)
    for normals in (deformable.features[used, 3:] / NORMAL_WEIGHT, vertex_normals(deformable.mesh)[used]):
        same = (still[used, 3:] * normals).sum(axis=1) / NORMAL_WEIGHT
        assert same.mean() > 0.99 and np.mean(same > 0.9) > 0.99  # weighted by area, or by angle: not quite alike
    assert np.allclose(moved[:, :3], 2 * x @ TURN.T + 1)
    assert np.allclose(moved[:, 3:], still[:, 3:] @ TURN.T, atol=1e-12)
    assert np.allclose(np.linalg.norm(moved[used, 3:], axis=1), NORMAL_WEIGHT)


def test_a_surface_squeezed_to_a_point_has_finite_features() -> None:
    deformable = DeformableMesh.of(surface(bumpy()))
    assert np.isfinite(deformable.moved_features(np.zeros_like(deformable.mesh.vertices))).all()


@pytest.mark.parametrize("off", [0.0, 0.02])
def test_closest_points_agree_with_a_search_through_all_faces(off: float) -> None:
    deformable = DeformableMesh.of(surface(bumpy()))
    rows = deformable.mesh.vertices
    queries = somewhere(deformable.mesh).positions
    queries = queries + off * np.random.default_rng(1).standard_normal(queries.shape)
    found = deformable.closest(queries, rows, deformable.places.query(queries)[1])
    gap = np.linalg.norm(found.positions - queries, axis=1)
    least = closest_on_triangles(queries, rows, deformable.mesh.faces)[2]
    assert (gap > least - 1e-12).all()
    assert np.allclose(gap, least, atol=1e-9)


def test_a_guess_an_edge_or_two_away_is_good_enough() -> None:
    deformable = DeformableMesh.of(surface(bumpy()))
    queries, rows = somewhere(deformable.mesh).positions, deformable.mesh.vertices
    guess = deformable.places.query(queries, k=[12])[1].ravel()  # six are on the first ring
    gap = np.linalg.norm(deformable.closest(queries, rows, guess).positions - queries, axis=1)
    assert np.linalg.norm(rows[guess] - queries, axis=1).min() > 0.03
    assert (gap < 1e-9).mean() > 0.97


def test_closest_points_heed_the_side_of_a_thin_sheet() -> None:
    sheet = measure(Mesh(shapes.ellipsoid(3).vertices * [1, 1, 0.01], shapes.ellipsoid(3).faces))
    deformable = DeformableMesh.of(sheet)
    upper = np.flatnonzero(deformable.normals[:, 2] > 0.9)
    below = deformable.features[upper] - [0, 0, 0.02, 0, 0, 0]  # moved to the other side, still facing up
    near = deformable.usable[deformable.tree.query(below)[1]]
    points = deformable.closest(below, deformable.features, near)
    assert (points.interpolate(deformable.normals)[:, 2] > 0).mean() > 0.95
    plain = deformable.closest(below[:, :3], deformable.mesh.vertices, deformable.places.query(below[:, :3])[1])
    assert (plain.interpolate(deformable.normals)[:, 2] > 0).mean() < 0.2


def test_points_on_the_boundary_are_told_from_those_inside() -> None:
    deformable = DeformableMesh.of(measure(shapes.disc(6)))
    mesh, radius = deformable.mesh, np.linalg.norm(deformable.mesh.vertices, axis=1)
    assert np.array_equal(deformable.boundary, np.isclose(radius, radius.max()))
    vertices = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    assert np.array_equal(deformable.on_boundary(vertices), deformable.boundary)
    face = np.flatnonzero(deformable.boundary[mesh.faces].sum(axis=1) == 2)
    middles = SurfacePoints(mesh, face, np.where(deformable.boundary[mesh.faces[face]], 0.5, 0.0))
    assert deformable.on_boundary(middles).all()
    inward = SurfacePoints(mesh, face, np.where(deformable.boundary[mesh.faces[face]], 0.495, 0.01))
    assert not deformable.on_boundary(inward).any()
    assert not DeformableMesh.of(surface(bumpy())).boundary.any()
