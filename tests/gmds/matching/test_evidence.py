"""Which map to believe."""

from __future__ import annotations

from dataclasses import asdict, fields, replace

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy, mirror_vertices, surface
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints
from gmds.landmarks.checking import place_landmarks
from gmds.landmarks.constraints import LandmarkConstraints
from gmds.matching.evidence import Evidence, evidence
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.registration.register import assessed
from gmds.registration.residuals import Residuals
from gmds.registration.settings import FULL
from gmds.surface.measured import Surface, measure

Index = NDArray[np.int64]
LEFT = Residuals(energy=0.3, misfit=0.01, misfit_back=0.02, curvature=0.8, curvature_back=0.7)
WORSE = {"energy": 0.6, "misfit_back": 0.05, "curvature": 0.5, "curvature_back": 0.2, "landmarks": 1.5}
FAIR = Evidence(simplified=LEFT, simplified_back=LEFT, whole=LEFT, stress=0.05, orientation=0.4, folded=0.3)
LOBED = shapes.ellipsoid(2, (1.0, 1.4, 2.0))


def weighed(
    mine: Surface, images: Index, theirs: Surface | None = None, landmarks: LandmarkConstraints | None = None
) -> Evidence:
    """What speaks for a map of a surface to itself, or to its mirror image `theirs`."""
    pair = SurfacePair(mine, mine if theirs is None else theirs, landmarks, theirs is not None)
    points = SurfacePoints.at_vertices(pair.target.mesh, images)
    whole = assessed(*pair.full, points.positions, FULL).residuals
    simplified = Proposal.of(pair, points.positions[pair.simplified[0].origin]).residuals
    return evidence(pair, (mine.regular, pair.target.regular), points, simplified, whole)


def test_what_a_map_file_says_keeps_its_words() -> None:
    said = FAIR.as_meta()
    assert list(said) == ["outline", "outline_back", *[f.name for f in fields(FAIR)[2:]]]
    assert said["outline"] == asdict(LEFT) == said["whole"] and said["stress"] == FAIR.stress


@pytest.mark.parametrize("part", ["simplified", "simplified_back", "whole"])
@pytest.mark.parametrize("name", WORSE)
def test_a_worse_part_is_a_larger_loss_and_each_adds_up(name: str, part: str) -> None:
    worse = replace(LEFT, **{name: WORSE[name]})
    found = replace(FAIR, **{part: worse}).neg_log_likelihood - FAIR.neg_log_likelihood
    assert found > 0.1
    assert found == pytest.approx(worse.neg_log_likelihood - LEFT.neg_log_likelihood)


def test_where_there_is_a_boundary_the_outline_decides() -> None:
    worse = replace(LEFT, energy=0.6)
    opened = replace(FAIR, closed=False)
    assert replace(opened, whole=worse).neg_log_likelihood == opened.neg_log_likelihood
    assert replace(opened, simplified=worse).neg_log_likelihood > opened.neg_log_likelihood + 0.3
    mine, half = measure(bumpy()), measure(Mesh(bumpy().vertices, bumpy().faces[1:]))
    assert weighed(mine, np.arange(bumpy().n_vertices)).closed
    assert not weighed(half, np.arange(bumpy().n_vertices)).closed


def test_the_identity_has_nothing_against_it() -> None:
    found = weighed(surface(bumpy()), np.arange(bumpy().n_vertices))
    assert found.stress == pytest.approx(0, abs=1e-7)
    assert found.orientation > 0.99
    assert found.landmark_error == 0
    assert found.whole.energy < 1e-9
    for left in (found.simplified, found.whole):
        assert left.energy < 1e-3 and left.misfit_back < 1e-3
        assert left.curvature > 0.999 and left.curvature_back > 0.999


def test_no_map_has_less_loss_than_the_identity() -> None:
    mine, rng = surface(bumpy()), np.random.default_rng(0)
    same = np.arange(bumpy().n_vertices)
    best = weighed(mine, same).neg_log_likelihood
    near = bumpy().faces[np.searchsorted(np.sort(bumpy().faces.ravel()), same) // 3, 0]
    for other in (rng.permutation(same), np.zeros_like(same), near, same[::-1]):
        assert np.isfinite(weighed(mine, other).neg_log_likelihood)
        assert weighed(mine, other).neg_log_likelihood > best + 5


def test_a_constant_map_has_all_the_stress_and_no_orientation() -> None:
    found = weighed(surface(bumpy()), np.zeros(bumpy().n_vertices, dtype=np.int64))
    assert found.stress == pytest.approx(1)
    assert found.orientation == 0
    assert found.whole.misfit_back > 0.3  # nearly all of the target is left out
    assert found.whole.curvature == pytest.approx(0, abs=1e-9)


def test_a_torn_map_costs_more_energy_than_a_whole_one() -> None:
    mine, same = surface(bumpy()), np.arange(bumpy().n_vertices)
    torn = np.random.default_rng(1).permutation(same)
    found = weighed(mine, torn)
    assert found.whole.energy > 3 and found.simplified.energy > 1
    assert found.stress > 0.1


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_mirrored_map_loses_though_distances_can_not_tell(axis: int) -> None:
    mine, same = measure(LOBED), np.arange(LOBED.n_vertices)
    kept, turned = weighed(mine, same), weighed(mine, mirror_vertices(LOBED, axis))
    assert turned.stress == pytest.approx(0, abs=1e-6)
    assert turned.whole.curvature > 0.99
    assert turned.orientation == pytest.approx(-kept.orientation, abs=1e-6)
    assert turned.neg_log_likelihood > kept.neg_log_likelihood + 3


def test_where_orientation_is_to_be_reversed_the_mirrored_map_wins() -> None:
    mine, image = measure(LOBED), measure(LOBED, reflected=True)
    kept, turned = (weighed(mine, m, image) for m in (np.arange(LOBED.n_vertices), mirror_vertices(LOBED, 1)))
    assert kept.orientation < -0.9 or turned.orientation < -0.9
    assert (
        kept.neg_log_likelihood < turned.neg_log_likelihood - 3
        or turned.neg_log_likelihood < kept.neg_log_likelihood - 3
    )
    best = min(kept, turned, key=lambda found: found.neg_log_likelihood)
    assert best.orientation < -0.9 and best.whole.energy < 1e-9
    worst = max(kept, turned, key=lambda found: found.neg_log_likelihood)
    assert best.folded < 0.05 and worst.folded > 0.95


def test_what_is_folded_over_speaks_against_a_map_where_nothing_can_be_missing() -> None:
    losses = [replace(FAIR, folded=share).neg_log_likelihood for share in (0.0, 0.01, 0.1, 0.5)]
    assert losses == sorted(losses) and losses[3] - losses[1] == pytest.approx(np.log(50))
    opened = [replace(FAIR, folded=share, closed=False).neg_log_likelihood for share in (0.0, 0.5)]
    assert opened[0] == opened[1]


def test_landmarks_are_measured_from_where_they_belong() -> None:
    mine, same = surface(bumpy()), np.arange(bumpy().n_vertices)
    hit, miss = (place_landmarks([[3, 3], [40, other]], bumpy(), bumpy()).constraints for other in (40, 90))
    right, wrong = weighed(mine, same, landmarks=hit), weighed(mine, same, landmarks=miss)
    assert right.landmark_error == right.whole.landmarks == 0
    place = mine.mesh.vertices
    assert wrong.landmark_error == pytest.approx(np.linalg.norm(place[90] - place[40]) / 2)
    assert wrong.neg_log_likelihood > right.neg_log_likelihood + 3


def test_curvature_knows_the_inside_from_the_outside() -> None:
    dented = shapes.bumpy_sphere(2, seed=3)
    mine = measure(dented)
    order = np.argsort(mine.squashed_curvature)
    upside_down = np.empty(len(order), dtype=np.int64)
    upside_down[order] = order[::-1]  # the most convex place goes to the most hollow one
    assert weighed(mine, upside_down).whole.curvature < -0.5
