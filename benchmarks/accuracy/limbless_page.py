"""The page of shapes without limbs: a table of each half, and where a peer is better by more than `ALLOWED`."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.markdown import table
from geodesics.arrays import Floats

COLUMNS = ("pair", "kind", "half", "method", "version", "error", "status", "cpu_seconds")
ALL_SEEN = ("teeth", "skulls", "brain parts", "hand", "fish", "left-right")  # kinds of which every pair was looked at
ALLOWED = 0.5  # by which the best of the peers may be better, in percent of a root area
RIGHT, WRONG = 4.0, 10.0  # mean error below and above which a map is that
OURS = "gmds"
STATUSES = ("GOOD", "AMBIGUOUS", "POOR")

Rows = Sequence[dict[str, str]]


def errors(rows: Rows) -> Floats:
    """Mean error of every row; infinite where there is no map."""
    return np.array([float("inf") if one["error"] == "none" else float(one["error"]) for one in rows])


def figure(rows: Rows, what: Callable[[Floats], float]) -> str:
    """A figure of the errors; a dash where there are none."""
    return f"{what(errors(rows)):.2f}" if rows else "-"


def page(rows: Rows, kinds: Sequence[str], methods: Sequence[str], seen: Sequence[str], total: int) -> list[str]:
    """All of it."""
    versions = sorted({f"{one['method']}: {one['version']}" for one in rows})
    lines = ["# Shapes without limbs", "", "`python -m benchmarks.accuracy.limbless`; the script says how.", ""]
    lines += [f"{', '.join(versions)}. A star: hyper-parameters were chosen, or all of its pairs looked at, there.", ""]
    lines += [f"{len({one['pair'] for one in rows})} of {total} pairs have been run by one method or more so far.", ""]
    for half in ("reporting", "development"):
        of = [one for one in rows if one["half"] == half]
        lines += [f"## {half.capitalize()} half", "", *_errors(of, kinds, methods, seen)]
        lines += [*_statuses(of, kinds)]
    return [*lines, "## Where a peer is better", "", *_beaten(rows, kinds, methods)]


def _errors(rows: Rows, kinds: Sequence[str], methods: Sequence[str], seen: Sequence[str]) -> list[str]:
    head = ["kind", "pairs", *(f"{method}: mean, median, worst; CPU s" for method in methods)]
    lines = []
    for kind in kinds:
        of = [one for one in rows if one["kind"] == kind]
        if not of:
            continue
        cells = []
        for method in methods:
            own = [one for one in of if one["method"] == method]
            seconds = [float(one["cpu_seconds"]) for one in own if one["cpu_seconds"] != "none"]
            figures = ", ".join(figure(own, what) for what in (np.mean, np.median, np.max))
            cells.append(f"{figures}; {np.mean(seconds):.1f}" if seconds else "-")
        lines.append([kind + ("*" if kind in seen else ""), len({one["pair"] for one in of}), *cells])
    return table(head, lines)


def _statuses(rows: Rows, kinds: Sequence[str]) -> list[str]:
    """What ours says of itself."""
    names = {"right": (0.0, RIGHT), "between": (RIGHT, WRONG), "wrong": (WRONG, np.inf)}
    ours = [one for one in rows if one["method"] == OURS and one["kind"] in kinds]
    lines = []
    for name, (low, high) in names.items():
        of = [one for one, error in zip(ours, errors(ours), strict=True) if low <= error < high]
        counts = [sum(one["status"] == status for one in of) for status in STATUSES]
        lines.append([name, len(of), *counts])
    return table(["maps", "how many", *STATUSES], lines)


def _beaten(rows: Rows, kinds: Sequence[str], methods: Sequence[str]) -> list[str]:
    """Of each kind: on how many pairs the best of the peers is better by more than what is allowed, and which."""
    lines = []
    for kind in kinds:
        found, means = [], {}
        matched = {one["pair"] for one in rows if one["method"] == OURS}
        of = [one for one in rows if one["kind"] == kind and one["pair"] in matched]
        for method in methods:
            own = [one for one in of if one["method"] == method]
            if own:
                means[method] = float(np.mean(errors(own)))
        for pair in dict.fromkeys(one["pair"] for one in of):
            own = {one["method"]: float(errors([one])[0]) for one in of if one["pair"] == pair}
            best = min((error, name) for name, error in own.items() if name != OURS) if len(own) > 1 else None
            if best and OURS in own and own[OURS] > best[0] + ALLOWED:
                found.append(f"{pair} ({own[OURS]:.1f}; {best[1]} {best[0]:.1f})")
        peers = {name: mean for name, mean in means.items() if name != OURS}
        if not peers or OURS not in means:
            continue
        first = min(peers, key=lambda name: peers[name])
        holds = "yes" if means[OURS] <= peers[first] + ALLOWED else "no"
        pairs = len({one["pair"] for one in of})
        cells = [f"{means[OURS]:.2f}", f"{first} {peers[first]:.2f}", holds, f"{len(found)} of {pairs}"]
        lines.append([kind, *cells, "; ".join(found) or "-"])
    head = ["kind, both halves", "ours", "best peer", f"within {ALLOWED} in the mean", "pairs that are not", "which"]
    return table(head, lines)
