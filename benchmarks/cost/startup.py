"""What a new process pays before its first match: import, kernels read from disk, kernels compiled for the first time.

    python -m benchmarks.cost.startup

Two built-in shapes of 600 vertices; the overhead is a first match minus the second. Compiled: with an empty
NUMBA_CACHE_DIR. Medians of three, wall seconds; writes results/startup.md.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from statistics import median

from benchmarks.places import RESULTS

PAGE = RESULTS / "startup.md"
GOALS = {"import gmds": 0.1, "gmds --help": None, "first match, kernels on disk": 1.5, "first match, compiled": 20}
RUNS = 3  # of which the median counts

TIMED = """
import json, time
start = time.perf_counter()
import gmds
imported = time.perf_counter() - start
a, b = (gmds.shapes.quadruped(pose, n_vertices=600) for pose in ("stand", "walk"))
times = []
for _ in range(2):
    start = time.perf_counter()
    gmds.match(a, b)
    times.append(time.perf_counter() - start)
print(json.dumps([imported, times[0] - times[1]]))
"""
HELP = """
import json, subprocess, sys, time
start = time.perf_counter()
subprocess.run([sys.executable, "-m", "gmds", "--help"], check=True, capture_output=True)
print(json.dumps([time.perf_counter() - start]))
"""


def said(script: str, cache: str) -> list[float]:
    """What a script prints in a process of its own."""
    env = {**os.environ, "NUMBA_CACHE_DIR": cache}
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, env=env)
    found: list[float] = json.loads(run.stdout)
    return found


def main() -> None:
    """Measure and write the page."""
    found: dict[str, list[float]] = {name: [] for name in GOALS}
    for _ in range(RUNS):
        with tempfile.TemporaryDirectory() as cache:
            found["first match, compiled"].append(said(TIMED, cache)[1])
            imported, overhead = said(TIMED, cache)
            found["import gmds"].append(imported)
            found["first match, kernels on disk"].append(overhead)
            found["gmds --help"].append(said(HELP, cache)[0])
    lines = ["# Starting up", "", "`python -m benchmarks.cost.startup`: wall seconds, medians of three.", ""]
    lines += ["| what | seconds | goal |", "|---|---|---|"]
    lines += [f"| {name} | {median(found[name]):.2f} | {goal or ''} |" for name, goal in GOALS.items()]
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
