"""What a new process pays before its first match: import, kernels read from disk, kernels compiled for the first time.

    python -m benchmarks.cost.startup [--against ANOTHER_CHECKOUT] [--runs 3]

Two built-in shapes of 600 vertices; the overhead is a first match minus the second. Compiled: with an empty
NUMBA_CACHE_DIR. Medians over the runs; modules and memory are those of a process that has imported gmds, or has
matched. With --against, both checkouts are measured in turn, so that a busy machine is as unkind to one as to the
other. Writes results/startup.md.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from benchmarks.markdown import table
from benchmarks.places import RESULTS, ROOT

PAGE = RESULTS / "startup.md"
GOALS = {
    "import gmds, s": "0.1",
    "gmds --help, s": "",
    "first match, kernels on disk, s": "1.5",
    "first match, compiled, s": "20",
    "second match, CPU s": "",
    "modules after import gmds": "",
    "modules after gmds --help": "",
    "peak MB after a match": "",
}

IMPORTED = """
import json, sys, time
start = time.perf_counter()
import gmds
print(json.dumps([time.perf_counter() - start, len(sys.modules)]))
"""
HELP = """
import json, sys, time
start = time.perf_counter()
try:
    import gmds.cli
    gmds.cli.main(["--help"], prog_name="gmds")
except SystemExit:
    pass
print(json.dumps([len(sys.modules)]))
"""
WHOLE_HELP = """
import json, subprocess, sys, time
start = time.perf_counter()
subprocess.run([sys.executable, "-m", "gmds", "--help"], check=True, capture_output=True)
print(json.dumps([time.perf_counter() - start]))
"""
MATCHED = """
import json, resource, time
import gmds
a, b = (gmds.shapes.quadruped(pose, n_vertices=600) for pose in ("stand", "walk"))
times = []
for _ in range(2):
    start, cpu = time.perf_counter(), time.process_time()
    gmds.match(a, b)
    times.append((time.perf_counter() - start, time.process_time() - cpu))
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps([times[0][0] - times[1][0], times[1][1], peak]))
"""


def said(script: str, checkout: Path, cache: str) -> list[float]:
    """The figures that a script prints last, in a process of its own that imports the packages of a checkout."""
    env = {**os.environ, "NUMBA_CACHE_DIR": cache, "PYTHONPATH": str(checkout)}
    command = [sys.executable, "-c", script]
    run = subprocess.run(command, capture_output=True, text=True, check=True, env=env, cwd=checkout)
    found: list[float] = json.loads(run.stdout.splitlines()[-1])
    return found


def measured(checkout: Path) -> dict[str, float]:
    """Every figure once."""
    with tempfile.TemporaryDirectory() as cache:
        compiled = said(MATCHED, checkout, cache)[0]
        overhead, seconds, peak = said(MATCHED, checkout, cache)
        imported, modules = said(IMPORTED, checkout, cache)
        (helped,) = said(WHOLE_HELP, checkout, cache)
        (modules_of_help,) = said(HELP, checkout, cache)
    figures = (imported, helped, overhead, compiled, seconds, modules, modules_of_help, peak)
    return dict(zip(GOALS, figures, strict=True))


def commit(checkout: Path) -> str:
    """What is checked out."""
    command = ["git", "-C", checkout, "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def shown(name: str, value: float) -> str:
    """A figure as the page has it."""
    return f"{value:.3f}" if name.endswith("s") and "," in name else f"{value:.0f}"


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--against", type=Path, help="another checkout, measured in turn with this one")
    parser.add_argument("--runs", type=int, default=3, help="of which medians are taken (default: %(default)s)")
    options = parser.parse_args()
    checkouts = {"now": ROOT}
    if options.against is not None:
        checkouts = {f"at {commit(options.against)}": options.against.resolve(), **checkouts}
    runs = {title: [] for title in checkouts}  # type: dict[str, list[dict[str, float]]]
    for _ in range(options.runs):
        for title, checkout in checkouts.items():
            runs[title].append(measured(checkout))
    columns = {title: {name: median(run[name] for run in rows) for name in GOALS} for title, rows in runs.items()}
    lines = [[name, *(shown(name, column[name]) for column in columns.values()), goal] for name, goal in GOALS.items()]
    about = f"`python -m benchmarks.cost.startup{' --against CHECKOUT' if options.against else ''}`: medians of"
    text = ["# Starting up", "", f"{about} {options.runs}, wall seconds unless said.", ""]
    text += table(["what", *columns, "goal"], lines)
    PAGE.write_text("\n".join(text), encoding="utf-8")
    print("\n".join(text))


if __name__ == "__main__":
    main()
