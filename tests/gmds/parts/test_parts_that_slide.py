"""What is seen of a person from one side, on that person in another pose, slides until it covers what it should."""

from __future__ import annotations

import numpy as np
import pytest

from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.deformations import scan
from gmds.matching.pair import SurfacePair
from gmds.parts import search
from gmds.parts.part_map import IN_PLACE, PartMap
from gmds.registration.register import settled
from gmds.shapes import humanoid, truth
from gmds.surface.measured import measure

pytestmark = pytest.mark.usefixtures("few_faces")


@pytest.fixture(scope="module")
def pair() -> SurfacePair:
    return SurfacePair(measure(scan(humanoid(n_vertices=600), (0, 1, 0)).mesh), measure(walking()))


def walking() -> Mesh:
    return humanoid("walk", n_vertices=600, seed=3)


@pytest.fixture(scope="module")
def true(pair: SurfacePair) -> Floats:
    """Where the vertices (n, 3) of the simplified scan should be."""
    standing = humanoid(n_vertices=600)
    kept = np.flatnonzero(~scan(standing, (0, 1, 0)).missing)
    whole = truth(standing, walking())[kept]
    return whole.interpolate(pair.target.mesh.vertices)[pair.simplified[0].origin]


def error(pair: SurfacePair, true: Floats, one: PartMap) -> float:
    """Mean distance from there, in root areas of the whole."""
    return float(pair.simplified[0].areas @ np.linalg.norm(one.registered.y - true, axis=1))


def test_a_map_that_is_too_small_slides_to_its_place(
    pair: SurfacePair, true: Floats, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(search, "SLIDING", 0)
    before = likeliest(pair)
    after = search.slid(pair.simplified, before)
    right = PartMap.of(pair.simplified[0], settled(*pair.simplified, true, IN_PLACE))
    assert before.size < after.size < 1.02 * right.size
    assert after.neg_log_likelihood < before.neg_log_likelihood - 0.1
    assert error(pair, true, after) < 0.8 * error(pair, true, before)


def test_the_likeliest_map_of_a_scan_has_slid(pair: SurfacePair, true: Floats) -> None:
    found = likeliest(pair)
    assert error(pair, true, found) < 0.02
    again = search.slid(pair.simplified, found)
    assert again.neg_log_likelihood <= found.neg_log_likelihood
    assert error(pair, true, again) == pytest.approx(error(pair, true, found), abs=0.005)


def likeliest(pair: SurfacePair) -> PartMap:
    return search.part_maps(pair.source, pair.target, pair.simplified, lambda share: None)[0]
