"""The built-in shapes: well made, posed and scaled as said, with the truth they claim."""

from __future__ import annotations

import pickle

import figures_once
import igl
import numpy as np
import pytest
from numpy.typing import NDArray

from geodesics import Mesh, intrinsic
from gmds import shapes
from gmds.shapes import Figure, Move, humanoid, quadruped, truth
from gmds.shapes.figure import figure as made_anew
from gmds.shapes.humanoid import BODY as PERSON
from gmds.shapes.implicit import blend
from gmds.shapes.marching_cubes import fine_surface
from gmds.shapes.quadruped import BODY as ANIMAL
from gmds.shapes.skeleton import Body

FEW = 1200
EVERY = [(quadruped, ANIMAL, p) for p in shapes.quadruped_poses] + [
    (humanoid, PERSON, p) for p in shapes.humanoid_poses
]


@pytest.fixture(autouse=True)
def nothing_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here every shape is made anew, also one that another test of this run has made."""
    figures_once.use(made_anew, monkeypatch)


def edge_lengths(mesh: Mesh) -> NDArray[np.float64]:
    return np.sqrt(intrinsic.squared_lengths(mesh.vertices, mesh.faces))


def height_above(body: Body, points: NDArray[np.float64]) -> float:
    return float(np.abs(blend(body.parts, points, body.blend_width)).max())


@pytest.mark.parametrize(("make", "body", "pose"), EVERY)
def test_every_pose_is_a_well_shaped_sphere_on_the_smooth_body(make, body: Body, pose: str) -> None:
    figure = make(pose, n_vertices=FEW)
    v, f = figure.vertices, figure.faces
    assert (figure.n_vertices, figure.n_faces) == (FEW, 2 * FEW - 4)  # Euler characteristic 2
    assert igl.is_edge_manifold(f)[0] and np.all(igl.is_vertex_manifold(f))
    assert len(igl.boundary_facets(f)[0]) == 0 and igl.facet_components(f)[0] == 1
    volume = np.einsum("fi,fi->", v[f[:, 0]], np.cross(v[f[:, 1]], v[f[:, 2]])) / 6
    assert volume > 0  # faces look outwards
    corner = np.degrees(intrinsic.angles(intrinsic.squared_lengths(v, f)))
    assert corner.min() > 10 and np.percentile(corner, 1) > 30 and corner.max() < 140
    assert height_above(body, figure.rest) < 1e-9


@pytest.mark.parametrize("body", [ANIMAL, PERSON])
def test_the_undeformed_body_is_its_own_mirror_image(body: Body) -> None:
    vertices, _ = fine_surface(body, 0.025 if body is ANIMAL else 0.0145, 0)
    assert height_above(body, vertices * [1, -1, 1]) < 1e-9
    assert height_above(body, vertices * [-1, 1, 1]) > 0.1  # front is not back
    centre = (vertices[:, 2].min() + vertices[:, 2].max()) / 2
    assert height_above(body, (vertices - [0, 0, centre]) * [1, 1, -1] + [0, 0, centre]) > 0.1  # top is not bottom


def test_shapes_repeat_bit_for_bit() -> None:
    first = quadruped("graze", n_vertices=FEW, seed=3)
    fine_surface.cache_clear()
    second = quadruped("graze", n_vertices=FEW, seed=3)
    assert np.array_equal(first.vertices, second.vertices) and np.array_equal(first.faces, second.faces)


def test_another_seed_is_another_triangulation_of_the_same_surface() -> None:
    a, b = quadruped(n_vertices=3000, seed=0), quadruped(n_vertices=3000, seed=1)
    gap = np.linalg.norm(a.vertices[:, None] - b.vertices[None, :300], axis=2).min(axis=0)
    assert np.median(gap) > 0.2 * edge_lengths(a).mean()  # vertices are elsewhere
    distance = np.linalg.norm(truth(a, b).positions - a.vertices, axis=1)
    assert distance.mean() < 0.05 * edge_lengths(a).mean()  # the surface is not


def test_truth_between_different_figures_is_well_below_an_edge() -> None:
    """The smooth body tells where each source vertex is exactly; the truth is on the target's chords below it."""
    moves = shapes.quadruped_poses["walk"] | {"head": Move((0, 0, 22), 2.0)}
    source, target = quadruped(n_vertices=4000), quadruped(moves, n_vertices=4000, seed=1)
    error = np.linalg.norm(truth(source, target).positions - ANIMAL.pose(source.rest, moves), axis=1)
    edge = edge_lengths(target).mean()
    assert error.mean() < 0.05 * edge and error.max() < edge


def test_truth_of_a_figure_on_itself_is_the_identity() -> None:
    figure = humanoid("kick", n_vertices=FEW)
    assert np.allclose(truth(figure, figure).positions, figure.vertices, atol=1e-12)


def test_the_mirrored_truth_flips_sides_and_orientation() -> None:
    figure = quadruped(n_vertices=FEW)
    flipped = truth(figure, figure, mirrored=True)
    edge = edge_lengths(figure).mean()
    assert np.linalg.norm(flipped.positions - figure.vertices * [1, -1, 1], axis=1).mean() < 0.1 * edge
    image = flipped.positions[figure.faces]
    normal = np.cross(image[:, 1] - image[:, 0], image[:, 2] - image[:, 0])
    own = figure.vertices[figure.faces[flipped.face[figure.faces[:, 0]]]]
    there = np.cross(own[:, 1] - own[:, 0], own[:, 2] - own[:, 0])
    assert ((normal * there).sum(axis=1) < 0).mean() > 0.9


def test_scales_enlarge_their_part_and_leave_the_others() -> None:
    plain = quadruped(n_vertices=FEW)
    big = quadruped("stand", head_scale=2.0, n_vertices=FEW, seed=1)
    image = truth(plain, big).positions
    head, trunk = plain.rest[:, 0] > 1.2, np.abs(plain.rest[:, 0]) < 0.4
    for part, factor in ((head, 2.0), (trunk, 1.0)):
        before, after = (np.linalg.norm(x[part][:, None] - x[part][None], axis=2) for x in (plain.vertices, image))
        assert after.sum() / before.sum() == pytest.approx(factor, rel=0.02)


def test_posing_turns_the_end_of_a_branch_rigidly() -> None:
    tail = ANIMAL.pose(np.array([[-1.5, 0.0, 1.3], [-1.4, 0.0, 1.25], [-1.45, 0.02, 1.3]]), {"tail": Move((0, 0, 90))})
    before = np.array([[-1.5, 0.0, 1.3], [-1.4, 0.0, 1.25], [-1.45, 0.02, 1.3]]) - [-0.74, 0, 1.08]
    quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    assert np.allclose(tail - [-0.74, 0, 1.08], before @ quarter.T, atol=1e-3)


def test_membership_is_a_share_that_grows_towards_the_root() -> None:
    share = ANIMAL.membership(quadruped(n_vertices=FEW).rest)
    assert share.min() >= 0 and np.allclose(share[0], 1)
    names = [joint.name for joint in ANIMAL.joints]
    assert (share[names.index("wrist_left")] <= share[names.index("elbow_left")] + 1e-12).all()


def test_the_demo_pair_is_quick_and_true() -> None:
    source, target, points = shapes.demo_pair()
    assert source.n_vertices == target.n_vertices == len(points) == 5000
    assert points.mesh is target
    assert isinstance(target, Figure) and isinstance(source, Figure)
    assert height_above(ANIMAL, target.rest) < 1e-9


def test_a_figure_survives_pickling() -> None:
    figure = quadruped(n_vertices=FEW)
    copy = pickle.loads(pickle.dumps(figure))
    assert np.array_equal(copy.rest, figure.rest) and np.array_equal(copy.vertices, figure.vertices)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"pose": "fly"}, "no pose 'fly'; there are stand"),
        ({"pose": {"wing": Move()}}, "no joint 'wing'"),
        ({"pose": {"wing": Move((0, 1, 0))}}, "no joint 'wing'"),
        ({"head_scale": 0.0}, "the scale of head must be positive"),
        ({"n_vertices": 7}, "n_vertices must be from 50"),
    ],
)
def test_mistakes_are_named(options: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        quadruped(**options)
