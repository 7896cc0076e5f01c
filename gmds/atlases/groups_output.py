"""The files of a test of groups or of a covariate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.files.table import write_table
from gmds.morphometrics.group_tests import PointTests, ShapeTest
from gmds.morphometrics.hotelling import HotellingTest

DISCOVERY = 0.05  # rate of false discoveries, below which a point is one: a convention


COLUMNS = ["what", "r_squared", "f", "p", "t_squared", "components", "p_t_squared", "permutations"]

Tests = Mapping[str, tuple[ShapeTest, HotellingTest]]


def write_tests(
    tests: Tests, points: PointTests | None, mean: Mesh, folder: Path, slope: str = "slope of growth"
) -> None:
    """Write test.csv, and for two groups or a covariate points.csv and points.png, each atomically.

    `slope` says what the slope of each point is, beside the bar of the picture.

    Raises `MissingExtra` (E602) without the extra `viz`, `OSError`.
    """
    from gmds.pictures.values import write_values

    folder.mkdir(parents=True, exist_ok=True)
    rows = (
        [name, one.r_squared, one.f, one.p, t.t_squared, t.components, t.p, one.permutations]
        for name, (one, t) in tests.items()
    )
    write_table(folder / "test.csv", COLUMNS, rows)
    if points is None:
        return
    columns = np.column_stack([points.slope, points.low, points.high, points.p, points.q]).tolist()
    table = ([i, *(x if x == x else None for x in row)] for i, row in enumerate(columns))
    write_table(folder / "points.csv", ["vertex", "slope", "low", "high", "p", "q"], table)
    found = np.where(points.q < DISCOVERY, points.slope, np.nan)
    shown = [("slope of growth", mean, points.slope)]
    any_found = np.isfinite(found).any()
    if any_found:
        shown.append((f"where q < {DISCOVERY}", mean, found))
    title = "Growth" if any_found else f"Growth: nowhere is q < {DISCOVERY}"
    write_values(folder / "points.png", shown, signed=True, label=slope, pixels=460, title=title)


def write_growth(growth: Floats, names: Sequence[str], folder: Path) -> None:
    """Write growth.csv, the growth (k, n) of k specimens beside the mean, a column a specimen; atomically."""
    rows = ([i, *(x if x == x else None for x in row)] for i, row in enumerate(growth.T.tolist()))
    write_table(folder / "growth.csv", ["vertex", *names], rows, digits=6)
