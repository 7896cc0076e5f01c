"""The search finds where half an animal lies on a whole one in another pose."""

from __future__ import annotations

import numpy as np
import pytest
from cut_shapes import half_animal
from generated_shapes import rectangle

from gmds.matching.pair import SurfacePair
from gmds.parts.extremities import inner_extremities
from gmds.parts.part_map import PartMap
from gmds.parts.search import APART, belief, part_maps
from gmds.registration.distinct import distinct
from gmds.surface.measured import measure

pytestmark = pytest.mark.usefixtures("few_faces")


@pytest.fixture(scope="module")
def pair() -> SurfacePair:
    half = half_animal()
    return SurfacePair(measure(half.part), measure(half.whole))


@pytest.fixture(scope="module")
def found(pair: SurfacePair) -> list[PartMap]:
    told: list[float] = []
    maps = part_maps(pair.source, pair.target, pair.simplified, told.append)
    assert told == sorted(told) and 0 < told[0] <= told[-1] <= 1
    return maps


def error(pair: SurfacePair, one: PartMap) -> float:
    """Mean distance in root areas of the whole from where the simplified part should be."""
    half = half_animal()
    true = half.true.interpolate(pair.target.mesh.vertices)[pair.simplified[0].origin]
    return float(np.linalg.norm(one.registered.y - true, axis=1).mean())


def test_the_likeliest_map_is_right_and_knows_its_size(pair: SurfacePair, found: list[PartMap]) -> None:
    assert error(pair, found[0]) < 0.05
    half = half_animal()
    assert found[0].size == pytest.approx(np.sqrt(half.part.area / half.whole.area), rel=0.1)


def test_maps_come_likeliest_first_and_differ(pair: SurfacePair, found: list[PartMap]) -> None:
    likely = [one.neg_log_likelihood for one in found]
    assert likely == sorted(likely)
    areas = pair.simplified[0].areas
    for i, one in enumerate(found):
        for other in found[:i]:
            assert np.sqrt(areas @ ((one.registered.y - other.registered.y) ** 2).sum(axis=1)) > APART
    again = distinct([*found[::-1], *found], pair.simplified[0].areas, APART)
    assert [id(one) for one in again] == [id(one) for one in found]


def test_belief_is_a_half_where_strain_is_typical(pair: SurfacePair, found: list[PartMap]) -> None:
    source = pair.simplified[0]
    believed = belief(source, found[0].registered)
    assert ((believed > 0) & (believed <= 1)).all()
    assert np.median(believed[source.usable]) == pytest.approx(0.5, abs=0.02)


def test_a_surface_without_extremities_is_found_by_points_inside_it(pair: SurfacePair) -> None:
    flat = SurfacePair(measure(rectangle(12, 12)), pair.target)
    assert len(inner_extremities(flat.source).vertices) < 2
    found = part_maps(flat.source, flat.target, flat.simplified, lambda share: None)
    assert all(np.isfinite(one.neg_log_likelihood) and np.isfinite(one.registered.y).all() for one in found)
