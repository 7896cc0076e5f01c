"""Assignments of extremities: what was planted is found, with its scale, and nothing that disagrees."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geodesics.arrays import Bools, Floats
from gmds.parts import assignments
from gmds.parts.assignments import LEAST_SCALE, MOST_SCALE, TOLERANCE, Assignment, consistent_assignments, indices


def between(points: Floats) -> Floats:
    """Distances (k, k) of points (k, 3)."""
    return np.linalg.norm(points[:, None] - points, axis=2)


def planted(seed: int, k: int, scale: float, noise: float = 0.0) -> tuple[Floats, Floats, dict[int, int]]:
    """k points, `scale` times as far apart as some of eight others, and which of these."""
    rng = np.random.default_rng(seed)
    theirs = rng.uniform(size=(8, 3))
    chosen = rng.permutation(8)[:k]
    ours = between(theirs[chosen]) * scale
    error = np.triu(rng.uniform(-noise, noise, ours.shape), 1)
    return ours * np.exp(error + error.T), between(theirs), dict(enumerate(chosen.tolist()))


@given(
    seed=st.integers(0, 2**32 - 1),
    k=st.integers(3, 5),
    scale=st.floats(LEAST_SCALE + 0.01, MOST_SCALE - 0.01),
)
def test_a_planted_similarity_is_found_with_its_scale(seed: int, k: int, scale: float) -> None:
    ours, theirs, true = planted(seed, k, scale)
    found = consistent_assignments(ours, theirs)
    right = [one for one in found if dict(zip(one.ours, one.theirs, strict=True)).items() >= true.items()]
    assert right, "every planted pair, in one assignment"
    assert min(abs(np.log(one.scale / scale)) for one in right) < 1e-9 and min(one.spread for one in right) < 1e-9


def test_noise_below_the_tolerance_changes_little() -> None:
    ours, theirs, true = planted(3, 5, 1.5, noise=TOLERANCE / 3)
    best = max(consistent_assignments(ours, theirs), key=lambda one: (len(one.ours), -one.spread))
    assert dict(zip(best.ours, best.theirs, strict=True)) == true
    assert best.scale == pytest.approx(1.5, rel=TOLERANCE / 3) and best.spread < TOLERANCE / 3


@pytest.mark.parametrize("seed", range(5))
def test_whatever_is_found_agrees_with_itself(seed: int) -> None:
    """Injective, of at least two, all distances of one scale to within twice the tolerance, none twice."""
    rng = np.random.default_rng(seed)
    ours, theirs = between(rng.uniform(size=(6, 3))), between(rng.uniform(size=(7, 3)))
    found = consistent_assignments(ours, theirs)
    assert len({frozenset(zip(one.ours, one.theirs, strict=True)) for one in found}) == len(found) > 0
    for one in found:
        assert len(set(one.ours)) == len(one.ours) == len(set(one.theirs)) == len(one.theirs) >= 2
        logs = [
            np.log(ours[one.ours[i], one.ours[j]] / theirs[one.theirs[i], one.theirs[j]])
            for i, j in itertools.combinations(range(len(one.ours)), 2)
        ]
        assert np.ptp(logs) < 2 * TOLERANCE and min(logs) - 1e-9 < np.log(one.scale) < max(logs) + 1e-9


@pytest.mark.parametrize("scale", [LEAST_SCALE / 2, 2 * MOST_SCALE])
def test_scales_that_no_part_can_have_are_left_out(scale: float) -> None:
    theirs = between(np.eye(3))
    assert consistent_assignments(scale * theirs, theirs) == []
    assert consistent_assignments(1.2 * theirs, theirs) != []


def test_the_order_of_points_does_not_matter() -> None:
    ours, theirs, _ = planted(7, 4, 1.3)
    order = np.array([2, 0, 3, 1])
    plain, turned = consistent_assignments(ours, theirs), consistent_assignments(ours[np.ix_(order, order)], theirs)

    def largest(found: list[Assignment], names: Floats) -> set[tuple[int, int]]:
        best = max(found, key=lambda one: (len(one.ours), -one.spread))
        return {(int(names[i]), j) for i, j in zip(best.ours, best.theirs, strict=True)}

    assert largest(plain, np.arange(4)) == largest(turned, order)


def test_indices_are_both_sides() -> None:
    ours, theirs = indices(Assignment((3, 1), (0, 2), 1.0, 0.0))
    assert ours.tolist() == [3, 1] and theirs.tolist() == [0, 2]


def test_only_what_is_alike_is_assigned() -> None:
    ours, theirs, true = planted(5, 4, 1.2)
    alike = np.random.default_rng(0).uniform(size=(4, 8)) < 0.6
    alike[list(true), list(true.values())] = True
    found = consistent_assignments(ours, theirs, alike)
    assert found and all(alike[indices(one)].all() for one in found)
    assert any(dict(zip(one.ours, one.theirs, strict=True)) == true for one in found)
    alike[0, true[0]] = False
    without = consistent_assignments(ours, theirs, alike)
    assert not any((0, true[0]) in zip(one.ours, one.theirs, strict=True) for one in without)


def grown_one_by_one(pairs: list[tuple[int, int]], logs: Floats, log: float, alike: Bools) -> list[tuple[int, int]]:
    """`_grown` in words: of all pairs of free points the one that disagrees least, in the worst of its distances."""
    while True:
        gaps = {
            (i, a): max(abs(float(logs[i, j, a, b]) - log) for j, b in pairs)
            for i, a in zip(*np.nonzero(alike), strict=True)
            if all(i != j and a != b for j, b in pairs)
        }
        best = min(gaps, key=lambda pair: gaps[pair], default=None)
        if best is None or gaps[best] >= TOLERANCE:
            return pairs
        pairs = [*pairs, best]


@pytest.mark.parametrize("seed", range(4))
def test_they_grow_as_one_by_one(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    ours, theirs, _ = planted(seed, 5, 1.3, noise=TOLERANCE / 2)
    alike = np.random.default_rng(seed).random((5, 8)) < 0.8
    found = consistent_assignments(ours, theirs, alike)
    monkeypatch.setattr(assignments, "_grown", grown_one_by_one)
    assert found == consistent_assignments(ours, theirs, alike)
