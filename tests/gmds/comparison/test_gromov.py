"""Bounds hold: against every permutation of few points, for isometric sets, and one above the other."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import gmds
from geodesics.errors import BadArgument
from gmds.comparison.gromov_hausdorff import distortion


def random_distances(count: int, seed: int) -> np.ndarray:
    x = np.random.default_rng(seed).normal(size=(count, 3))
    return np.linalg.norm(x[:, None] - x, axis=2)


def least_gromov_hausdorff(a: np.ndarray, b: np.ndarray) -> float:
    """By trying all pairs of maps there and back, whose unions hold every smallest correspondence."""
    p, q = len(a), len(b)
    there, back = itertools.product(range(q), repeat=p), list(itertools.product(range(p), repeat=q))
    here, others = np.arange(p), np.arange(q)
    return 0.5 * min(distortion(a, b, np.r_[here, g], np.r_[f, others]) for f in there for g in back)


@pytest.mark.parametrize("seed", range(6))
def test_gromov_hausdorff_lies_between_its_bounds(seed: int) -> None:
    a, b = random_distances(4, seed), random_distances(3, 100 + seed)
    bounds, exact = gmds.gromov_hausdorff_bounds(a, b), least_gromov_hausdorff(a, b)
    assert bounds.lower <= exact + 1e-12 and exact <= bounds.upper + 1e-12
    assert bounds.lower >= 0.5 * abs(a.max() - b.max()) - 1e-12  # never worse than the diameters


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_gromov_wasserstein_lies_between_its_bounds(order: Any, seed: int) -> None:
    a, b = random_distances(6, seed), random_distances(6, 50 + seed)
    bounds = gmds.gromov_wasserstein_bounds(a, b, order=order)
    costs = [(np.abs(a - b[np.ix_(p, p)]) ** order).mean() for p in map(list, itertools.permutations(range(6)))]
    assert bounds.lower <= 0.5 * min(costs) ** (1 / order) + 1e-12
    assert bounds.upper >= 0.5 * min(costs) ** (1 / order) - 1e-12


def test_relabelled_copies_are_at_distance_nothing() -> None:
    a = random_distances(30, 0)
    order = np.random.default_rng(1).permutation(30)
    b = a[np.ix_(order, order)]
    wasserstein = [gmds.gromov_wasserstein_bounds(a, b, order=r) for r in (1, 2)]
    for bounds in (gmds.gromov_hausdorff_bounds(a, b), *wasserstein):
        assert bounds.lower == pytest.approx(0, abs=1e-7) and bounds.upper == pytest.approx(0, abs=1e-7)


def test_bounds_scale_and_are_symmetric_below() -> None:
    a, b = random_distances(20, 3), random_distances(20, 4)
    one, twice = gmds.gromov_hausdorff_bounds(a, b), gmds.gromov_hausdorff_bounds(2 * a, 2 * b)
    assert twice.lower == pytest.approx(2 * one.lower) and twice.upper == pytest.approx(2 * one.upper)
    assert gmds.gromov_hausdorff_bounds(b, a).lower == pytest.approx(one.lower)
    wide = gmds.gromov_hausdorff_bounds(a, b, covering=(0.1, 0.2))
    assert wide.lower == pytest.approx(max(one.lower - 0.3, 0)) and wide.upper == pytest.approx(one.upper + 0.3)
    assert gmds.gromov_hausdorff_bounds(a, a, start=np.arange(20)).upper == 0


@pytest.mark.parametrize(
    "call",
    [
        lambda: gmds.gromov_hausdorff_bounds([[0, 1]], [[0]]),
        lambda: gmds.gromov_hausdorff_bounds([[0, np.inf], [np.inf, 0]], [[0]]),
        lambda: gmds.gromov_hausdorff_bounds([[0]], [[0]], start=[3]),
        lambda: gmds.gromov_wasserstein_bounds([[0]], np.zeros((2, 2))),
        lambda: gmds.gromov_wasserstein_bounds([[0]], [[0]], order=3),
    ],
)
def test_what_cannot_be_is_refused(call: Any) -> None:
    with pytest.raises(BadArgument):
        call()
