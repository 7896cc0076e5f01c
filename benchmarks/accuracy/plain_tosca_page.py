"""What plain.md says of TOSCA, where the goal is missed, by distance: plain_tosca.csv beside the rows of maps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.accuracy.runs import Rows
from benchmarks.markdown import table
from gmds.files.table import read_table

NAME, COLUMNS = "plain_tosca.csv", ("cell", "pair", "ended", "stress_of_truth", "stress_ended")
GOAL = 2.5  # mean error x100
OF_TOSCA = """### Why TOSCA is missed

`python -m benchmarks.accuracy.plain_tosca`: "ended" is by how much (x100) 300 samples are off in the mean that least
squares place from their true places; then the root mean square residual, in per cent, at the truth and in the end: what
is least is not what is true, as bodies of TOSCA stretch from pose to pose, and distances with them. Where "ended" is
above the goal samples leave the truth by more than it wherever they start; where it is below, the rest is lost by the
start, and between samples."""


def of_tosca(output: Path, found: Rows, cells: Sequence[str]) -> list[str]:
    """A line a distance: the least mean of its losses, cats and others apart, and what the truth says of it."""
    if not (output / NAME).is_file():
        return []
    from_truth, lines = read_table(output / NAME), []
    for row_cell in dict.fromkeys(row["cell"] for row in from_truth):
        kind, a, *_ = row_cell.split()
        mine = [one for one in cells if one.split()[:2] == [kind, a] and not one.endswith("_50")]
        errors: Mapping[str, list[tuple[str, float]]] = {
            one: [(pair, float(row.direct or np.nan)) for (who, pair), row in found.items() if who == one]
            for one in mine
        }
        least = min(mine, key=lambda one: np.mean([error for _, error in errors[one]]))
        cats, others = (
            np.mean([error for pair, error in errors[least] if pair.startswith("cat") == cat]) for cat in (True, False)
        )
        rows = [row for row in from_truth if row["cell"] == row_cell]
        ended, true, end = (np.mean([float(row[name]) for row in rows]) for name in COLUMNS[2:])
        why = "the distance" if ended > GOAL else "start, and between samples"
        mean = np.mean([error for _, error in errors[least]])
        numbers = [f"{mean:.2f} ({least.split()[-1]})", f"{cats:.2f}", f"{others:.2f}", f"{ended:.2f}"]
        lines.append([kind, a, *numbers, f"{100 * true:.1f} / {100 * end:.1f}", why])
    head = ["distance", "a", "least mean", "cats", "others", "ended", "truth / ended", "what misses the goal"]
    return [OF_TOSCA, "", *table(head, lines)]
