"""Proposals annealed from few eigenfunctions to many."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pytest
from matched_shapes import animal, permuted
from numpy.typing import NDArray

import gmds
from gmds.evaluation import geodesic_error
from gmds.matching.annealing import LEAST_GAIN, MOST_ANNEALED, SIZES, Annealing, annealed
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.shapes import quadruped
from gmds.shapes import truth as truth_of
from gmds.surface.measured import measure

Array = NDArray[np.float64]


@functools.cache
def turned() -> tuple[SurfacePair, Array]:
    """An animal and a copy, renumbered and in another place, and where the simplified source belongs on the copy."""
    mesh = animal()
    copy, place = permuted(mesh, 1)
    pair = SurfacePair(measure(mesh), measure(copy))
    return pair, pair.target.mesh.vertices[place[pair.simplified[0].origin]]


def annealing() -> Annealing:
    pair, _ = turned()
    return Annealing(*pair.simplified, (pair.source.regular, pair.target.regular))


def miss(places: Array) -> float:
    pair, truth = turned()
    return float(np.sqrt(pair.simplified[0].areas @ ((places - truth) ** 2).sum(axis=1)))


def test_shells_come_ever_nearer_to_the_target() -> None:
    target = turned()[0].simplified[1]
    gaps = [
        np.sqrt(target.areas @ ((shell.smooth - target.mesh.vertices) ** 2).sum(axis=1)) for shell in annealing().shells
    ]
    assert [shell.k for shell in annealing().shells] == list(SIZES)
    assert all(after < before for before, after in itertools.pairwise(gaps))
    assert gaps[-1] < 0.02 < gaps[0]  # root areas


def test_the_right_map_stays_the_right_map() -> None:
    _, truth = turned()
    assert miss(annealing().annealed(truth)) < 0.04  # the size of a face of the simplified target


@pytest.mark.parametrize("seed", [0, 1])
def test_a_rough_map_comes_near_the_truth(seed: int) -> None:
    """Every vertex off by a fifth of the root area: what is common to all of them is right."""
    _, truth = turned()
    rough = truth + 0.2 * np.random.default_rng(seed).normal(size=truth.shape) / np.sqrt(3)
    assert miss(rough) > 0.15
    assert miss(annealing().annealed(rough)) < 0.06


def test_the_likeliest_are_annealed_and_marked() -> None:
    pair, truth = turned()
    rng = np.random.default_rng(3)
    maps = [Proposal.of(pair, truth + rough * rng.normal(size=truth.shape)) for rough in np.linspace(0.3, 0.8, 8)]
    better = annealed(pair, maps)
    assert len(better) == MOST_ANNEALED
    assert all(one.improved for one in better)
    assert not any(one.improved for one in maps)
    likeliest, before = (min(some, key=lambda one: one.neg_log_likelihood) for some in (better, maps))
    assert likeliest.neg_log_likelihood < before.neg_log_likelihood - LEAST_GAIN
    assert miss(likeliest.registered.points.positions) < miss(before.registered.points.positions)


def test_nothing_is_added_where_nothing_is_gained() -> None:
    pair, truth = turned()
    assert annealed(pair, [Proposal.of(pair, truth)]) == []


@pytest.mark.parametrize(("tail", "seed"), [(1.3, 4), (1.5, 4)])
def test_a_head_is_not_turned_round(tail: float, seed: int) -> None:
    """Before, nose and ears were exchanged, an eighth of the points off, and the map called GOOD."""
    source, target = quadruped(n_vertices=1500), quadruped("walk", tail_scale=tail, n_vertices=1500, seed=seed)
    error = geodesic_error(gmds.match(source, target).points, truth_of(source, target))
    assert error.mean() < 0.015
    assert error.max() < 0.1
