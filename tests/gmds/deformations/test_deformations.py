"""Deformations do what their names say, and their truth is exact."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
import trimesh
from generated_shapes import ellipsoid, icosphere, joined, rectangle, torus, with_isolated

from geodesics import Mesh, MeshError, SurfacePoints, intrinsic, scale_invariant
from geodesics.errors import BadShape, NotManifold
from geodesics.topology.components import boundary_vertices, vertex_components
from geodesics.topology.edge_paths import edge_distances
from gmds import deformations as d
from gmds.deformations.limbs import extremities
from gmds.shapes import quadruped

EVERY = {
    "local_scaling": lambda m, rng: d.local_scaling(m, d.branch_log_scale(m, 1.6, rng=rng)),
    "global_scale": lambda m, rng: d.global_scale(m, 2.0 + rng),
    "caricature": lambda m, rng: d.caricature(m, 0.2 + 0.1 * rng),
    "similarity": lambda m, rng: d.similarity(m, largest_scale=3, rng=rng),
    "bending": lambda m, rng: d.bending(m, 25, rng=rng),
    "noise": lambda m, rng: d.noise(m, rng=rng),
    "shot_noise": lambda m, rng: d.shot_noise(m, rng=rng),
    "holes": lambda m, rng: d.holes(m, 2, rng=rng),
    "gluing": lambda m, rng: d.gluing(m, 2, rng=rng),
    "cut": lambda m, rng: d.cut(m, 0.3, count=3, rng=rng),
    "scan": lambda m, rng: d.scan(m, rng=rng),
    "remeshing": lambda m, rng: d.remeshing(m, 600, rng=rng),
}
SAME_FACES = ("local_scaling", "global_scale", "caricature", "similarity", "bending", "noise", "shot_noise")


@pytest.fixture(scope="module")
def animal() -> Mesh:
    return quadruped(n_vertices=800)


def edge_lengths(mesh: Mesh) -> np.ndarray:
    return np.sqrt(intrinsic.squared_lengths(mesh.vertices, mesh.faces))


@pytest.mark.parametrize("name", EVERY)
def test_every_deformation_has_one_true_point_per_old_vertex_and_repeats(animal: Mesh, name: str) -> None:
    before = animal.vertices.copy()
    mesh, truth = EVERY[name](animal, 1)
    again, _ = EVERY[name](animal, 1)
    other, _ = EVERY[name](animal, 2)
    assert truth.mesh is mesh and len(truth) == animal.n_vertices
    assert np.isfinite(truth.positions).all() and np.allclose(truth.barycentric.sum(axis=1), 1)
    assert np.array_equal(mesh.vertices, again.vertices) and np.array_equal(mesh.faces, again.faces)
    assert mesh.vertices.shape != other.vertices.shape or not np.array_equal(mesh.vertices, other.vertices)
    assert np.array_equal(before, animal.vertices)
    if name in SAME_FACES:
        assert np.array_equal(mesh.faces, animal.faces) and np.array_equal(truth.positions, mesh.vertices)


@pytest.mark.parametrize("name", [name for name in EVERY if name != "similarity"])
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_deformations_commute_with_a_change_of_unit(animal: Mesh, name: str, scale: float) -> None:
    plain, large = EVERY[name](animal, 1), EVERY[name](Mesh(scale * animal.vertices, animal.faces), 1)
    if name == "remeshing":  # ties between equal edges may fall differently
        assert plain[0].n_vertices == large[0].n_vertices
        assert np.abs(large[1].positions / scale - plain[1].positions).max() < edge_lengths(plain[0]).max()
        return
    assert np.array_equal(plain[0].faces, large[0].faces)
    assert np.allclose(large[0].vertices / scale, plain[0].vertices, atol=1e-6)


def test_the_caricature_of_a_sphere_is_the_sphere_and_of_nothing_the_mesh(animal: Mesh) -> None:
    ball = icosphere(3)
    grown, _ = d.caricature(ball, 0.4)
    assert np.allclose(grown.vertices, ball.vertices, atol=0.02)
    assert np.allclose(d.caricature(animal, 0.0)[0].vertices, animal.vertices, atol=1e-9)


def test_lengths_of_a_caricature_grow_with_curvature_and_its_opposite_undoes_it(animal: Mesh) -> None:
    before = scale_invariant(animal).conformal_factor
    grown, shrunk = d.caricature(animal, 0.3)[0], d.caricature(animal, -0.3)[0]
    for mesh, sign in ((grown, 1), (shrunk, -1)):
        achieved = d.achieved_log_scale(animal, mesh)
        assert sign * np.corrcoef(achieved, np.log(before))[0, 1] > 0.8
    turned, _ = d.caricature(d.similarity(animal, rng=4)[0], 0.3)
    lengths = [edge_lengths(mesh) / np.sqrt(mesh.area) for mesh in (turned, grown)]
    assert np.allclose(*lengths, atol=1e-6)


def test_a_constant_scale_field_is_a_similarity() -> None:
    mesh = ellipsoid(2)
    scaled, _ = d.local_scaling(mesh, np.full(mesh.n_vertices, np.log(3.0)))
    assert np.allclose(edge_lengths(scaled), 3 * edge_lengths(mesh), rtol=1e-6)


def test_a_plane_takes_on_the_scales_of_a_conformal_map_exactly() -> None:
    """z -> z^2 is conformal with scale |2 z|: that field is realised in the plane, up to the mesh's resolution."""
    grid = rectangle(24, 24)
    plane = Mesh(grid.vertices + np.array([1.0, 0.2, 0]), grid.faces)
    z = plane.vertices[:, 0] + 1j * plane.vertices[:, 1]
    scaled, _ = d.local_scaling(plane, np.log(np.abs(2 * z)))
    square = z**2
    exact = Mesh(np.stack([square.real, square.imag, 0 * square.real], axis=1), plane.faces)
    assert np.allclose(edge_lengths(scaled), edge_lengths(exact), rtol=0.02)


def test_branches_grow_and_shrink_by_the_wanted_factor(animal: Mesh) -> None:
    u = d.branch_log_scale(animal, 2.0, count=3, rng=1)
    scaled, _ = d.local_scaling(animal, u)
    achieved = d.achieved_log_scale(animal, scaled)
    assert u.max() > 0.6 and u.min() < -0.6 and np.median(np.abs(u)) < 0.05  # parts only
    assert np.sqrt(np.mean((achieved - u) ** 2)) < 0.03 and np.abs(achieved - u).max() < 0.2


def test_local_scaling_turns_with_the_mesh(animal: Mesh) -> None:
    turned, _ = d.similarity(animal, rng=4)
    u = d.branch_log_scale(animal, 1.7, rng=2)
    a, b = d.local_scaling(animal, u)[0], d.local_scaling(turned, u)[0]
    assert np.allclose(edge_lengths(a), edge_lengths(b), rtol=1e-3)


def test_bending_moves_limbs_and_keeps_lengths(animal: Mesh) -> None:
    bent, _ = d.bending(animal, 35, rng=1)
    stretch = np.abs(np.log(edge_lengths(bent) / edge_lengths(animal)))
    assert stretch.mean() < 0.02
    assert np.linalg.norm(bent.vertices - animal.vertices, axis=1).max() > 3 * edge_lengths(animal).mean()


def test_similarity_keeps_ratios_and_orientation(animal: Mesh) -> None:
    moved, _ = d.similarity(animal, largest_scale=5, rng=2)
    ratio = edge_lengths(moved) / edge_lengths(animal)
    assert np.allclose(ratio, ratio[0, 0]) and 0.2 <= ratio[0, 0] <= 5
    tetrahedron = [0, 200, 400, 600]
    volumes = [np.linalg.det(m.vertices[tetrahedron[1:]] - m.vertices[tetrahedron[0]]) for m in (animal, moved)]
    assert volumes[0] * volumes[1] > 0


def test_noise_has_the_wanted_strength_along_the_normal() -> None:
    sphere = icosphere(4)
    noisy, _ = d.noise(sphere, 0.3)
    height = np.linalg.norm(noisy.vertices, axis=1) - 1
    assert height.std() / edge_lengths(sphere).mean() == pytest.approx(0.3, rel=0.1)
    direction = noisy.vertices / np.linalg.norm(noisy.vertices, axis=1, keepdims=True)
    assert np.abs(direction - sphere.vertices).max() < 0.01


def test_shot_noise_hits_a_share_of_the_vertices() -> None:
    sphere = icosphere(3)
    hit, _ = d.shot_noise(sphere, 2.0, share=0.05)
    height = np.abs(np.linalg.norm(hit.vertices, axis=1) - 1) / edge_lengths(sphere).mean()
    assert (height > 1e-9).sum() == round(0.05 * sphere.n_vertices)
    assert height.max() <= 2.0 + 1e-9 and height[height > 1e-9].min() > 0.9


def test_holes_lose_exactly_the_vertices_that_are_gone(animal: Mesh) -> None:
    cut, truth = d.holes(animal, 3, radius=0.06)
    gap = np.linalg.norm(truth.positions - animal.vertices, axis=1)
    kept = gap == 0
    assert kept.sum() == cut.n_vertices < animal.n_vertices
    assert np.array_equal(animal.vertices[kept], cut.vertices)  # in the old order
    assert boundary_vertices(cut).any() and vertex_components(cut).max() == 0
    assert np.array_equal(truth.nearest_vertices()[kept], np.arange(cut.n_vertices))


def test_holes_of_radius_zero_cut_single_rings() -> None:
    sphere = icosphere(3)
    cut, _ = d.holes(sphere, 1, radius=0)
    assert sphere.n_vertices - cut.n_vertices == 1 and sphere.n_faces - cut.n_faces in (5, 6)


def test_holes_that_leave_nothing_are_refused() -> None:
    with pytest.raises(ValueError, match="leave nothing"):
        d.holes(icosphere(1), 3, radius=5)


def test_gluing_makes_far_vertices_one(animal: Mesh) -> None:
    glued, truth = d.gluing(animal, 2)
    assert glued.n_vertices == animal.n_vertices - 2 and glued.n_faces == animal.n_faces
    number = truth.nearest_vertices()
    assert (np.bincount(number) == 2).sum() == 2
    assert np.array_equal(number[animal.faces], glued.faces)


def test_remeshing_keeps_the_surface_and_changes_the_triangles() -> None:
    smooth = ellipsoid(3)
    new, truth = d.remeshing(smooth)
    assert (new.n_vertices, new.n_faces) == (smooth.n_vertices, smooth.n_faces)
    gap = np.linalg.norm(truth.positions - smooth.vertices, axis=1)
    edge = edge_lengths(smooth).mean()
    assert (
        gap.max() < edge**2
    )  # chords below a surface of curvature radius 1 / 2 and more: edge^2 / 8 R for each of the two meshes
    assert gap.mean() < 0.06 * edge
    assert (truth.barycentric.max(axis=1) < 0.99).mean() > 0.8
    corner = np.degrees(intrinsic.angles(intrinsic.squared_lengths(new.vertices, new.faces)))
    assert np.percentile(corner, 1) > 30


def test_remeshing_keeps_topology_and_boundary() -> None:
    ring, _ = d.remeshing(torus(), 500)
    assert ring.n_faces == 2 * ring.n_vertices == 1000
    sheet, truth = d.remeshing(rectangle(15, 15))
    assert boundary_vertices(sheet).any() and vertex_components(sheet).max() == 0
    assert np.abs(sheet.vertices[:, 2]).max() < 1e-12
    assert np.linalg.norm(truth.positions - rectangle(15, 15).vertices, axis=1).max() < 0.07


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_adaptive_remeshing_keeps_what_is_thin(animal: Mesh, size: float) -> None:
    coarse = Mesh(size * animal.vertices, animal.faces)
    (even, _), (new, truth) = d.remeshing(coarse, 400), d.remeshing(coarse, 400, adaptive=True)
    assert even.n_vertices == new.n_vertices == 400
    assert coarse.area - new.area < 0.75 * (coarse.area - even.area)  # limbs lose less of their area
    assert (truth.barycentric.max(axis=1) < 0.99).mean() > 0.8
    sheet, _ = d.remeshing(rectangle(15, 15), adaptive=True)
    assert boundary_vertices(sheet).any() and sheet.area == pytest.approx(rectangle(15, 15).area, rel=0.05)


def test_remeshing_with_a_remesher_of_ones_own(animal: Mesh) -> None:
    new, truth = d.remeshing(animal, remesher=lambda m: Mesh(m.vertices, m.faces[::-1]))
    assert np.allclose(truth.positions, animal.vertices) and np.array_equal(new.faces[0], animal.faces[-1])


def test_compose_carries_truth_exactly_where_faces_stay(animal: Mesh) -> None:
    steps = d.compose(partial(d.global_scale, factor=2.0), d.noise, partial(d.similarity, rng=3))
    mesh, truth = steps(animal)
    assert np.array_equal(truth.positions, mesh.vertices)


def test_compose_carries_truth_through_remeshing(animal: Mesh) -> None:
    steps = d.compose(d.remeshing, partial(d.global_scale, factor=2.0), partial(d.remeshing, n_vertices=700))
    mesh, truth = steps(animal)
    assert mesh.n_vertices == 700 and len(truth) == animal.n_vertices
    gap = np.linalg.norm(truth.positions / 2 - animal.vertices, axis=1)
    assert gap.mean() < 0.4 * edge_lengths(animal).mean()  # legs are one edge thick at this resolution


def test_compose_of_nothing_is_the_identity(animal: Mesh) -> None:
    mesh, truth = d.compose()(animal)
    assert np.array_equal(mesh.vertices, animal.vertices) and np.array_equal(truth.positions, animal.vertices)


def test_points_inside_faces_are_carried(animal: Mesh) -> None:
    inside = SurfacePoints(animal, np.arange(50), np.full((50, 3), 1 / 3))
    truth = d.global_scale(animal, 3.0)[1]
    assert np.allclose(d.carried(inside, truth).positions, 3 * inside.positions)
    lost = d.holes(animal, 1, radius=0)[1]
    carried = d.carried(inside, lost)
    assert np.median(np.linalg.norm(carried.positions - inside.positions, axis=1)) < 1e-12


def test_deformations_of_two_pieces_stay_finite() -> None:
    pair = joined(icosphere(2), ellipsoid(2))
    for name in ("local_scaling", "bending", "noise", "gluing", "holes"):
        mesh, truth = EVERY[name](pair, 1)
        assert np.isfinite(mesh.vertices).all() and len(truth) == pair.n_vertices


def test_mistakes_are_refused(animal: Mesh) -> None:
    with pytest.raises(BadShape, match="one per vertex"):
        d.local_scaling(animal, np.zeros(3))
    with pytest.raises(BadShape, match="same faces"):
        d.achieved_log_scale(animal, icosphere(1))
    with pytest.raises(ValueError, match="factor must be positive"):
        d.global_scale(animal, -1)
    with pytest.raises(ValueError, match="at least 1"):
        d.similarity(animal, largest_scale=0.5)
    with pytest.raises(ValueError, match="at least 12"):
        d.remeshing(animal, 5)
    fins = Mesh(np.vstack([np.eye(3), -np.eye(3)]), [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    with pytest.raises(NotManifold):
        d.remeshing(fins, 20)
    with pytest.raises(MeshError, match="is on no face"):
        d.noise(with_isolated(icosphere(1)))


def test_extremities_are_tips_whatever_the_pose_of_the_mesh(animal: Mesh) -> None:
    tips, middle = extremities(animal)
    rest = animal.rest  # type: ignore[attr-defined]
    for place in ([1.42, 0, 1.46], [-1.5, 0, 1.3], [0.6, 0.2, 0.03], [0.6, -0.2, 0.03], [0.93, 0.2, 1.98]):
        assert np.linalg.norm(rest[tips] - place, axis=1).min() < 0.25, place
    assert abs(rest[middle, 0]) < 0.3  # the trunk
    turned, _ = d.similarity(animal, largest_scale=4, rng=3)
    assert np.array_equal(extremities(turned)[0], tips)


def test_edge_distances_are_never_shorter_than_straight_lines(animal: Mesh) -> None:
    distance = edge_distances(animal, np.array([0, 5]))
    straight = np.linalg.norm(animal.vertices[[0, 5]][:, None] - animal.vertices[None], axis=2)
    assert (distance >= straight - 1e-12).all() and distance[0, 5] == pytest.approx(distance[1, 0])
    pair = joined(icosphere(1), icosphere(1))
    assert np.isinf(edge_distances(pair, np.array([0]))[0]).sum() == pair.n_vertices // 2


@pytest.mark.parametrize(
    "name", ["bending", "caricature", "noise", "remeshing", "similarity", "cut", "holes", "shot_noise"]
)
def test_mesh_objects_of_other_libraries_are_taken(name: str) -> None:
    sphere = trimesh.creation.icosphere(2)
    ours, theirs = (getattr(d, name)(mesh)[0] for mesh in (Mesh(sphere.vertices, sphere.faces), sphere))
    np.testing.assert_array_equal(ours.vertices, theirs.vertices)
    with pytest.raises(TypeError, match="a mesh is expected, not str"):
        getattr(d, name)("sphere.ply")
