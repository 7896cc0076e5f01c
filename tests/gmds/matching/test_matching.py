"""match(): what comes back, and what the options do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, mirror_vertices, reflected

import gmds
from geodesics import (
    BiharmonicDistance,
    CommuteTimeDistance,
    GeodesicDistance,
    Mesh,
    MeshError,
    eigenpairs,
    embedded,
    scale_invariant,
)
from gmds import Correspondence, Huber, LeastSquares, Minimax
from gmds.errors import LandmarkError, SampleCountError
from gmds.maps.point_map import MatchStatus
from gmds.matching import attempts
from gmds.matching.steps import rounds_of
from gmds.mds.losses import Loss, Power

LOBED = shapes.ellipsoid(2, (1.0, 1.4, 2.0))


def off(answer: Correspondence, positions: np.ndarray) -> float:
    """The largest distance between images and positions, over the extent of the target."""
    return float(np.abs(answer.points.positions - positions).max() / np.ptp(answer.target.vertices))


@pytest.mark.parametrize("name", ["bumpy", "animal"])
def test_the_map_of_a_surface_to_itself_is_the_identity(name: str) -> None:
    mesh = bumpy() if name == "bumpy" else animal()
    answer = gmds.match(mesh, Mesh(mesh.vertices, mesh.faces))
    assert off(answer, mesh.vertices) < 1e-9
    assert np.array_equal(answer.vertex_map(), np.arange(mesh.n_vertices))
    assert answer.valid.all()
    assert answer.distortion.max() < 1e-6  # the root of what rounding left
    assert answer.status is MatchStatus.GOOD
    assert answer.stress == answer.meta["evidence"]["stress"] < 1e-7


@pytest.fixture(scope="module")
def posed() -> Correspondence:
    """The animal and the same in another pose, triangulated anew."""
    return gmds.match(animal(), animal("walk", 1))


def test_another_pose_is_matched_and_judged_good_or_ambiguous(posed: Correspondence) -> None:
    truth, flipped = (gmds.shapes.truth(animal(), animal("walk", 1), mirrored=m) for m in (False, True))
    error = gmds.geodesic_error(posed, truth)
    assert 100 * error.mean() < 6
    assert error.mean() < 0.3 * gmds.geodesic_error(posed, flipped).mean()
    assert posed.status in (MatchStatus.GOOD, MatchStatus.AMBIGUOUS)
    assert error[posed.distortion > np.median(posed.distortion)].mean() > error.mean()  # distortion warns of error


def test_other_maps_are_candidates(posed: Correspondence) -> None:
    assert posed.candidates
    for candidate in posed.candidates:
        assert candidate.points.mesh is posed.target
        assert len(candidate.points) == posed.source.n_vertices
        assert 0 <= candidate.stress < 1


def test_the_mirrored_map_of_an_animal_is_a_candidate(posed: Correspondence) -> None:
    assert min(candidate.orientation for candidate in posed.candidates) < -0.3


@pytest.mark.parametrize("loss", [LeastSquares(), Huber(0.05), Power(1.5), Minimax()], ids=lambda x: type(x).__name__)
def test_every_loss_matches_a_turned_copy(loss: Loss) -> None:
    target = shapes.moved(bumpy(), 3.0)
    assert off(gmds.match(bumpy(), target, loss=loss, n_samples=25), target.vertices) < 1e-6


DISTANCES: dict[str, Callable[[Mesh], gmds.mds.pair_distances.Distance]] = {
    "geodesic": lambda m: GeodesicDistance(embedded(m)),
    "scale-invariant geodesic": lambda m: GeodesicDistance(scale_invariant(m)),
    "biharmonic": lambda m: BiharmonicDistance(eigenpairs(scale_invariant(m), 40)),
}


@pytest.mark.parametrize("name", DISTANCES)
def test_every_distance_matches_a_turned_copy(name: str) -> None:
    target = shapes.moved(bumpy(), 0.3)
    answer = gmds.match(bumpy(), target, distance=DISTANCES[name], n_samples=20)
    assert off(answer, target.vertices) < 1e-6


def test_where_a_part_grew_the_default_does_better_than_the_metric_of_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """That metric alone, proposals included: else metrics of curvature have their say where it does not decide."""

    def in_one_round(*of: Any) -> Any:
        rounds, given = rounds_of(*of)
        return rounds[:1], given

    source = animal(n_vertices=900)
    target = gmds.shapes.quadruped("walk", head_scale=2.0, seed=1, n_vertices=900)
    truth = gmds.shapes.truth(source, target)
    invariant = gmds.geodesic_error(gmds.match(source, target), truth).mean()
    monkeypatch.setattr(attempts, "rounds_of", in_one_round)
    regular = gmds.match(source, target, distance=lambda m: CommuteTimeDistance(eigenpairs(embedded(m), 60)))
    assert 100 * invariant < 1.6
    assert invariant < 0.5 * gmds.geodesic_error(regular, truth).mean()


def test_orientation_chooses_among_the_symmetries_of_a_surface() -> None:
    kept = gmds.match(LOBED, LOBED)
    turned = gmds.match(LOBED, LOBED, orientation="reverse")
    assert kept.meta["evidence"]["orientation"] > 0.9
    assert turned.meta["evidence"]["orientation"] < -0.9
    mirrors = [mirror_vertices(LOBED, axis) for axis in range(3)]
    mirrors.append(mirrors[0][mirrors[1][mirrors[2]]])
    assert min(off(turned, LOBED.vertices[mirror]) for mirror in mirrors) < 0.02


@pytest.mark.parametrize("orientation", ["reverse", "any"])
def test_a_mirror_image_is_matched_when_it_is_asked_for(orientation: Literal["reverse", "any"]) -> None:
    target = reflected(bumpy())
    answer = gmds.match(bumpy(), target, orientation=orientation)
    assert answer.meta["evidence"]["orientation"] < -0.9
    assert off(answer, target.vertices) < 1e-6


def test_landmarks_lead_to_the_map_they_ask_for() -> None:
    source, target = animal(n_vertices=400), animal("walk", 1, 400)
    truth, flipped = (gmds.shapes.truth(source, target, mirrored=m) for m in (False, True))
    marks = np.unique(np.linspace(0, source.n_vertices - 1, 7).astype(int))
    straight = gmds.match(source, target, landmarks=(marks, truth[marks].nearest_vertices()))
    assert 100 * gmds.geodesic_error(straight, truth).mean() < 6
    mirrored = gmds.match(source, target, landmarks=(marks, flipped[marks].nearest_vertices()), orientation="reverse")
    assert gmds.geodesic_error(mirrored, flipped).mean() < 0.3 * gmds.geodesic_error(mirrored, truth).mean()


def test_landmarks_as_positions_are_the_same_as_landmarks_as_indices() -> None:
    target = shapes.moved(bumpy(), 2.0)
    marks = np.array([3, 40, 90, 140])
    by_index = gmds.match(bumpy(), target, landmarks=np.stack([marks, marks], axis=1), n_samples=30)
    by_place = gmds.match(bumpy(), target, landmarks=(bumpy().vertices[marks], target.vertices[marks]), n_samples=30)
    assert np.array_equal(by_index.points.positions, by_place.points.positions)


def test_progress_is_reported_from_nothing_to_all() -> None:
    calls: list[tuple[str, float]] = []
    gmds.match(bumpy(), bumpy(), n_samples=20, progress=lambda stage, fraction: calls.append((stage, fraction)))
    fractions = [fraction for _, fraction in calls]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0 and fractions[-1] == 1
    assert len({stage for stage, _ in calls}) >= 3


def test_the_settings_are_told() -> None:
    answer = gmds.match(bumpy(), bumpy(), n_samples=20, orientation="any", rng=7)
    told = answer.meta["parameters"]
    assert (told["n_samples"], told["orientation"], told["rng"]) == (20, "any", 7)
    assert answer.meta["seconds"] > 0


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"landmarks": [[0, 1], [2, 162]]}, LandmarkError, "E301"),
        ({"landmarks": [[0, 1], [2, -1]]}, LandmarkError, "E301"),
        ({"landmarks": [[0, 1], [0, 2], [3, 4]]}, LandmarkError, "E302"),
        ({"landmarks": ([0, 1, 2], [0, 1])}, LandmarkError, "E303"),
        ({"landmarks": (np.eye(3), 50 * np.eye(3))}, LandmarkError, "E305"),
        ({"landmarks": "nose"}, LandmarkError, "E300"),
        ({"n_samples": 163}, SampleCountError, "E401.*3 to 162"),
        ({"n_samples": 0}, SampleCountError, "E401"),
        ({"n_samples": -5}, SampleCountError, "E401"),
        ({"n_samples": 20.0}, SampleCountError, "E401"),
        ({"n_sample": 20}, TypeError, "did you mean 'n_samples'"),
        ({"landmark": []}, TypeError, "did you mean 'landmarks'"),
        ({"zzz": 1}, TypeError, "there are source, target"),
        ({"orientation": "keep"}, ValueError, "one of 'preserve', 'reverse', 'any', 'auto', not 'keep'"),
    ],
)
def test_bad_options_are_refused_by_name(options: dict, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        gmds.match(bumpy(), bumpy(), **options)


def test_a_landmark_on_no_face_is_refused() -> None:
    with pytest.raises(LandmarkError, match="E304"):
        gmds.match(shapes.with_isolated(bumpy()), bumpy(), landmarks=[[0, 5], [4, 9], [50, 60]])


def test_what_is_no_mesh_is_refused() -> None:
    with pytest.raises(TypeError, match="Mesh"):
        gmds.match("dog.ply", bumpy())  # type: ignore[arg-type]
    with pytest.raises(MeshError, match="E113"):
        gmds.match(bumpy(), shapes.tetrahedron())
    with pytest.raises(MeshError, match="E113"):
        gmds.match(shapes.tetrahedron(), bumpy())
