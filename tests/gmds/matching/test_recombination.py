"""Maps put together of maps: regions found, exchanged ones together, and the right map of two that are half wrong."""

from __future__ import annotations

import numpy as np
import pytest

from geodesics.arrays import Bools, Floats
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.matching.recombination import recombined
from gmds.registration.hybrids import exchanged, regions
from gmds.shapes import quadruped, truth
from gmds.surface.measured import measure


@pytest.fixture(scope="module")
def pair() -> SurfacePair:
    return SurfacePair(*(measure(quadruped(pose, n_vertices=800)) for pose in ("stand", "walk")))


@pytest.fixture(scope="module")
def right(pair: SurfacePair) -> Floats:
    """Where the vertices of the simplified source belong (n, 3)."""
    target = pair.target.original
    there = truth(pair.source.original, target).positions[pair.simplified[0].origin]
    return np.asarray((there - target.vertices.mean(axis=0)) / np.sqrt(target.area))


def legs(pair: SurfacePair) -> list[Bools]:
    """The four legs of the simplified source, (n,) each: the front two, the hind two."""
    at = pair.simplified[0].mesh.vertices
    low = at[:, 2] < np.quantile(at[:, 2], 0.25)
    front = at[:, 0] > np.median(at[low, 0])
    left = at[:, 1] > np.median(at[low, 1])
    return [low & front & left, low & front & ~left, low & ~front & left, low & ~front & ~left]


def with_exchanged(y: Floats, left: Bools, right: Bools) -> Floats:
    """The places y (n, 3) with those of two legs exchanged, as far as they can be."""
    result = y.copy()
    for here, there in ((left, right), (right, left)):
        result[here] = y[here] - y[here].mean(axis=0) + y[there].mean(axis=0)
    return result


def test_regions_are_where_two_maps_lead_elsewhere(pair: SurfacePair, right: Floats) -> None:
    source, leg = pair.simplified[0], legs(pair)[0]
    assert regions(source, right, right) == []
    several = regions(source, right, np.where(leg[:, None], right + np.eye(3)[0] / 2, right))
    found = np.any(several, axis=0)
    assert source.areas[found & leg].sum() > 0.6 * source.areas[leg].sum()
    assert source.areas[found & ~leg].sum() < 0.3 * source.areas[leg].sum()


def test_two_legs_that_are_exchanged_are_taken_together(pair: SurfacePair, right: Floats) -> None:
    one, other, third, _ = legs(pair)
    (both,) = exchanged([one, other, third], right, with_exchanged(right, one, other))
    np.testing.assert_array_equal(both, one | other)


def test_of_two_maps_that_are_half_wrong_the_right_one_is_made(pair: SurfacePair, right: Floats) -> None:
    a, b, c, d = legs(pair)
    wrong = [Proposal.of(pair, with_exchanged(right, *both)) for both in ((a, b), (c, d))]
    found = recombined(pair, wrong)
    assert found and all(one.improved for one in found)
    likelihoods = [one.neg_log_likelihood for one in (min(wrong, key=lambda one: one.neg_log_likelihood), *found)]
    assert likelihoods == sorted(likelihoods, reverse=True)

    def error(one: Proposal) -> float:
        return float(np.linalg.norm(one.registered.y - right, axis=1).mean())

    assert error(found[-1]) < 0.02 < min(map(error, wrong))


def test_of_one_map_nothing_can_be_made(pair: SurfacePair, right: Floats) -> None:
    assert recombined(pair, [Proposal.of(pair, right)]) == []
