"""Where the project, the lists of pairs and the published tables lie."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "results"
LISTS = ROOT / "benchmarks" / "pairs"
