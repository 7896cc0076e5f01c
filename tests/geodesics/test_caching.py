"""What is computed once per object."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geodesics.caching import keep, memoized


class Grid:
    """Counts how often it is asked."""

    def __init__(self) -> None:
        self.asked: list[float] = []

    @memoized
    def scaled(self, factor: float) -> NDArray[np.float64]:
        self.asked.append(factor)
        return factor * np.arange(3.0)


@memoized
def doubled(grid: Grid) -> NDArray[np.float64]:
    grid.asked.append(2.0)
    return 2 * np.arange(3.0)


def test_a_result_is_computed_once_for_each_object_and_key() -> None:
    one, other = Grid(), Grid()
    assert one.scaled(2.0) is one.scaled(2.0) and one.scaled(3.0) is not one.scaled(2.0)
    assert one.asked == [2.0, 3.0] and other.asked == []
    assert doubled(one) is doubled(one) and doubled(other) is not doubled(one)


def test_what_is_kept_cannot_be_changed() -> None:
    for kept in (Grid().scaled(2.0), doubled(Grid())):
        with pytest.raises(ValueError, match="read-only"):
            kept[0] = 1.0


def test_what_was_read_from_a_file_is_not_computed() -> None:
    grid = Grid()
    keep(doubled, grid, np.zeros(3))
    assert (doubled(grid) == 0).all() and grid.asked == []
