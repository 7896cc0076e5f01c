"""Plain generalised multidimensional scaling: what is proposed, tabulated, placed and continued."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import joined, torus
from matched_shapes import animal, bumpy, surface

import gmds
from geodesics import CommuteTimeDistance, Distance, GeodesicDistance, Mesh, SurfacePoints, eigenpairs, scale_invariant
from gmds.matching.given_distances import GivenDistances, placed_in_given, relative_weights
from gmds.matching.pair import SurfacePair
from gmds.matching.steps import rounds_of
from gmds.mds.losses import Huber, LeastSquares, Loss, Minimax
from gmds.mds.pair_distances import pairwise
from gmds.shapes import truth
from gmds.spectral.refinement import Refiner
from gmds.surface.measured import EXPONENTS


def invariant(mesh: Mesh) -> Distance:
    return CommuteTimeDistance(eigenpairs(scale_invariant(mesh, smoothing=0.02), 60))


def marched(mesh: Mesh) -> Distance:
    return GeodesicDistance(scale_invariant(mesh, exponent=0.5, smoothing=0.02))


def test_maps_are_proposed_in_the_metric_given_and_in_that_of_space() -> None:
    pair = SurfacePair(surface(bumpy()), surface(bumpy()))
    (views_of_given, _), given = rounds_of(pair, invariant)
    views = views_of_given()
    assert given is not None and views == [given.views, (pair.source.regular, pair.target.regular)]
    (views_of_given, curved), given = rounds_of(pair, lambda mesh: CommuteTimeDistance(eigenpairs(mesh, 60)))
    views = views_of_given()
    assert given is not None and views == [given.views]  # that is the metric of space already
    assert len(curved()) == len(EXPONENTS)  # where these do not decide


def test_what_has_no_coordinates_is_tabulated() -> None:
    mine = surface(bumpy())
    assert all(isinstance(one, gmds.TabulatedDistance) for one in GivenDistances.of(mine, mine, marched).distances)
    assert all(isinstance(one, CommuteTimeDistance) for one in GivenDistances.of(mine, mine, invariant).distances)


def test_what_is_placed_right_stays_and_is_continued() -> None:
    mine, same = surface(animal()), np.arange(animal().n_vertices)
    here = SurfacePoints.at_vertices(mine.mesh, same)
    samples = mine.regular.samples(200)
    points = Refiner(mine, mine).continued(samples, here[samples], here)
    assert np.linalg.norm(points.positions - mine.mesh.vertices, axis=1).mean() < 0.02
    assert np.linalg.norm(points.positions - mine.mesh.vertices, axis=1).max() < 0.15


@pytest.mark.parametrize("loss", [LeastSquares(), Huber(), Minimax()], ids=repr)
@pytest.mark.parametrize("distance", [invariant, marched], ids=lambda f: f.__name__)
def test_a_rough_map_is_improved_by_every_loss_in_every_distance(distance: Callable, loss: Loss) -> None:
    source, target = animal(), animal("walk", seed=1)
    true = truth(source, target)
    mine, other = surface(source), surface(target)
    pair = SurfacePair(mine, other)
    shaken = true.positions + np.random.default_rng(1).normal(0, 0.15, (len(true), 3))
    rough = SurfacePoints.closest(target, shaken).nearest_vertices()
    given = GivenDistances.of(mine, other, distance)
    points, solution = placed_in_given(pair, rough, given, loss, 100)
    before = gmds.geodesic_error(SurfacePoints.at_vertices(target, rough), true).mean()
    after = gmds.geodesic_error(SurfacePoints(target, other.face_index[points.face], points.barycentric), true).mean()
    assert after < 0.5 * before
    assert len(solution.points) == 100 and np.isfinite(solution.stress)


def test_a_map_by_minimax_tells_its_certificate(tmp_path: Path) -> None:
    """As `Solution.certificate` says: hardly any share of the maximum could still be saved; and files keep it."""
    answer = gmds.match(animal(), animal("walk", seed=1), distance=invariant, loss=Minimax(), n_samples=40)
    assert answer.meta["solver"] == "CONVERGED" and 0 <= answer.meta["certificate"] <= 0.01
    answer.save(tmp_path / "map.npz")
    assert json.loads(np.load(tmp_path / "map.npz")["meta"].tobytes())["certificate"] == answer.meta["certificate"]


def test_far_pairs_weigh_less_whatever_the_unit() -> None:
    """Twice the distance, and the weights are a quarter everywhere: they are scaled to mean 1 by the problem."""
    mesh = bumpy()
    points = SurfacePoints.at_vertices(mesh, np.arange(0, mesh.n_vertices, 20))
    twice = Mesh(2 * mesh.vertices, mesh.faces)
    weights = relative_weights(pairwise(GeodesicDistance(mesh), points).distances())
    there = SurfacePoints(twice, points.face, points.barycentric)
    same = relative_weights(pairwise(GeodesicDistance(twice), there).distances())
    np.testing.assert_allclose(weights / weights.mean(), same / same.mean(), rtol=1e-9)
    distances = GeodesicDistance(mesh).field(points)[:, np.arange(0, mesh.n_vertices, 20)]
    far, near = (
        np.unravel_index(where(distances + np.eye(len(points))), weights.shape) for where in (np.argmax, np.argmin)
    )
    assert weights[far] < 0.1 * weights[near]


def test_pairs_out_of_reach_weigh_nothing() -> None:
    both = joined(bumpy(), torus(24, 12))
    points = SurfacePoints.at_vertices(both, [0, 40, both.n_vertices - 1])
    weights = relative_weights(pairwise(GeodesicDistance(both), points).distances())
    assert weights[0, 2] == 0 and weights[0, 1] > 0 and np.isfinite(weights).all()
