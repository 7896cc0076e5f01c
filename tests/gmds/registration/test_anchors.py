"""Landmarks in matching: hard ones are met, soft ones pull as their likelihood says, and wrong ones are let go."""

from __future__ import annotations

import functools
from typing import Any

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy, surface
from numpy.typing import NDArray

import gmds
from geodesics import SurfacePoints
from gmds import Correspondence, SoftLandmarks
from gmds.cli.choices import ChosenDistance
from gmds.landmarks.checking import place_landmarks
from gmds.maps.images import image
from gmds.maps.point_map import MatchStatus
from gmds.matching.pair import SurfacePair
from gmds.registration.anchors import HARD, Anchors
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import register
from gmds.registration.settings import RegistrationSettings
from gmds.shapes import humanoid, truth

Array = NDArray[np.float64]
RNG = np.random.default_rng(3)


def anchors(tolerance: float, count: int = 4) -> tuple[Anchors, Array]:
    """Points anywhere on the bumpy sphere that belong some way off, and the vertices of its surface."""
    mesh = surface(bumpy()).mesh
    corners, weights = mesh.faces[17 : 17 + 9 * count : 9], RNG.dirichlet([1, 1, 1], count)
    ends = np.einsum("kc,kcj->kj", weights, mesh.vertices[corners]) + 0.1 * RNG.standard_normal((count, 3))
    return Anchors(corners, weights, ends, np.full(count, tolerance)), mesh.vertices


@pytest.mark.parametrize("tolerance", [0.02, 0.1, 1.0])
def test_soft_landmarks_pull_as_the_likelihood_falls(tolerance: float) -> None:
    marks, y = anchors(tolerance)
    energy, stiffness_weight, n = 1e-3, 1e-3, len(y)
    weights, ends = marks.added_to((np.zeros(n), np.zeros((n, 3))), y, stiffness_weight, energy)
    direction, step = RNG.standard_normal(y.shape), 1e-6
    there, back = (marks.neg_log_likelihood(y + way * step * direction) for way in (1, -1))
    slope = (there - back) / (2 * step)
    # of log sqrt(E) the slope is that of E / (2 E); the system of the registration has that of E / 4, weighted
    pull = weights[:, None] * (y - ends)
    assert 2 * (pull * direction).sum() / (stiffness_weight * energy) == pytest.approx(slope, rel=1e-5)


def test_a_landmark_missed_by_many_tolerances_pulls_ever_less() -> None:
    marks, y = anchors(0.02, 1)
    away = marks.ends - marks.positions(y)
    pulls = []
    for times in (1, 5, 25):
        end = Anchors(marks.corners, marks.weights, marks.positions(y) + times * 0.02 * away, marks.tolerance)
        weights, ends = end.added_to((np.zeros(len(y)), np.zeros_like(y)), y, 1e-3, 1e-3)
        pulls.append(np.linalg.norm(weights[:, None] * (ends - y)))
    far = [times * np.linalg.norm(away) for times in (1, 5, 25)]
    assert pulls == pytest.approx([p * pulls[0] for p in [f / (1 + f**2) * (1 + far[0] ** 2) / far[0] for f in far]])


def test_point_constraints_that_were_there_stay_and_hard_landmarks_rule() -> None:
    marks, y = anchors(0.0, 2)
    before = RNG.random(len(y)) * 1e-3, RNG.standard_normal(y.shape)
    weights, ends = marks.added_to(before, y, 1e-3, 0.5)
    free = np.setdiff1d(np.arange(len(y)), marks.corners)
    assert np.array_equal(weights[free], before[0][free]) and np.allclose(ends[free], before[1][free])
    assert weights.sum() - before[0].sum() == pytest.approx(2 * 1e-3 * HARD)
    assert np.linalg.norm(marks.positions(ends) - marks.ends, axis=1).max() < 0.02


def test_registration_brings_hard_landmarks_home() -> None:
    mine = surface(bumpy())
    on, to = (SurfacePoints(bumpy(), faces, [[0.5, 0.3, 0.2]] * 3) for faces in ([5, 100, 250], [8, 103, 260]))
    pair = SurfacePair(mine, mine, place_landmarks((on, to), bumpy(), bumpy()).constraints)
    source, target = pair.full
    assert source.anchors is not None and target.anchors is not None
    found = register(source, target, mine.mesh.vertices, RegistrationSettings())
    assert np.linalg.norm(source.anchors.positions(found.y) - source.anchors.ends, axis=1).max() < 2e-3
    back = register(target, source, mine.mesh.vertices, RegistrationSettings())
    assert np.linalg.norm(target.anchors.positions(back.y) - target.anchors.ends, axis=1).max() < 2e-3
    free = register(DeformableMesh.of(mine), DeformableMesh.of(mine), mine.mesh.vertices, RegistrationSettings())
    assert free.residuals.landmarks == 0 and free.residuals.cost == free.residuals.energy < found.residuals.cost


@functools.cache
def people() -> tuple[Any, Any, SurfacePoints, Array]:
    """Two people, the truth, and the tips of the source's limbs and head."""
    source, target = humanoid(n_vertices=500), humanoid("wave", hand_scale=1.5, n_vertices=500, seed=1)
    x, y, z = source.rest.T
    tips = [y.argmax(), y.argmin(), (x + y - 3 * z).argmax(), (x - y - 3 * z).argmax(), (3 * x + z).argmax()]
    return source, target, truth(source, target), np.array(tips)


@functools.cache
def matched(kind: str, tolerance: float | None = None) -> Correspondence:
    """People matched without landmarks, with right ones, and with one of them, the nose, on the back."""
    source, target, true, tips = people()
    if kind == "none":
        return gmds.match(source, target)
    places = true[tips].positions.copy()
    if kind == "wrong":
        x, _, z = source.rest.T
        places[4] = true[[int((-3 * x - np.abs(z - 1.2)).argmax())]].positions
    given = (tips, places)
    return gmds.match(source, target, landmarks=given if tolerance is None else SoftLandmarks(given, tolerance))


def error(answer: Correspondence) -> float:
    return 100 * float(gmds.geodesic_error(answer, people()[2]).mean())


def miss(answer: Correspondence) -> Array:
    """How far from the truth the landmarks come, in root areas."""
    _, target, true, tips = people()
    return np.linalg.norm((answer.points[tips].positions - true[tips].positions) / np.sqrt(target.area), axis=1)


def test_hard_landmarks_at_vertices_are_met_exactly() -> None:
    source, _, true, tips = people()
    answer = matched("right")
    assert np.abs(answer.points[tips].positions - true[tips].positions).max() < 1e-12
    assert answer.valid[tips].all()
    assert error(answer) < error(matched("none")) + 0.5
    said = answer.meta["parameters"]["landmarks"]
    again = SurfacePoints(source, **said["source"]), SurfacePoints(answer.target, **said["target"])
    assert again[0].nearest_vertices().tolist() == tips.tolist() and said["tolerance"] == [0.0] * 5


def test_hard_landmarks_inside_faces_are_met_to_the_size_of_faces() -> None:
    source, target, true, tips = people()
    face = np.array([np.flatnonzero((source.faces == tip).any(axis=1))[0] for tip in tips])
    marks = SurfacePoints(source, face, np.full((5, 3), 1 / 3))
    there = image(Correspondence.from_points(source, true), marks)[0]
    sent = image(gmds.match(source, target, landmarks=(marks, there)), marks)[0]
    edges = np.linalg.norm(np.diff(target.vertices[target.faces[there.face]], axis=1), axis=2).max()
    assert np.linalg.norm(sent.positions - there.positions, axis=1).max() < edges


def test_right_soft_landmarks_help() -> None:
    assert miss(matched("right", 0.02)).mean() < 0.8 * miss(matched("none")).mean()
    assert error(matched("right", 0.02)) < error(matched("none")) + 0.1


def test_a_wrong_soft_landmark_does_less_harm_than_a_hard_one() -> None:
    hard, soft = matched("wrong"), matched("wrong", 0.05)
    assert miss(hard)[4] > 0.3  # where it was told to be
    assert miss(soft)[4] < 0.5 * miss(hard)[4]  # nearer to where it belongs
    harm, harm_of_hard = (error(answer) - error(matched("none")) for answer in (soft, hard))
    assert harm < 0.5 and harm < 0.5 * harm_of_hard


def test_a_soft_landmark_that_is_given_up_is_named() -> None:
    (note,) = (line for line in matched("wrong", 0.05).meta["notes"] if not line.startswith("W306"))
    assert note.startswith("W302: 1 soft landmark") and f"vertex {people()[3][4]}, by 0." in note
    assert not [line for line in matched("right", 0.05).meta["notes"] if line.startswith("W302")]


def test_a_wrong_hard_landmark_is_named_and_the_map_is_not_good() -> None:
    """A map has to meet it: what is around it says where it belongs."""
    (note,) = (line for line in matched("wrong").meta["notes"] if line.startswith("W307"))
    assert f"vertex {people()[3][4]} by 0." in note and f"vertex {people()[3][0]} " not in note
    assert matched("wrong").status is MatchStatus.POOR
    assert matched("right").status is MatchStatus.GOOD
    for answer in (matched("right"), matched("right", 0.05), matched("wrong", 0.05)):
        assert not [line for line in answer.meta["notes"] if line.startswith("W307")]


def test_landmarks_count_with_a_distance_of_ones_own_as_well() -> None:
    distance = ChosenDistance("embedded", "diffusion")
    mine, marks = bumpy(), np.array([3, 40, 90, 140])
    answer = gmds.match(mine, shapes.moved(mine, 2.0), distance=distance, landmarks=(marks, marks))
    assert answer.vertex_map()[marks].tolist() == marks.tolist()
