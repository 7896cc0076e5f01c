"""The model of confidence: that fitting finds what made the data, and that its figures mean what they say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.trust.fit import source_of
from benchmarks.trust.model import calibration_error, fitted, ranked, reliability, shift
from gmds.matching import weights

RNG = np.random.default_rng(0)
SIGNS = RNG.normal(size=(40_000, 3)) * (1, 5, 0.1) + (0, 3, 1)
TRUTH = 1 / (1 + np.exp(-(1.0 - 2 * SIGNS[:, 0] + 0.3 * SIGNS[:, 1])))
NEAR = RNG.random(len(SIGNS)) < TRUTH
COUNTS = np.ones(len(SIGNS))


def test_fitting_finds_the_probability_that_made_the_data() -> None:
    model = fitted(SIGNS, NEAR, COUNTS)
    found = model.confidence(SIGNS)
    assert np.abs(found - TRUTH).mean() < 0.04
    assert calibration_error(found, NEAR, COUNTS) < 0.04
    assert model.weights[0].weight < 0 < model.weights[1].weight
    beyond = model.confidence(SIGNS[:1] + np.array([1e6, 0, 0]))
    assert np.isclose(beyond, model.confidence(np.array([[model.weights[0].high, *SIGNS[0, 1:]]])))


def test_what_counts_nothing_teaches_nothing() -> None:
    wrong = np.concatenate([NEAR, ~NEAR])
    model = fitted(np.concatenate([SIGNS, SIGNS]), wrong, np.concatenate([COUNTS, 0 * COUNTS]))
    assert np.allclose(model.confidence(SIGNS), fitted(SIGNS, NEAR, COUNTS).confidence(SIGNS), atol=1e-4)


def test_the_calibration_error_of_right_and_of_wrong_probabilities() -> None:
    assert calibration_error(TRUTH, NEAR, COUNTS) < 0.01
    assert calibration_error(np.full(len(NEAR), 0.9), np.zeros(len(NEAR), dtype=bool), COUNTS) == pytest.approx(0.9)
    assert sum(share for *_, share in reliability(TRUTH, NEAR, COUNTS)) == pytest.approx(1)


def test_ranks_and_shifts() -> None:
    assert ranked(np.array([0.1, 0.2, 0.8, 0.9]), np.array([True, True, False, False])) == 1
    assert ranked(np.full(4, 0.5), np.array([True, False, True, False])) == 0.5
    assert np.isnan(ranked(TRUTH, np.zeros(len(TRUTH), dtype=bool)))
    assert abs(shift(TRUTH, NEAR, COUNTS)) < 0.05


def test_the_file_of_weights_is_what_is_written() -> None:
    model = fitted(SIGNS, NEAR, COUNTS)
    found: dict[str, object] = {}
    exec(compile(source_of(["a", "b", "c"], model), "weights.py", "exec"), found)
    assert list(found["WEIGHTS"]) == ["a", "b", "c"]  # type: ignore[call-overload]
    assert Path(weights.__file__).read_text(encoding="utf-8").startswith(source_of(["a", "b", "c"], model)[:60])
