"""How sure a match is of itself: of copies and poses, and of maps to another thing."""

from __future__ import annotations

from unittest import mock

import numpy as np
import pytest

import gmds
from geodesics import CommuteTimeDistance, Mesh, eigenpairs
from gmds.evaluation import geodesic_error
from gmds.maps.point_map import MatchStatus
from gmds.matching import rating
from gmds.matching.plain_weights import PLAIN_WEIGHTS
from gmds.matching.rating import AMBIGUOUS_MARGIN, AS_LIKELY_AS_NOT, SURE, expected_share, status_of
from gmds.matching.signs import signs_of
from gmds.matching.weights import WEIGHTS
from gmds.shapes import humanoid, quadruped, truth

pytestmark = pytest.mark.usefixtures("few_faces")
ANIMAL = quadruped(n_vertices=600)


@pytest.fixture(scope="module")
def walking() -> gmds.Correspondence:
    return gmds.match(ANIMAL, quadruped("walk", n_vertices=600))


def test_another_pose_is_believed(walking: gmds.Correspondence) -> None:
    error = geodesic_error(walking, truth(ANIMAL, walking.target))
    assert walking.status is MatchStatus.GOOD and error.mean() < 0.03
    assert walking.confidence[walking.valid].mean() > 0.8
    assert abs(walking.confidence.mean() - (error < 0.05).mean()) < 0.2


def test_where_it_is_wrong_it_is_less_sure() -> None:
    """A person is no animal: most of the map is wrong, and said to be."""
    answer = gmds.match(ANIMAL, humanoid(n_vertices=600))
    assert answer.confidence.mean() < 0.5 and answer.status is MatchStatus.POOR
    assert answer.doubtful and any(note.startswith("W306: regions of the source") for note in answer.meta["notes"])


def test_a_copy_has_no_distortion_and_full_confidence() -> None:
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    copy = Mesh(5 * ANIMAL.vertices @ turn + 1, ANIMAL.faces)
    answer = gmds.match(ANIMAL, copy)
    assert answer.distortion.max() < 1e-6 and answer.confidence.min() > 0.8
    assert answer.doubtful == [] and not any("W306" in note for note in answer.meta["notes"])


def test_a_mirror_image_taken_for_one_has_no_distortion() -> None:
    image = Mesh(ANIMAL.vertices * (-1, 1, 1), ANIMAL.faces[:, ::-1])
    assert gmds.match(ANIMAL, image, orientation="reverse").distortion.max() < 1e-6


def test_the_model_knows_every_sign() -> None:
    seen: list[set[str]] = []

    def observed(*arguments: object) -> object:
        signs = signs_of(*arguments)  # type: ignore[arg-type]
        assert all(np.isfinite(values).all() for values in signs.values())
        seen.append(set(signs))
        return signs

    small = quadruped(n_vertices=400)
    with mock.patch.object(rating, "signs_of", observed):
        gmds.match(small, quadruped("graze", n_vertices=400))
    assert seen and seen[-1] == set(WEIGHTS)
    assert all(one.low < one.high for one in WEIGHTS.values())


def test_where_nothing_can_be_said_confidence_is_zero() -> None:
    small = quadruped(n_vertices=300)

    def without_numbers(*arguments: object) -> object:
        signs = signs_of(*arguments)  # type: ignore[arg-type]
        return {**signs, "whole_curvature": np.full(300, np.nan)}

    with mock.patch.object(rating, "signs_of", without_numbers):
        answer = gmds.match(small, quadruped("graze", n_vertices=300), n_samples=60)
    assert (answer.confidence == 0).all() and answer.status is MatchStatus.POOR


@pytest.mark.parametrize(
    ("expected", "margin", "badly_kept", "status"),
    [
        (0.9, 5.0, False, MatchStatus.GOOD),
        (0.9, 5.0, True, MatchStatus.GOOD),
        (AS_LIKELY_AS_NOT - 0.01, 5.0, False, MatchStatus.POOR),
        (SURE - 0.01, 5.0, True, MatchStatus.POOR),
        (SURE - 0.01, 5.0, False, MatchStatus.GOOD),
        (0.9, AMBIGUOUS_MARGIN - 0.01, False, MatchStatus.AMBIGUOUS),
        (0.1, 0.0, False, MatchStatus.POOR),
    ],
)
def test_status_follows_what_is_expected(expected: float, margin: float, badly_kept: bool, status: MatchStatus) -> None:
    assert status_of(expected, margin, badly_kept=badly_kept) is status


def test_only_the_valid_area_counts() -> None:
    confidence, areas = np.array([1.0, 0.5, 0.0]), np.array([1.0, 3.0, 9.0])
    assert expected_share(confidence, areas, np.array([True, True, False])) == pytest.approx(2.5 / 4)
    assert expected_share(confidence, areas, np.zeros(3, dtype=bool)) == 0


def commute_time(mesh: Mesh) -> CommuteTimeDistance:
    return CommuteTimeDistance(eigenpairs(mesh, 60))


def test_plain_maps_have_a_model_of_their_own() -> None:
    """Nothing is registered, and a right map is believed all the same; a person is still no animal."""
    walking = quadruped("walk", n_vertices=600)
    answer = gmds.match(ANIMAL, walking, distance=commute_time)
    assert geodesic_error(answer, truth(ANIMAL, walking)).mean() < 0.04 and answer.status is MatchStatus.GOOD
    other = gmds.match(ANIMAL, humanoid(n_vertices=600), distance=commute_time)
    assert other.status is not MatchStatus.GOOD and other.confidence.mean() < 0.5 < answer.confidence.mean()
    assert set(PLAIN_WEIGHTS) < set(WEIGHTS)
