"""What nearly as likely maps say against the likeliest."""

from __future__ import annotations

import numpy as np
import pytest

from gmds.maps.confidence import RADIUS
from gmds.matching.rivals import Rivals

HERE = np.zeros((10, 3))


def moved(count: int, by: float) -> np.ndarray:
    there = HERE.copy()
    there[:count, 0] = by
    return there


def test_a_map_alone_is_undisputed() -> None:
    rivals = Rivals.of([-12.0], [HERE])
    assert rivals.margin == np.inf and (rivals.undisputed == 1).all()


def test_where_an_equally_likely_map_leads_elsewhere_either_may_be_right() -> None:
    rivals = Rivals.of([-12.0, -12.0], [HERE, moved(2, 0.3)])
    np.testing.assert_allclose(rivals.undisputed, [0.5] * 2 + [1.0] * 8)
    assert rivals.margin == np.inf  # not another map as a whole


@pytest.mark.parametrize("less", [0.1, 1.0, 5.0])
def test_odds_are_those_of_the_likelihoods(less: float) -> None:
    rivals = Rivals.of([-12.0, -12.0 + less], [HERE, moved(1, 0.5)])
    disputed = rivals.undisputed[0]
    assert disputed / (1 - disputed) == pytest.approx(np.exp(less))


def test_three_equal_maps_share_a_point() -> None:
    rivals = Rivals.of([-1.0] * 3, [HERE, moved(1, 0.4), moved(1, -0.4)])
    assert rivals.undisputed[0] == pytest.approx(1 / 3)


def test_what_both_have_within_the_radius_may_both_be_right() -> None:
    rivals = Rivals.of([-1.0, -1.0], [HERE, moved(1, 1.9 * RADIUS)])
    assert (rivals.undisputed == 1).all()


def test_another_map_as_a_whole_has_a_margin_and_disputes_no_single_point() -> None:
    rivals = Rivals.of([-12.0, -9.5], [HERE, moved(10, 1.0)])
    assert rivals.margin == pytest.approx(2.5) and (rivals.undisputed == 1).all()
