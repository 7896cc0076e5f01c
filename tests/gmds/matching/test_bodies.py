"""Meshes of several bodies: each goes with its partner, and what has none is told."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy

import gmds
from geodesics import Mesh
from gmds.maps.point_map import MatchStatus
from gmds.matching.bodies import bodies_of
from gmds.matching.several_bodies import _left_out, beyond, incomplete
from gmds.shapes import humanoid, quadruped
from gmds.surface.measured import measure

SAMPLES = 50
SHIFT = np.array([0.3, 0.2, 4.0])


def joined(*meshes: Mesh) -> Mesh:
    """All of them in one mesh."""
    first = np.cumsum([0, *(mesh.n_vertices for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, first[:-1], strict=True)]
    return Mesh(np.vstack([mesh.vertices for mesh in meshes]), np.vstack(faces))


def moved(mesh: Mesh, shift: object, size: float = 1.0) -> Mesh:
    return Mesh(size * mesh.vertices + shift, mesh.faces)


def turned(mesh: Mesh) -> Mesh:
    """Turned about an oblique axis, and ten times as large."""
    rotation = np.linalg.qr(np.random.default_rng(7).standard_normal((3, 3)))[0]
    return Mesh(10 * mesh.vertices @ (rotation * np.sign(np.linalg.det(rotation))).T + 5, mesh.faces)


def test_two_alike_go_each_to_its_own_by_how_they_lie() -> None:
    mesh = joined(bumpy(), moved(bumpy(), SHIFT))
    n = bumpy().n_vertices
    swapped = np.r_[n : 2 * n, :n]  # the other one first
    target = turned(Mesh(mesh.vertices[swapped], np.argsort(swapped)[mesh.faces]))
    answer = gmds.match(mesh, target, n_samples=SAMPLES)
    assert answer.valid.all() and answer.status is MatchStatus.GOOD
    assert np.array_equal(answer.vertex_map(), np.argsort(swapped))
    assert answer.meta["bodies"] == 2


@pytest.mark.parametrize("changed", [True, False])
def test_two_people_who_changed_places_are_ambiguous(changed: bool) -> None:
    """One has a larger head. By where they stand each was sent to the other, GOOD and with a confidence of 0.98."""
    place = np.array([0.0, 2.0, 0.0])
    source = [humanoid(n_vertices=600, seed=1), humanoid(n_vertices=600, head_scale=1.8, seed=2)]
    target = [humanoid("wave", n_vertices=600, seed=3), humanoid("wave", n_vertices=600, head_scale=1.8, seed=4)]
    here, there = (joined(one, moved(other, place)) for one, other in (source, target[::-1] if changed else target))
    answer = gmds.match(here, there, n_samples=SAMPLES)
    told = [note[:4] for note in answer.meta["notes"]]
    assert answer.status is (MatchStatus.AMBIGUOUS if changed else MatchStatus.GOOD)
    assert ("W310" in told) == changed
    assert not changed or answer.confidence.max() <= 0.5


def test_a_body_without_a_partner_is_told_and_not_good() -> None:
    animal = quadruped(n_vertices=600)
    both = joined(moved(bumpy(), SHIFT, 0.5), animal)
    n = bumpy().n_vertices
    answer = gmds.match(both, animal, n_samples=SAMPLES)
    assert answer.status is MatchStatus.INCOMPLETE
    assert not answer.valid[:n].any() and answer.valid[n:].all()
    assert np.array_equal(answer.vertex_map()[n:], np.arange(animal.n_vertices))
    assert any(note.startswith("W305: 1 of 2 bodies of the source") for note in answer.meta["notes"])
    back = gmds.match(animal, both, n_samples=SAMPLES)
    assert back.status is MatchStatus.INCOMPLETE and np.array_equal(back.vertex_map(), n + np.arange(len(back.points)))
    assert any("bodies of the target" in note for note in back.meta["notes"])


def test_landmarks_hold_on_the_body_they_lie_on() -> None:
    mesh = joined(bumpy(), moved(bumpy(), SHIFT, 0.8))
    n = bumpy().n_vertices
    pairs = [[5, 5], [n + 7, n + 7]]
    answer = gmds.match(mesh, turned(mesh), n_samples=SAMPLES, landmarks=pairs)
    assert answer.vertex_map()[[5, n + 7]].tolist() == [5, n + 7]
    assert len(answer.meta["parameters"]["landmarks"]["tolerance"]) == 2


def test_one_body_is_the_surface_itself() -> None:
    surface = measure(bumpy())
    assert [one.surface for one in bodies_of(surface)] == [surface]


def test_more_bodies_than_are_looked_at_are_told() -> None:
    column = joined(*(moved(bumpy(), (0, 0, 3.0 * i), 1 + 0.02 * i) for i in range(8)))
    surface = measure(column)
    assert len(bodies_of(surface)) == 6
    told = beyond((bodies_of(surface),) * 2, (surface, surface))
    assert [note.code for note in told] == ["W305", "W305"] and "2 of 8 bodies of the source" in told[0].message
    assert beyond((bodies_of(measure(bumpy())),) * 2, (measure(bumpy()),) * 2) == []
    assert incomplete(MatchStatus.GOOD) is MatchStatus.INCOMPLETE and incomplete(MatchStatus.POOR) is MatchStatus.POOR


def test_a_body_of_too_few_vertices_is_told() -> None:
    sheet = Mesh([[9, 0, 0], [9, 3, 0], [9, 0, 3]], [[0, 1, 2]])
    answer = gmds.match(joined(bumpy(), sheet), bumpy(), n_samples=SAMPLES)
    assert answer.status is MatchStatus.INCOMPLETE and not answer.valid[-3:].any() and answer.valid[:-3].all()
    assert any(note.startswith("W305: 1 of 2 bodies of the source were not looked at") for note in answer.meta["notes"])


def torn(mesh: Mesh, gap: float) -> Mesh:
    """In two, the front moved away by that share of the extent."""
    front = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0
    halves = []
    for side in (~front, front):
        used, faces = np.unique(mesh.faces[side], return_inverse=True)
        halves.append(Mesh(mesh.vertices[used], faces.reshape(-1, 3)))
    return joined(halves[0], moved(halves[1], (gap * np.ptp(mesh.vertices, axis=0).max(), 0, 0)))


def test_a_half_that_is_torn_off_is_told_to_lie_along_the_other() -> None:
    bodies = bodies_of(measure(torn(bumpy(), 1e-3)))
    (told,) = _left_out(bodies, [1], "target")
    assert told.code == "W305" and "at most 0.001 of the extent away: if that is a tear, join them" in told.message
    (told,) = _left_out(bodies_of(measure(torn(bumpy(), 0.5))), [1], "target")
    assert "tear" not in told.message


def test_a_map_to_one_of_two_halves_is_not_good() -> None:
    answer = gmds.match(bumpy(), torn(bumpy(), 1e-3), n_samples=SAMPLES)
    assert answer.status.rank >= MatchStatus.INCOMPLETE.rank
    assert any("if that is a tear, join them" in note for note in answer.meta["notes"])


def test_many_small_pieces_are_told_where_they_are_much_of_the_surface() -> None:
    mesh = bumpy()
    crumbs = [moved(shapes.icosphere(0), 0.06 * i + 3.0, 0.1) for i in range(20)]
    for count, few in ((3, True), (20, False)):
        surface = measure(joined(mesh, *crumbs[:count]))
        told = beyond((bodies_of(surface),) * 2, (surface, measure(mesh)))
        assert (told == []) is few
        assert few or "falls apart into pieces: 20 that are too small" in told[0].message
