"""Copies that lost digits, vertices or a dimension; `benchmarks/fuzzing/damaged.py` takes as many as one likes."""

from __future__ import annotations

import importlib
import re
from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

damaged: Any = importlib.import_module("benchmarks.fuzzing.damaged")
MATCHED = ("grid of 4", "grid of 2 ", "e+06 extents", "e+07 extents", "1e-15", "90.0% on", "50% in")
ANSWER = re.compile(r"answered|E\d{3}")


@pytest.mark.parametrize("name", damaged.DAMAGES)
def test_what_is_measured_is_a_number_or_a_typed_error(name: str) -> None:
    hurt = damaged.hurt(name, bumpy_sphere(2), 0)
    assert [found for ask in damaged.measurements(*hurt) if not ANSWER.fullmatch(found := damaged.outcome(ask))] == []


@pytest.mark.parametrize("name", [name for name in damaged.DAMAGES if any(part in name for part in MATCHED)])
def test_a_match_is_an_answer_or_a_typed_error(name: str) -> None:
    mesh = bumpy_sphere(2)
    hurt = damaged.hurt(name, mesh, 0)
    assert [found for ask in damaged.matches(*hurt, mesh) if not ANSWER.fullmatch(found := damaged.outcome(ask))] == []


def test_raw_errors_warnings_and_no_numbers_are_seen() -> None:
    assert damaged.outcome(lambda: np.zeros(2)) == "answered"
    assert damaged.outcome(lambda: np.array([1.0, np.inf])) == "WRONG: not a number"
    assert damaged.outcome(lambda: np.ones(1) / np.zeros(1)).startswith("WRONG: RuntimeWarning: divide")
    assert damaged.outcome(lambda: np.linalg.cholesky(-np.eye(2))).startswith("WRONG: LinAlgError")
