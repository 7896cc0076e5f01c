"""Table 1 is made on built-in shapes, its collection is what its docstrings say, and its figures keep the promises."""

from __future__ import annotations

import json
import runpy
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, moved, torus
from places import ROOT

pytest.importorskip("matplotlib")
SCRIPTS = ROOT / "examples" / "paper"


@pytest.fixture
def scripts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(SCRIPTS))


def test_table_of_recognition_rates(scripts: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    report = tmp_path / "retrieval.md"
    arguments = ["table1_retrieval", "--small", "-o", str(tmp_path), "--report", str(report)]
    monkeypatch.setattr(sys, "argv", arguments)
    runpy.run_path(str(SCRIPTS / "table1_retrieval.py"), run_name="__main__")
    assert (tmp_path / "table1_retrieval.png").stat().st_size > 5000
    numbers = json.loads((tmp_path / "table1_retrieval.json").read_text(encoding="utf-8"))
    both = numbers["recognition"]["all"]["invariant HKS + HKS"]
    assert len(both) == 7 and all(rates["<= 1"]["recognised"] == 100 for rates in both.values())
    assert np.mean([rates["<= 5"]["recognised"] for rates in both.values()]) > 90
    assert all(one["nearest_neighbour"] > 80 for one in numbers["categories"].values())
    assert "| local-scale | 4 |" in report.read_text(encoding="utf-8")


def test_the_collection(scripts: None) -> None:
    collection: Any = __import__("transformed_shapes").collection
    poses = [moved(bumpy_sphere(2), seed=seed) for seed in range(4)]
    items = list(collection({"ball": poses, "ring": [torus(24, 12)]}, {"other": bumpy_sphere(2, seed=1)}))
    count = Counter((item.label, item.kind) for item in items)
    assert count["ball", "null"] == count["ring", "null"] == 1 and count["ball", "isometry"] == 3
    assert all(count["ring", kind] == 5 for kind in ("isometry", "topology", "micro-holes", "local-scale", "noise"))
    assert [item.strength for item in items if item.genuine] == [1, 2, 4]
    assert [item.kind for item in items][-1] == "distractor" and items[-1].strength == 0
