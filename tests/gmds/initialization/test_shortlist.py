"""From many starts to a few distinct maps."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from matched_shapes import animal, bumpy, permuted, surface
from numpy.typing import NDArray

from gmds.initialization import ALL
from gmds.initialization.shortlist import DISTINCT, shortlist
from gmds.spectral.sample_maps import SampledPair
from gmds.surface.measured import measure

Index = NDArray[np.int64]


@pytest.fixture(scope="module")
def pair() -> SampledPair:
    view = surface(animal()).regular
    return SampledPair.of(view, view)


def same(pair: SampledPair) -> Index:
    """The identity, of as many samples as there are."""
    return np.arange(len(pair.source_samples))


@pytest.fixture(scope="module")
def found(pair: SampledPair) -> list[Index]:
    return shortlist(pair, ALL, 6)


def test_the_best_map_of_a_surface_to_itself_is_the_identity_or_the_mirror(
    pair: SampledPair, found: list[Index]
) -> None:
    gaps = [pair.gap(images, same(pair)) for images in found]
    assert min(gaps[:2]) < 0.02


def test_maps_are_whole_distinct_and_not_too_many(pair: SampledPair, found: list[Index]) -> None:
    assert 1 <= len(found) <= 6
    for images in found:
        assert images.shape == pair.source_samples.shape
        assert images.min() >= 0 and images.max() < len(pair.target_samples)
    for one, other in combinations(found, 2):
        assert pair.gap(one, other) > DISTINCT


def test_maps_of_less_stress_come_first(pair: SampledPair, found: list[Index]) -> None:
    stress = [pair.stress(images) for images in found]
    assert stress == sorted(stress)


def test_fewer_maps_are_the_first_of_more(pair: SampledPair, found: list[Index]) -> None:
    fewer = shortlist(pair, ALL, 2)
    assert len(fewer) == min(2, len(found))
    assert all(np.array_equal(one, other) for one, other in zip(fewer, found, strict=False))


def test_the_same_start_twice_is_one_map() -> None:
    view = surface(bumpy()).regular
    pair = SampledPair.of(view, view)
    assert len(shortlist(pair, [lambda one: [same(one), same(one)], lambda one: [same(one)]], 5)) == 1


def test_a_good_start_comes_before_a_bad_one() -> None:
    view = surface(bumpy()).regular
    pair = SampledPair.of(view, view)
    maps = shortlist(pair, [lambda one: [np.zeros_like(same(one)), np.roll(same(one), 40)], lambda one: [same(one)]], 5)
    assert np.array_equal(maps[0], same(pair))


def test_no_start_is_no_map() -> None:
    view = surface(bumpy()).regular
    assert shortlist(SampledPair.of(view, view), [lambda _: []], 5) == []


def test_maps_follow_a_renumbering() -> None:
    mesh, place = permuted(bumpy())
    ours, theirs = surface(bumpy()).regular, measure(mesh).regular
    pair = SampledPair.of(ours, theirs)
    best = pair.target_samples[shortlist(pair, ALL, 1)[0]]
    assert (best == place[pair.source_samples]).mean() > 0.9
