"""Every clause and row of the contract is held by tests that exist, and bad inputs end as promised."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from contract import CLAUSES, ROWS
from places import ROOT

TESTS = ROOT / "tests"
COUNTS = {"V": 20, "G": 30, "F": 18, "S": 9, "B": 10}


def test_nothing_is_left_out() -> None:
    assert list(CLAUSES) == [f"C{i}" for i in range(1, 11)]
    assert sorted(ROWS) == sorted(f"{kind}{i:02}" for kind, count in COUNTS.items() for i in range(1, count + 1))


@pytest.mark.parametrize("name", [*CLAUSES, *ROWS])
def test_the_tests_exist(name: str) -> None:
    for held in (CLAUSES[name][1] if name in CLAUSES else ROWS[name]).split(", "):
        file, _, test = held.partition("::")
        source = next(TESTS.rglob(f"{file}.py")).read_text(encoding="utf-8")
        assert re.search(rf"^def {test or 'test_'}", source, re.MULTILINE), held


def test_the_fault_table_holds(tmp_path: Path) -> None:
    """Every bad array, odd surface and broken file, each in a child process, through four entry points."""
    command = [sys.executable, "-m", "benchmarks.faults.faults", "--libraries", "gmds", "--output", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    kept, of = map(int, re.findall(r"(\d+) of (\d+) kept", done.stdout)[0])
    assert kept == of > 450
    assert (tmp_path / "faults.md").exists() and (tmp_path / "faults.csv").exists()
