"""Compilation of kernels is reported, and happens once."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from places import ROOT

from geodesics.compiling import reporting_compilation
from gmds.cli.output import COMPILING, progress_bar

FIRST_USE = """
from geodesics._kernels.flips import corner_angle
from geodesics.compiling import reporting_compilation
reports = []
with reporting_compilation(reports.append):
    corner_angle(1.0, 1.0, 1.0)
print(reports)
"""

pytestmark = pytest.mark.skipif("NUMBA_DISABLE_JIT" in os.environ, reason="nothing is compiled")


def test_kernels_are_compiled_once_on_a_machine(tmp_path: Path) -> None:
    settings = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    root = ROOT
    reports = [
        subprocess.run(
            [sys.executable, "-c", FIRST_USE], env=settings, cwd=root, capture_output=True, check=True
        ).stdout
        for _ in range(2)
    ]
    assert [line.strip() for line in reports] == [b"[True, False]", b"[]"]


def test_nothing_is_reported_outside_the_block() -> None:
    reports: list[bool] = []
    with reporting_compilation(reports.append):
        pass
    numba.njit(lambda x: x + 1)(1)
    assert reports == []


def test_the_progress_line_says_so(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "100")
    with progress_bar("match") as progress:
        progress("measuring", 0.1)
        numba.njit(lambda x: x + 1)(1)
    shown = capsys.readouterr()
    assert f"match: measuring ({COMPILING})" in shown.err and not shown.out
