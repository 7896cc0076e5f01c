"""Landmarks that the shapes contradict: soft ones are let go and told, hard ones told; right ones keep their say."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
import pytest
from generated_shapes import icosphere
from scipy.spatial.transform import Rotation

import gmds
from geodesics import Mesh, SurfacePoints
from gmds import Correspondence, SoftLandmarks
from gmds.landmarks.checking import place_landmarks
from gmds.maps.point_map import MatchStatus
from gmds.matching.attempts import Attempt, Wanted
from gmds.matching.contradictions import CERTAIN, COST, Given, believed, of_the_shapes
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposed
from gmds.mds.losses import LeastSquares
from gmds.parts.handedness import AS_IT_IS
from gmds.shapes import quadruped, truth
from gmds.shapes.figure import Figure
from gmds.surface.measured import measure

TIPS = {
    "left fore": (0.55, 0.2, 0.03),
    "right fore": (0.55, -0.2, 0.03),
    "left hind": (-0.55, 0.2, 0.03),
    "right hind": (-0.55, -0.2, 0.03),
    "nose": (1.42, 0, 1.46),
    "tail": (-1.53, 0, 1.31),
}
ARMS = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
TOLERANCE = 0.05


@functools.cache
def animals() -> tuple[Figure, Figure, SurfacePoints]:
    """One that stands, one that walks and has a head twice as large, and where the vertices of the first belong."""
    source = quadruped(n_vertices=600)
    target = quadruped("walk", head_scale=2.0, seed=1, n_vertices=700)
    return source, target, truth(source, target)


def tip(animal: Figure, name: str) -> int:
    return int(np.linalg.norm(animal.rest - TIPS[name], axis=1).argmin())


@functools.cache
def matched(*pairs: tuple[str, str], hard: bool = False, orientation: str = "preserve") -> Correspondence:
    """The animals matched with these tips of the first on those of the second."""
    source, target, _ = animals()
    if orientation == "reverse":
        target = Mesh(target.vertices * [1, -1, 1], target.faces[:, ::-1])
    rows = [[tip(source, a), tip(animals()[1], b)] for a, b in pairs]
    landmarks = None if not rows else rows if hard else SoftLandmarks(rows, TOLERANCE)
    return gmds.match(source, target, landmarks=landmarks, orientation=orientation)


def error(answer: Correspondence) -> float:
    return 100 * float(gmds.geodesic_error(answer, SurfacePoints(answer.target, *_truth(answer))).mean())


def _truth(answer: Correspondence) -> tuple[np.ndarray, np.ndarray]:
    right = animals()[2]
    turned = not np.array_equal(answer.target.faces, animals()[1].faces)
    return right.face, right.barycentric[:, ::-1] if turned else right.barycentric


def called(pair: tuple[str, str]) -> str:
    return f"vertex {tip(animals()[0], pair[0])} on vertex {tip(animals()[1], pair[1])}"


def note(answer: Correspondence, code: str) -> str:
    return next((line for line in answer.meta["notes"] if line.startswith(code)), "")


WRONG = ("tail", "left hind")
EXCHANGED = (("left fore", "right fore"), ("right fore", "left fore"))
OTHERS = tuple((name, name) for name in ("left hind", "right hind", "nose", "tail"))


def test_a_wrong_soft_landmark_spoils_nothing_and_is_named() -> None:
    """Followed, it cost 12 root areas in a hundred, and the map was GOOD without a word."""
    answer = matched(WRONG)
    assert error(answer) < error(matched()) + 0.1
    assert answer.status is MatchStatus.GOOD
    assert f"{called(WRONG)}, by 0." in note(answer, "W302: 1 soft landmark is not followed")
    assert [row for row, _ in answer.meta["evidence"].get("contradicted", [])] == [0]


def test_two_exchanged_ones_of_six_are_named_and_the_others_followed() -> None:
    answer = matched(*EXCHANGED, *OTHERS)
    assert error(answer) < error(matched(("left fore", "left fore"), ("right fore", "right fore"), *OTHERS)) + 0.3
    assert answer.status is MatchStatus.GOOD and all(called(pair) in note(answer, "W302: 2") for pair in EXCHANGED)


@pytest.mark.parametrize("pairs", [(WRONG,), (*EXCHANGED, *OTHERS)], ids=["one", "two of six"])
def test_hard_ones_are_met_and_named_and_the_map_is_not_good(pairs: Sequence[tuple[str, str]]) -> None:
    source, target, _ = animals()
    answer, wrong = matched(*pairs, hard=True), pairs[: max(1, len(pairs) - 4)]
    assert answer.status is MatchStatus.POOR and all(f"{called(pair)} by" in note(answer, "W307") for pair in wrong)
    sent = answer.points[[tip(source, a) for a, _ in pairs]].positions
    np.testing.assert_allclose(sent, target.vertices[[tip(target, b) for _, b in pairs]], atol=1e-9)


def test_right_ones_are_neither_named_nor_lost() -> None:
    for hard in (False, True):
        answer = matched(*OTHERS, hard=hard)
        assert not note(answer, "W302") and not note(answer, "W307")
        assert answer.meta["evidence"].get("contradicted", []) == []
        assert [row[0] for row in OTHERS] and answer.status is MatchStatus.GOOD


def test_a_wrong_one_on_a_mirrored_animal_is_let_go_too() -> None:
    answer, without = matched(WRONG, orientation="reverse"), matched(orientation="reverse")
    assert error(answer) < error(without) + 0.1 and f"{called(WRONG)}, by 0." in note(answer, "W302")


def cross(length: float, turn: Sequence[float]) -> Mesh:
    """A body with four arms of this length that are all alike, and a head."""
    sphere = icosphere(3)
    x = sphere.vertices @ Rotation.from_rotvec(turn).as_matrix().T
    out = length * np.exp(14 * (x @ ARMS.T - 1)).sum(axis=1) + 0.8 * np.exp(8 * (x[:, 2] - 1))
    return Mesh((1 + out)[:, None] * x, sphere.faces)


@pytest.mark.parametrize("turn", [1, 2])
def test_one_soft_landmark_decides_between_maps_that_are_alike(turn: int) -> None:
    """The arms of the target are longer, so that no map is certain; any turn by a quarter is as right as another."""
    source, target = cross(1.2, [0.1, 0.2, 0.3]), cross(2.0, [0.5, -0.2, 0.9])
    ours, theirs = ((mesh.vertices @ ARMS.T).argmax(axis=0) for mesh in (source, target))
    answer = gmds.match(source, target, landmarks=SoftLandmarks([[ours[0], theirs[turn]]], TOLERANCE))
    assert (answer.points[ours].positions @ ARMS.T).argmax(axis=1).tolist() == [(i + turn) % 4 for i in range(4)]
    assert not note(answer, "W302")


@functools.cache
def attempt() -> tuple[SurfacePair, Attempt]:
    """What is proposed with a right and a wrong soft landmark, and the pair with both."""
    source, target, _ = animals()
    rows = [[tip(source, a), tip(target, b)] for a, b in (("nose", "nose"), WRONG)]
    both = place_landmarks(SoftLandmarks(rows, TOLERANCE), source, target).constraints
    ours, theirs = measure(source), measure(target)
    wanted = Wanted(both, None, LeastSquares(), 100, "neither", lambda stage, share: None, False)
    return SurfacePair(ours, theirs, both), Attempt.at(ours, theirs, AS_IT_IS, wanted)


def test_a_landmark_costs_the_square_of_what_it_is_missed_by_and_at_most_a_bound() -> None:
    pair, found = attempt()
    assert pair.landmarks is not None
    given = Given(pair, pair.landmarks)
    best = found.maps[0]
    missed, far = given.missed(best), given.far
    assert far == pytest.approx([3 * TOLERANCE] * 2) and missed[0] < far[0] < missed[1]
    assert of_the_shapes(best) > CERTAIN
    assert given.cost(best) - of_the_shapes(best) == pytest.approx(COST * ((given.off(best)[0] / far[0]) ** 2 + 1))
    assert given.off(best) == pytest.approx(missed, abs=0.03)  # what is around them goes along


def test_what_is_left_is_the_pair_without_the_wrong_one() -> None:
    _, found = attempt()
    assert found.pair.landmarks is not None and found.pair.landmarks.rows.tolist() == [0]
    ((row, by),) = found.pair.contradicted
    assert row == 1 and by > 0.3 and found.pair.given_up == COST


def test_nothing_is_proposed_again_where_a_certain_map_meets_them() -> None:
    def never(*_: object) -> Proposed:
        raise AssertionError("asked again")

    pair, found = attempt()
    assert pair.landmarks is not None
    right = SurfacePair(pair.source, pair.target, pair.landmarks[[0]])
    maps = list(found.maps)
    assert of_the_shapes(maps[0]) < -10.5  # as likely as right maps of surfaces that keep their sizes
    same = believed(right, Proposed(maps, False, []), maps, never, never)
    assert same.pair is right and same.maps is maps


def test_those_of_the_second_body_are_numbered_as_they_were_given() -> None:
    source, target, _ = animals()
    shift, n, m = np.array([0.0, 5.0, 0.0]), source.n_vertices, target.n_vertices
    ball = icosphere(2)
    ball = Mesh(ball.vertices * [1.0, 1.3, 1.7] + 0.1 * np.sin(3 * ball.vertices[:, [1]]), ball.faces)

    def beside(animal: Figure) -> Mesh:
        return Mesh(
            np.vstack([ball.vertices + shift, animal.vertices]),
            np.vstack([ball.faces, animal.faces + len(ball.vertices)]),
        )

    first = len(ball.vertices)
    rows = [[3, 3], [first + tip(source, WRONG[0]), first + tip(target, WRONG[1])]]
    answer = gmds.match(beside(source), beside(target), landmarks=SoftLandmarks(rows, TOLERANCE))
    assert answer.meta["bodies"] == 2 and len(answer.points) == first + n and answer.target.n_vertices == first + m
    assert f"vertex {rows[1][0]} on vertex {rows[1][1]}, by 0." in note(answer, "W302: 1 soft")
