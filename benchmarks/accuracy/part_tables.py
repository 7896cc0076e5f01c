"""Tables of maps of parts: how right they are, what of them is marked, and how honest their status is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.markdown import table

FAILED = 20  # an error x100 above which a pair has failed
WRONG, RIGHT = 15, 5  # an error x100 above which no map should be GOOD, and below which none should be POOR
NAMES = ["group", "pairs", "error x100", "median", "worst", f"above {FAILED}", "IoU", "precision", "recall"]
NAMES += [f"above {WRONG} and GOOD", f"below {RIGHT} and POOR", "CPU s", "goal"]
STATUS = ["pairs", f"maps above {WRONG}", "not GOOD", "share", f"maps below {RIGHT}", "POOR", "share"]

Row = Mapping[str, str]


def cells_of(group: str, some: Sequence[Row], goal: str) -> list[Any]:
    """A group as a row of the table with the columns `NAMES`."""
    errors = np.array([float(one["error"]) for one in some])
    figures = [f"{errors.mean():.2f}", f"{np.median(errors):.2f}", f"{errors.max():.2f}"]
    means = [f"{np.mean([float(one[key]) for one in some]):.2f}" for key in ("iou", "precision", "recall")]
    good = sum(one["status"] == "GOOD" and float(one["error"]) > WRONG for one in some)
    poor = sum(one["status"] == "POOR" and float(one["error"]) < RIGHT for one in some)
    seconds = f"{np.median([float(one['cpu_seconds']) for one in some]):.1f}"
    failed = f"{(errors > FAILED).sum()} of {len(some)}"
    return [group, len(some), *figures, failed, *means, good, poor, seconds, goal]


def statuses(halves: Mapping[str, Sequence[Row]]) -> list[str]:
    """How often a map that is wrong says so, and how often one that is right is called wrong."""
    lines = []
    for title, rows in halves.items():
        wrong = [one["status"] != "GOOD" for one in rows if float(one["error"]) > WRONG]
        right = [one["status"] == "POOR" for one in rows if float(one["error"]) < RIGHT]
        lines.append([title, *_counted(wrong), *_counted(right)])
    return table(STATUS, lines)


def _counted(said: Sequence[bool]) -> list[Any]:
    """How many there are, how many of them are true, and the share of these."""
    return [len(said), sum(said), f"{100 * sum(said) / len(said):.0f} %" if said else "-"]
