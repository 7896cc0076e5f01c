"""What must not change a map: size, place, numbering, the order of faces, the kind of mesh object, the run."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy, permuted, shuffled

import gmds
from geodesics import Mesh, SurfacePoints
from gmds import Correspondence
from gmds.deformations import remeshing


@pytest.fixture(scope="module")
def pair() -> tuple[Mesh, Mesh]:
    """A surface and another triangulation of it, so that the map is not trivial."""
    return bumpy(), remeshing(bumpy(), 150, rng=1)[0]


@pytest.fixture(scope="module")
def answer(pair: tuple[Mesh, Mesh]) -> Correspondence:
    return gmds.match(*pair, n_samples=60)


def off(points: SurfacePoints, others: SurfacePoints, vertices: np.ndarray) -> float:
    """The largest distance between two sets of points, once both are on a mesh with these vertices, over its extent."""
    here, there = (np.einsum("pk,pkx->px", p.barycentric, vertices[p.mesh.faces[p.face]]) for p in (points, others))
    return float(np.abs(here - there).max() / np.ptp(vertices))


@pytest.mark.parametrize("scales", [(1e-6, 1.0), (1.0, 1e6), (1e6, 1e-6)])
def test_size_and_place_do_not_matter(
    pair: tuple[Mesh, Mesh], answer: Correspondence, scales: tuple[float, float]
) -> None:
    meshes = [shapes.moved(mesh, scale, seed=i) for i, (mesh, scale) in enumerate(zip(pair, scales, strict=True))]
    other = gmds.match(*meshes, n_samples=60)
    assert off(other.points, answer.points, pair[1].vertices) < 1e-6
    assert np.allclose(other.distortion, answer.distortion, atol=1e-6)


def test_far_from_the_origin_the_map_is_the_same() -> None:
    shifted = Mesh(bumpy().vertices + 1e8, bumpy().faces)
    answer = gmds.match(bumpy(), shifted, n_samples=40)
    assert np.abs(answer.points.positions - shifted.vertices).max() < 1e-2 * np.ptp(bumpy().vertices)


def test_numbering_of_the_source_does_not_matter(pair: tuple[Mesh, Mesh], answer: Correspondence) -> None:
    source, place = permuted(pair[0], 3)
    other = gmds.match(source, pair[1], n_samples=60)
    assert off(other.points[place], answer.points, pair[1].vertices) < 1e-6


def test_numbering_of_the_target_does_not_matter(pair: tuple[Mesh, Mesh], answer: Correspondence) -> None:
    target, _ = permuted(pair[1], 4)
    other = gmds.match(pair[0], target, n_samples=60)
    assert np.abs(other.points.positions - answer.points.positions).max() < 1e-6 * np.ptp(target.vertices)


def test_the_order_of_faces_and_of_their_corners_does_not_matter(
    pair: tuple[Mesh, Mesh], answer: Correspondence
) -> None:
    other = gmds.match(shuffled(pair[0], 1), shuffled(pair[1], 2), n_samples=60)
    assert np.abs(other.points.positions - answer.points.positions).max() < 1e-6 * np.ptp(pair[1].vertices)


@pytest.mark.parametrize("part", ["all", "half"])
def test_faces_turned_over_do_not_matter(pair: tuple[Mesh, Mesh], answer: Correspondence, part: str) -> None:
    turn = np.ones(pair[1].n_faces, bool) if part == "all" else np.arange(pair[1].n_faces) % 2 == 0
    target = Mesh(pair[1].vertices, np.where(turn[:, None], pair[1].faces[:, [1, 0, 2]], pair[1].faces))
    other = gmds.match(pair[0], target, n_samples=60)
    assert np.abs(other.points.positions - answer.points.positions).max() < 1e-6 * np.ptp(target.vertices)


def test_a_second_run_gives_the_same_bits(pair: tuple[Mesh, Mesh], answer: Correspondence) -> None:
    again = gmds.match(*(Mesh(mesh.vertices, mesh.faces) for mesh in pair), n_samples=60, rng=5)
    assert np.array_equal(again.points.face, answer.points.face)
    assert np.array_equal(again.points.barycentric, answer.points.barycentric)
    assert np.array_equal(again.distortion, answer.distortion)


def test_mesh_objects_of_trimesh_are_taken() -> None:
    import trimesh

    theirs = trimesh.Trimesh(bumpy().vertices, bumpy().faces, process=False)
    answer = gmds.match(theirs, theirs, n_samples=20)
    assert np.abs(answer.points.positions - bumpy().vertices).max() < 1e-9
    assert isinstance(answer.source, Mesh)


def test_the_meshes_are_not_changed(pair: tuple[Mesh, Mesh], answer: Correspondence) -> None:
    assert answer.source is pair[0]
    assert answer.target is pair[1]
    assert answer.points.mesh is pair[1]


def test_a_vertex_outside_the_matched_part_does_not_change_the_rest() -> None:
    plain = gmds.match(bumpy(), shapes.moved(bumpy(), 2.0), n_samples=40)
    extra = gmds.match(shapes.with_isolated(bumpy()), shapes.moved(bumpy(), 2.0), n_samples=40)
    kept = np.bincount(extra.source.faces.ravel(), minlength=extra.source.n_vertices) > 0
    assert np.abs(extra.points.positions[kept] - plain.points.positions).max() < 1e-9
