"""A part that was turned, resized and moved is laid back where it belongs, also where both surfaces are cut."""

from __future__ import annotations

import numpy as np
import pytest
from cut_shapes import cut
from generated_shapes import moved, rectangle
from scipy.spatial import cKDTree

from geodesics import Mesh
from gmds._kernels.alignments import alignment_costs
from gmds.matching.pair import simplified
from gmds.parts.alignments import (
    APART,
    MISSING,
    REACH,
    TURN,
    Judged,
    Similarities,
    alignments,
    frames,
)
from gmds.shapes import quadruped
from gmds.surface.measured import measure

SIZES = (0.6, 1.7)


def judged(mesh: Mesh) -> Judged:
    """A mesh as alignments are judged by."""
    surface = measure(mesh)
    return Judged(surface, simplified(surface))


@pytest.fixture(scope="module")
def both() -> tuple[Judged, Judged, np.ndarray, np.ndarray]:
    """The front of an animal, its rear turned and resized, and vertices of both that are one."""
    body = quadruped(n_vertices=1000)
    front, kept = cut(body, body.vertices[:, 0] > -0.6)
    rear, there = cut(body, body.vertices[:, 0] < 0.7)
    common, ours, theirs = np.intersect1d(kept, there, return_indices=True)
    assert len(common) > 300
    return judged(front), judged(moved(rear, 7.0, seed=3)), ours, theirs


def test_the_best_similarity_is_the_right_one(both: tuple[Judged, Judged, np.ndarray, np.ndarray]) -> None:
    source, target, ours, theirs = both
    found = alignments(source, target, SIZES, 30)
    goals = target.surface.mesh.vertices[theirs]
    errors = np.linalg.norm(found.moved(source.surface.mesh.vertices[ours]) - goals, axis=2).mean(axis=1)
    assert errors[0] < 0.02
    assert np.linalg.det(found.rotations) == pytest.approx(1)
    assert ((found.sizes >= SIZES[0]) & (found.sizes <= SIZES[1])).all()


def test_similarities_are_apart_and_the_best_come_first(both: tuple[Judged, Judged, np.ndarray, np.ndarray]) -> None:
    source, target, *_ = both
    found = alignments(source, target, SIZES, 30)
    assert 1 < len(found) <= 30
    places = found.moved(source.surface.mesh.vertices[source.points])
    gaps = np.sqrt(((places[:, None] - places[None]) ** 2).sum(axis=3).mean(axis=2))
    assert gaps[~np.eye(len(found), dtype=bool)].min() > APART


def test_a_similarity_turns_resizes_and_moves() -> None:
    quarter = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
    one = Similarities(quarter, np.array([2.0]), np.array([[0.0, 0.0, 5.0]]))
    assert one.moved(np.array([[1.0, 0.0, 0.0]]))[0] == pytest.approx(np.array([[0.0, 2.0, 5.0]]))
    assert len(one) == 1 and len(one[np.array([0, 0])]) == 2


def test_frames_are_orthonormal_and_turn_with_the_surface() -> None:
    body = quadruped(n_vertices=600)
    turned = moved(body, 3.0, seed=5)
    one, other = measure(body), measure(turned)
    vertices = one.regular.samples(20)
    here, there = frames(one, vertices), frames(other, vertices)
    assert np.einsum("kab,kcb->kac", here, here) == pytest.approx(np.broadcast_to(np.eye(3), (20, 3, 3)), abs=1e-9)
    assert np.linalg.det(here) == pytest.approx(1)
    rotation = np.linalg.lstsq(one.mesh.vertices, other.mesh.vertices - other.mesh.vertices.mean(axis=0), rcond=None)[0]
    rotation = np.linalg.svd(rotation)[0] @ np.linalg.svd(rotation)[2]
    agree = np.abs(np.einsum("kab,kab->ka", here @ rotation, there))  # signs of the second and third are arbitrary
    assert np.median(agree, axis=0) == pytest.approx(1, abs=1e-3)


def test_cells_name_the_closest_vertex(both: tuple[Judged, Judged, np.ndarray, np.ndarray]) -> None:
    target = both[1]
    _, _, _, cells, low, step, places, *_ = target.arrays
    index = np.array([[0, 0, 0], [5, 9, 3], [20, 4, 7]])
    index = np.minimum(index, np.array(cells.shape) - 1)
    near = cells[tuple(index.T)]
    gaps = np.linalg.norm(places[near] - (low + step * index), axis=1)
    assert gaps == pytest.approx(cKDTree(places[target.mesh.usable]).query(low + step * index)[0])


def costs(one: Judged, other: Judged, size: float, shift: np.ndarray) -> float:
    """What both cost with the first resized and moved."""
    return float(
        alignment_costs(np.eye(3)[None], np.array([size]), shift[None], one.arrays, other.arrays, REACH, TURN, MISSING)[
            0
        ]
    )


def test_what_a_similarity_costs() -> None:
    plane = judged(rectangle(24, 24))
    same = costs(plane, plane, 1.0, np.zeros(3))
    inside = ~plane.arrays[8][plane.arrays[3][_cell(plane)]]
    areas = plane.arrays[2]
    assert same == pytest.approx(MISSING * areas[~inside].sum(), abs=0.02)  # nothing but what lies on the boundary
    away = costs(plane, plane, 1.0, np.array([0.0, 0.0, 0.5]))
    assert away == pytest.approx(areas[inside].sum() + MISSING * areas[~inside].sum(), abs=0.02)
    beside = costs(plane, plane, 1.0, 5 * np.array([1.0, 1.0, 0.0]))
    assert beside == pytest.approx(MISSING, abs=1e-9)  # each is nearest to the boundary of the other
    turned = costs(plane, judged(Mesh(rectangle(24, 24).vertices, rectangle(24, 24).faces[:, ::-1])), 1.0, np.zeros(3))
    assert turned == pytest.approx(away, abs=0.02)  # normals at 180 degrees say no


def test_a_surface_that_is_all_boundary_has_no_alignment() -> None:
    ribbon = judged(rectangle(2, 12))
    assert len(alignments(ribbon, judged(rectangle(24, 24)), SIZES, 5)) == 0
    assert len(alignments(judged(rectangle(24, 24)), ribbon, SIZES, 5)) == 0


def _cell(one: Judged) -> tuple[np.ndarray, ...]:
    points, _, _, _, low, step, *_ = one.arrays
    return tuple(np.round((points - low) / step).astype(int).T)
