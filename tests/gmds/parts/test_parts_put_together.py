"""Rough maps of a part put together: a head that is turned round comes right, however large the part is."""

from __future__ import annotations

import numpy as np
import pytest
from cut_shapes import half_animal
from scipy.spatial.transform import Rotation

from geodesics.arrays import Bools, Floats
from gmds.matching.pair import SurfacePair
from gmds.parts.part_map import IN_PLACE, PartMap
from gmds.parts.realignment import SIZES, laid_anew
from gmds.parts.recombination import recombined
from gmds.registration.register import settled
from gmds.surface.measured import measure

VERTICES = 800


@pytest.fixture(scope="module")
def pair() -> SurfacePair:
    half = half_animal(VERTICES)
    return SurfacePair(measure(half.part), measure(half.whole))


@pytest.fixture(scope="module")
def right(pair: SurfacePair) -> Floats:
    """Where the vertices of the simplified part belong (n, 3)."""
    return half_animal(VERTICES).true.interpolate(pair.target.mesh.vertices)[pair.simplified[0].origin]


@pytest.fixture(scope="module")
def head(pair: SurfacePair) -> Bools:
    """The head of the simplified part (n,), which looks along x."""
    at = pair.source.original.vertices[pair.simplified[0].origin]
    return np.asarray((at[:, 0] > 0.8) & (at[:, 2] > 1.4))


def turned(pair: SurfacePair, right: Floats, head: Bools) -> PartMap:
    """The map of the part with the nose where an ear is, that ear where the other is, and so on."""
    middle = right[head].mean(axis=0)
    axis = right[head & (right[:, 2] > np.quantile(right[head, 2], 0.8))].mean(axis=0) - middle
    forward = right[head][right[head, 0].argmax()] - middle
    about = axis / np.linalg.norm(axis) + forward / np.linalg.norm(forward)
    turn = Rotation.from_rotvec(2 * np.pi / 3 * about / np.linalg.norm(about))
    source, target = pair.simplified
    y = right.copy()
    y[head] = target.mesh.vertices[target.places.query(turn.apply(right[head] - middle) + middle)[1]]
    return PartMap.of(source, settled(source, target, y, IN_PLACE))


def test_a_head_that_is_turned_round_comes_right(pair: SurfacePair, right: Floats, head: Bools) -> None:
    start = turned(pair, right, head)
    assert np.linalg.norm(start.registered.y - right, axis=1)[head].mean() > 0.1
    found = recombined(*pair.simplified, [start])
    likely = [one.neg_log_likelihood for one in found]
    assert likely == sorted(likely, reverse=True) and likely[-1] < start.neg_log_likelihood - 0.1
    assert np.linalg.norm(found[-1].registered.y - right, axis=1)[head].mean() < 0.02


def test_what_is_right_stays(pair: SurfacePair, right: Floats, head: Bools) -> None:
    source, target = pair.simplified
    best = PartMap.of(source, settled(source, target, right, IN_PLACE))
    assert recombined(source, target, [turned(pair, right, head), best]) == []


def test_regions_are_laid_as_large_as_the_part_is_on_the_whole(pair: SurfacePair, right: Floats, head: Bools) -> None:
    source, target = pair.simplified
    start = turned(pair, right, head)
    assert start.size < 0.9  # of a part of unit area
    found = laid_anew(source, target, start.registered.y, start.size)
    assert found
    for laid in found:
        x, y = (rows - rows.mean(axis=0) for rows in (source.mesh.vertices[laid.vertices], laid.y))
        ratio = np.linalg.norm(y) / np.linalg.norm(x) / start.size
        assert SIZES[0] <= ratio * (1 + 1e-12) and ratio <= SIZES[1] * (1 + 1e-12)
