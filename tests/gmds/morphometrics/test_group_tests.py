"""Tests find what is there and, as often as they promise, nothing where nothing is."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from geodesics.errors import BadArgument, BadShape
from gmds.errors import BadGroups
from gmds.landmarks.files import read_specimens
from gmds.morphometrics.group_tests import design, discoveries, point_tests, shape_test
from gmds.morphometrics.hotelling import hotelling_test
from gmds.morphometrics.sample_sizes import least_probability, told_of_sizes
from gmds.morphometrics.specimen_tables import read_column, write_points

RNG = np.random.default_rng(5)
GROUPS = ["dog"] * 6 + ["wolf"] * 6


def test_two_groups_that_differ_do_and_by_how_much() -> None:
    shapes = RNG.normal(size=(12, 20, 3)) * 0.1
    shapes[6:, 0] += 1
    found = shape_test(shapes, design(GROUPS))
    assert found.p <= 0.002 and found.r_squared > 0.5 and found.permutations == 999
    assert found.p == shape_test(shapes, design(GROUPS)).p  # the same draws every time


def test_of_one_number_it_is_the_analysis_of_variance() -> None:
    y = RNG.normal(size=12)
    found = shape_test(y[:, None], design(GROUPS), permutations=1)
    assert np.isclose(found.f, stats.f_oneway(y[:6], y[6:]).statistic)
    x = RNG.normal(size=12)
    assert np.isclose(shape_test(y[:, None], design(x), permutations=1).r_squared, stats.linregress(x, y).rvalue ** 2)


def test_hotelling_is_the_textbook_formula_and_sees_what_hardly_varies() -> None:
    rng = np.random.default_rng(11)
    scores = rng.normal(size=(12, 2))
    found = hotelling_test(scores, design(GROUPS), permutations=9)
    a, b = scores[:6], scores[6:]
    pooled = (5 * np.cov(a.T) + 5 * np.cov(b.T)) / 10
    delta = a.mean(axis=0) - b.mean(axis=0)
    assert found.components == 2 and np.isclose(found.t_squared, 3 * delta @ np.linalg.solve(pooled, delta))
    y = rng.normal(size=(12, 1))
    assert np.isclose(hotelling_test(y, design(GROUPS), permutations=1).t_squared, shape_test(y, design(GROUPS)).f)
    shapes = rng.normal(size=(12, 2)) * [1, 0.25]  # groups differ where they vary little
    shapes[6:, 1] += 0.6
    assert hotelling_test(shapes, design(GROUPS)).p < 0.02 and shape_test(shapes, design(GROUPS)).p > 0.2
    chance = [hotelling_test(rng.normal(size=(12, 4)), design(GROUPS), permutations=99, rng=i).p for i in range(60)]
    assert stats.kstest(chance, "uniform").pvalue > 0.01


def test_where_nothing_differs_probabilities_are_even() -> None:
    found = [shape_test(RNG.normal(size=(12, 4)), design(GROUPS), permutations=99, rng=i).p for i in range(60)]
    assert stats.kstest(found, "uniform").pvalue > 0.01


def test_points_are_regressions_and_discoveries_are_few() -> None:
    x = RNG.normal(size=12)
    values = RNG.normal(size=(12, 50))
    values[:, 0] = 2 * x + 0.01 * RNG.normal(size=12)
    values[3, 1] = np.nan
    found = point_tests(values, x)
    known = stats.linregress(np.delete(x, 3), np.delete(values[:, 1], 3))
    assert np.isclose(found.slope[1], known.slope) and np.isclose(found.p[1], known.pvalue)
    assert found.low[0] < 2 < found.high[0] and found.q[0] < 1e-6 and (found.q[1:] < 0.05).sum() <= 3
    values[:, 2] = np.nan
    assert np.isnan(point_tests(values, x).q[2]) and np.isnan(discoveries(np.array([np.nan]))).all()


def test_tables_say_what_is_missing(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("Name;species;mass\na.ply;dog;1,5\nb.ply;wolf;2\n")
    assert read_column(tmp_path / "t.csv", "species", ["b", "a"]).tolist() == ["wolf", "dog"]
    assert read_column(tmp_path / "t.csv", "mass", ["a", "b"]).tolist() == [1.5, 2.0]
    with pytest.raises(BadGroups, match=r"no column 'specie'.*species"):
        read_column(tmp_path / "t.csv", "specie", ["a"])
    with pytest.raises(BadGroups, match="nothing of c"):
        read_column(tmp_path / "t.csv", "mass", ["a", "c"])
    (tmp_path / "e.csv").write_text("name\n")
    with pytest.raises(BadGroups, match="no rows"):
        read_column(tmp_path / "e.csv", "name", ["a"])
    with pytest.raises(BadArgument, match="two groups"):
        design(["a", "a"])
    with pytest.raises(BadArgument, match="too few"):
        shape_test(np.zeros((2, 3)), design(["a", "b"]))
    with pytest.raises(BadShape, match="3 shapes and 2 rows"):
        shape_test(np.zeros((3, 3)), design(["a", "b"]))


@pytest.mark.parametrize("name", ["p.csv", "p.wide.csv", "p.tps"])
def test_points_are_read_back_as_they_were_written(name: str, tmp_path: Path) -> None:
    places = RNG.normal(size=(2, 5, 3))
    valid = np.ones((2, 5), dtype=bool)
    valid[1, 2] = False
    write_points(tmp_path / name, ["one", "two"], [f"P{i}" for i in range(5)], places, valid)
    read = read_specimens(tmp_path / name)
    assert list(read) == ["one", "two"]
    assert np.array_equal(read["one"].positions, places[0])
    assert np.array_equal(read["two"].defined, valid[1])


def test_of_few_specimens_all_ways_are_taken_and_said_to_be_few() -> None:
    rng = np.random.default_rng(3)
    scores, labels = rng.normal(size=(7, 3)), ["a"] * 3 + ["b"] * 4
    scores[3:, 0] += 50
    for test in (shape_test, hotelling_test):
        found = test(scores, design(labels), permutations=5)
        assert found.permutations == 35 and np.isclose(found.p, 1 / 35)
        assert found.p == test(scores, design(labels), permutations=5, rng=9).p
    assert least_probability(labels) == 1 / 35 and told_of_sizes(labels, "1234567") == []
    y = rng.normal(size=(4, 1))
    every = [shape_test(y, design(np.array(x, float))).f for x in itertools.permutations([1, 2, 3, 7])]
    assert np.isclose(shape_test(y, design([1.0, 2, 3, 7])).p, np.mean(np.array(every) >= every[0] * (1 - 1e-9)))


def test_no_place_is_surer_than_permuting_so_few_specimens_could_make_it() -> None:
    x = np.array([0.0, 0.0, 1.0])  # two of one group and one of the other: three ways to deal them out
    values = np.random.default_rng(2).normal(size=(3, 2000))
    values[:, 0] = x + np.array([0, 1e-9, 0])
    found = point_tests(values, x)
    assert found.p.min() == found.p[0] == least_probability(["a", "a", "b"]) and not (found.q < 1 / 3).any()
    halves = np.repeat([0.0, 1.0], 3)  # each division into two equal groups comes twice
    values = halves[:, None] + 1e-6 * np.random.default_rng(2).normal(size=(6, 4))
    values[0, 3] = np.nan  # of five there are as many ways as of six less those that swap names
    assert np.allclose(point_tests(values, halves).p, 0.1)
    covariate = np.array([1.0, 2, 4, 7])
    assert np.isclose(point_tests(covariate[:, None] + [[1e-9], [0], [0], [0]], covariate).p[0], 1 / 24)


def test_groups_of_one_are_named() -> None:
    alone, least = told_of_sizes(["cat", "cat", "dog"], ["x", "y", "z"])
    assert "group dog has one specimen, z:" in alone and "(cat 2, dog 1) p is 0.33 at the least" in least
    with pytest.raises(BadArgument, match=r"too few for a test: each of the 2 groups has one \(cat, dog\)"):
        told_of_sizes(["cat", "dog"], ["x", "y"])
    assert told_of_sizes(["cat", "cat"], ["x", "y"]) == [
        "of 2 specimens (cat 2) p is 1 at the least, whatever the difference"
    ]
    assert "of 3 specimens p is 0.17" in told_of_sizes([1.0, 2.0, 3.0], "xyz")[0]
