"""Proposals annealed from few eigenfunctions to many."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pytest
from matched_shapes import animal, permuted
from numpy.typing import NDArray

from gmds.matching.annealing import MOST_ANNEALED, SIZES, Annealing, annealed
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import DECISIVE, Proposal
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
    maps = [Proposal.of(pair, truth + rough * rng.normal(size=truth.shape)) for rough in np.linspace(0.02, 0.8, 8)]
    assert min(one.neg_log_likelihood for one in maps) < DECISIVE
    assert annealed(pair, maps) == []  # one is an isometry
    maps = [one for one in maps if one.neg_log_likelihood > DECISIVE]
    better = annealed(pair, maps)
    assert len(better) == min(len(maps), MOST_ANNEALED) > 0
    assert all(one.annealed for one in better)
    assert not any(one.annealed for one in maps)
    best = min(maps, key=lambda one: one.neg_log_likelihood)
    assert miss(better[0].registered.points.positions) < miss(best.registered.points.positions) + 0.01
