"""Accuracy of `match` on the published pairs under GMDS_DATA, as the README quotes it.

    GMDS_DATA=... python benchmarks/accuracy.py [--variants]

Protocol of `gmds benchmark`: every mesh turned and resized at random, defaults only, mean geodesic error x100 against
the true correspondence. Writes one CSV a set, and accuracy.md, to benchmarks/results/. With `--variants` the `scaled`
pairs are also matched in one metric alone and with other losses. Hyper-parameters were chosen on the pairs of
`development_pairs.py`; none of those is among these.
"""

from __future__ import annotations

import functools
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import gmds
from gmds.benchmarking import BenchmarkRow, benchmark, means, write_csv
from gmds.cli.choices import chosen_distance
from gmds.datasets import dataset_pairs

DATA, RESULTS = Path(os.environ["GMDS_DATA"]), Path(__file__).parent / "results"
SETS = {"scaled": 1, "faust_5k": 8, "tosca_5k": 10}
VARIANTS: dict[str, Callable[..., gmds.Correspondence]] = {
    "metric of space alone": functools.partial(gmds.match, distance=chosen_distance("embedded", None)),
    "scale-invariant metric alone": functools.partial(gmds.match, distance=chosen_distance("scale-invariant", None)),
    "loss Huber": functools.partial(gmds.match, loss=gmds.Huber()),
    "loss Minimax": functools.partial(gmds.match, loss=gmds.Minimax()),
}
HEADER = "| pairs | direct | worst | sym | within 0.10 | coverage | CPU s a pair |\n|---|---|---|---|---|---|---|"


def line(name: str, rows: list[BenchmarkRow]) -> list[str]:
    """Table rows of the groups of a set."""
    lines = []
    for mean in means(rows):
        members = [row for row in rows if mean.group in (row.group, "all") and row.direct is not None]
        label = name if mean.group == "all" else f"{name}, group {mean.group}"
        worst = max(row.direct or 0.0 for row in members)
        lines.append(
            f"| {label} ({len(members)}) | {mean.direct:.2f} | {worst:.2f} | {mean.sym:.2f} | "
            f"{mean.within_010:.1f} % | {mean.coverage:.0f} % | {mean.cpu_seconds:.1f} |"
        )
    return lines


def run(folder: str, every: int, matcher: Callable[..., gmds.Correspondence]) -> list[BenchmarkRow]:
    """All rows of a set, told on stderr as they come."""
    rows = []
    for row in benchmark(dataset_pairs(DATA / folder, None)[::every], matcher):
        print(folder, row, file=sys.stderr)
        rows.append(row)
    return rows


def main() -> None:
    """Run, and write the tables."""
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    text = ["# Accuracy", "", f"`GMDS_DATA=... python benchmarks/accuracy.py {' '.join(sys.argv[1:])}` at {commit}."]
    text += ["Mean geodesic error x100, direct unless said; every mesh turned and resized at random.", "", HEADER]
    for folder, every in SETS.items():
        rows = run(folder, every, gmds.match)
        write_csv(RESULTS / f"{folder}.csv", [*rows, *means(rows)])
        text += line(folder if every == 1 else f"{folder}, every {every}th", rows)
    if "--variants" in sys.argv:
        text += ["", "## `scaled`, one thing changed", "", HEADER]
        for name, matcher in VARIANTS.items():
            text += line(name, run("scaled", 1, matcher))
    (RESULTS / "accuracy.md").write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    main()
