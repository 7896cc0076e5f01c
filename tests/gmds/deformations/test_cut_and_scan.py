"""Parts that are cut off, or seen from one side: what remains is as it was, and what is gone is known."""

from __future__ import annotations

import copy
import itertools
import pickle
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from generated_shapes import icosphere, joined, rectangle, torus
from scipy.spatial.transform import Rotation

from geodesics import GeodesicDistance, Mesh, MeshError, SurfacePoints, embedded, vertex_normals
from geodesics.topology.components import vertex_components
from gmds import deformations as d
from gmds.shapes import quadruped

Making = Callable[[Mesh], d.Part]
PARTS: dict[str, Making] = {
    "plane": partial(d.cut, share=0.4, normal=(-1, 0, 0.2)),
    "ball": partial(d.cut, share=0.2, centre=5),
    "random ball": partial(d.cut, share=0.1, rng=2),
    "balls": partial(d.cut, share=0.5, count=5, rng=1),
    "holes": partial(d.holes, count=3),
    "scan": partial(d.scan, direction=(0, 1, 0)),
    "random scan": partial(d.scan, rng=3),
}


@pytest.fixture(scope="module")
def animal() -> Mesh:
    return quadruped("walk", n_vertices=1500)


def rows(faces: np.ndarray) -> set[tuple[int, ...]]:
    return set(map(tuple, faces.tolist()))


@pytest.mark.parametrize("name", PARTS)
def test_what_remains_is_as_it_was_and_the_rest_is_missing(animal: Mesh, name: str) -> None:
    part = PARTS[name](animal)
    kept = np.flatnonzero(~part.missing)
    assert 0 < len(kept) == part.mesh.n_vertices < animal.n_vertices == len(part.missing)
    assert np.array_equal(part.mesh.vertices, animal.vertices[kept])
    assert rows(kept[part.mesh.faces]) <= rows(animal.faces)
    assert np.array_equal(part.truth.positions[kept], part.mesh.vertices)
    assert np.array_equal(part.truth.nearest_vertices()[kept], np.arange(len(kept)))
    gap = np.linalg.norm(part.truth.positions - animal.vertices, axis=1)
    assert np.array_equal(gap > 0, part.missing)
    assert vertex_components(part.mesh).max() == 0
    mesh, truth = part
    assert mesh is part.mesh and truth is part.truth


@pytest.mark.parametrize("name", PARTS)
def test_parts_repeat_and_can_be_copied(animal: Mesh, name: str) -> None:
    part, again = PARTS[name](animal), PARTS[name](animal)
    for other in (again, copy.copy(part), pickle.loads(pickle.dumps(part))):
        assert np.array_equal(part.missing, other.missing)
        assert np.array_equal(part.mesh.faces, other.mesh.faces)


@pytest.mark.parametrize("share", [0.1, 0.25, 0.5])
@pytest.mark.parametrize("how", [{"normal": (0, 0, -1)}, {"normal": (1, 0, 0)}, {"rng": 1}, {"count": 5, "rng": 2}])
def test_the_share_is_what_is_gone_in_the_end(animal: Mesh, how: dict[str, object], share: float) -> None:
    gone = 1 - d.cut(animal, share, **how).mesh.area / animal.area  # type: ignore[arg-type]
    assert gone == pytest.approx(share, abs=0.02)


def test_a_plane_and_a_ball_are_where_they_should_be() -> None:
    sphere = icosphere(4)
    low = d.cut(sphere, 0.25, normal=(0, 0, 3))
    assert low.mesh.vertices[:, 2].max() < 0.5 + 0.05  # the height of a cap is twice its share of a sphere's area
    top = int(sphere.vertices[:, 2].argmax())
    ball = d.cut(sphere, 0.25, centre=top)
    distance = GeodesicDistance(embedded(sphere)).field(SurfacePoints.at_vertices(sphere, [top]))[0]
    assert distance[~ball.missing].min() > distance[ball.missing].max() - 0.1
    assert np.arccos(0.5) == pytest.approx(distance[~ball.missing].min(), abs=0.1)


def test_a_larger_cut_leaves_less_of_the_same(animal: Mesh) -> None:
    for how in ({"normal": (1, 2, 0)}, {"centre": 7}, {"count": 4}):
        parts = [d.cut(animal, share, **how).missing for share in (0, 0.1, 0.2, 0.3)]  # type: ignore[arg-type]
        assert not parts[0].any()
        assert all((less <= more).all() for less, more in itertools.pairwise(parts))


def test_smaller_components_count_as_gone() -> None:
    pair = joined(icosphere(2), icosphere(3))
    part = d.cut(pair, 0.5, centre=0)  # the one ball goes, and the other one stays whole
    assert part.mesh.n_vertices == icosphere(3).n_vertices


@pytest.mark.parametrize("direction", [(0, 1, 0), (1, 0, 0), (1, -2, 0.5)])
def test_a_scan_sees_nothing_that_faces_away(animal: Mesh, direction: tuple[float, ...]) -> None:
    part = d.scan(animal, direction)
    a, b, c = (part.mesh.vertices[part.mesh.faces[:, k]] for k in range(3))
    assert (np.cross(b - a, c - a) @ np.array(direction) > 0).all()
    assert 0.15 < part.mesh.area / animal.area < 0.5


def test_a_scan_of_a_sphere_is_half_of_it() -> None:
    sphere = icosphere(4)
    part = d.scan(sphere, (1, 1, 0))
    assert part.mesh.area / sphere.area == pytest.approx(0.5, abs=0.03)
    assert (vertex_normals(sphere)[part.missing] @ [1, 1, 0]).max() < 0.15


def test_a_scan_sees_no_further_than_what_is_in_front() -> None:
    near, far = rectangle(9, 9), rectangle(30, 30)
    vertices = np.vstack([near.vertices, 3 * far.vertices - 1])
    part = d.scan(Mesh(vertices, np.vstack([near.faces, far.faces + near.n_vertices])), (0, 0, 1))
    seen = part.mesh.vertices  # the larger sheet, with a hole where the smaller one hides it
    assert np.all(seen[:, 2] == -1)
    assert not (np.abs(seen[:, :2] - 0.5) < 0.5 - 0.15).all(axis=1).any()
    assert part.mesh.area == pytest.approx(9 - 1, abs=0.3)
    ring = d.scan(torus(), (0, 0, 1))
    assert vertex_components(ring.mesh).max() == 0 and ring.mesh.area / torus().area == pytest.approx(0.5, abs=0.15)


@pytest.mark.parametrize("name", ["plane", "scan"])
def test_turned_directions_turn_what_remains(animal: Mesh, name: str) -> None:
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7])
    turned = Mesh(animal.vertices @ turn.as_matrix().T, animal.faces)
    make, word = (partial(d.cut, share=0.4), "normal") if name == "plane" else (d.scan, "direction")
    a, b = make(animal, **{word: (1, 0.3, 0.2)}), make(turned, **{word: turn.apply([1, 0.3, 0.2])})  # type: ignore[operator]
    assert np.array_equal(a.missing, b.missing)


def test_missing_vertices_are_carried_through_other_deformations(animal: Mesh) -> None:
    half = partial(d.cut, share=0.4, normal=(1, 0, 0))
    pose, grow = partial(d.bending, angle=20), partial(d.local_scale, factor=1.5)
    posed = d.compose(pose, half, grow, d.noise)(animal)
    alone = half(pose(animal)[0])
    assert np.array_equal(posed.missing, alone.missing)
    assert np.array_equal(posed.truth.positions[~posed.missing], posed.mesh.vertices)
    twice = d.compose(half, partial(d.scan, direction=(0, 1, 0)))(animal)
    assert (twice.missing >= half(animal).missing).all() and (~twice.missing).sum() == twice.mesh.n_vertices
    remeshed = d.compose(partial(d.remeshing, n_vertices=1500), half)(animal)
    cut_at = remeshed.mesh.vertices[:, 0].max()
    assert np.abs(animal.vertices[remeshed.missing != (animal.vertices[:, 0] > cut_at), 0] - cut_at).max() < 0.1
    assert not d.compose(pose, d.noise)(animal).missing.any()


def test_mistakes_are_refused(animal: Mesh) -> None:
    for share in (-0.1, 1.0, np.nan):
        with pytest.raises(ValueError, match="below 1"):
            d.cut(animal, share)
    with pytest.raises(ValueError, match="not both"):
        d.cut(animal, normal=(0, 0, 1), centre=3)
    with pytest.raises(ValueError, match="three numbers"):
        d.cut(animal, normal=(0, 0, 0))
    with pytest.raises(ValueError, match="at least 1"):
        d.cut(animal, count=0)
    with pytest.raises(MeshError, match="none of the 1500"):
        d.cut(animal, centre=1500)
    with pytest.raises(ValueError, match="inside out"):
        d.scan(Mesh(animal.vertices, animal.faces[:, ::-1]), (0, 0, 1))
