"""Tables of benchmark rows, in Markdown."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from statistics import fmean, median

from benchmarks.accuracy.halves import PARTIAL
from benchmarks.markdown import table
from gmds.benchmarking.run import BenchmarkRow
from gmds.maps.point_map import MatchStatus

Sections = Mapping[str, Sequence[BenchmarkRow]]
Summary = Callable[[list[float]], float]

WRONG_ABOVE = 15.0  # mean error x100 above which a map is wrong as a whole; a convention
LISTED_ABOVE = 10.0  # likewise, above which a pair is listed by name
GOALS = {
    "scaled, self": "<= 2.0",
    "scaled, pose": "<= 3.5",
    "faust_5k": "<= 1.4, worst <= 4",
    "tosca_5k": "<= 1.6, worst <= 5",
    "tosca_cross_5k": "<= 9",
    "shrec20, test sets 1-4": "<= 12",
    "shrec20, test set 0 (partial)": "<= 20",
}


def sections(name: str, rows: Iterable[BenchmarkRow]) -> dict[str, list[BenchmarkRow]]:
    """The rows of a set under the names that the goals have."""
    found: dict[str, list[BenchmarkRow]] = {}
    for row in rows:
        label = name
        if name == "scaled":
            label = f"{name}, {row.group}"
        elif name == "shrec20":
            label = f"{name}, " + ("test set 0 (partial)" if row.group == PARTIAL else "test sets 1-4")
        found.setdefault(label, []).append(row)
    return found


def figures(rows: Iterable[BenchmarkRow], column: str) -> list[float]:
    """The values of a column, of the pairs that have one."""
    return [value for row in rows if (value := getattr(row, column)) is not None]


def number(
    rows: Iterable[BenchmarkRow], column: str, of: Callable[[list[float]], float] = fmean, digits: int = 2
) -> str:
    """One figure for a column, the mean unless said; a dash where there is none."""
    values = figures(rows, column)
    return f"{of(values):.{digits}f}" if values else "-"


def accuracy(found: Sections, goals: Mapping[str, str] = GOALS) -> list[str]:
    """A line for each section: errors, percentages, coverage, honesty of `distortion`, time, goal."""
    head = ["set", "pairs", "direct", "median", "worst", "min(direct, sym)", "% < 0.05", "% < 0.10", "coverage %"]
    head += ["distortion corr.", "CPU s", "goal"]
    lines = []
    for label, rows in found.items():
        errors = [number(rows, "direct", of) for of in (fmean, median, max)]
        shares = [number(rows, column, digits=1) for column in ("within_005", "within_010", "coverage")]
        others = [number(rows, "distortion_correlation"), number(rows, "cpu_seconds", digits=1)]
        lines.append([label, count(rows), *errors, number(rows, "best"), *shares, *others, goals.get(label, "-")])
    return table(head, lines)


def count(rows: Sequence[BenchmarkRow]) -> str:
    """How many pairs there are, and how many of them failed."""
    failed = len(rows) - len(figures(rows, "direct"))
    return f"{len(rows)}" + (f" ({failed} failed)" if failed else "")


def halves(found: Sections, development: Collection[str]) -> list[str]:
    """Mean and worst error on the pairs that hyper-parameters were chosen on, and on the others."""
    head = ["set", "development pairs", "direct", "worst", "reporting pairs", "direct", "worst"]
    lines = []
    for label, rows in found.items():
        line = [label]
        for wanted in (True, False):
            half = [row for row in rows if (row.pair in development) == wanted]
            line += [count(half), number(half, "direct"), number(half, "direct", max)]
        lines.append(line)
    return table(head, lines)


def statuses(found: Sections) -> list[str]:
    """How often a map that is wrong as a whole says so, and how often one that is right cries wolf."""
    head = [
        "set", f"pairs above {WRONG_ABOVE:.0f}", "not GOOD", "detected",
        f"pairs up to {WRONG_ABOVE:.0f}", "not GOOD", "false alarms",
    ]  # fmt: skip
    together = [row for rows in found.values() for row in rows]
    lines = []
    for label, rows in {**found, "all": together}.items():
        judged = [row for row in rows if row.direct is not None]
        line = [label]
        for wrong in (True, False):
            members = [row for row in judged if ((row.direct or 0.0) > WRONG_ABOVE) == wrong]
            doubted = sum(row.status != MatchStatus.GOOD.name for row in members)
            share = f"{100 * doubted / len(members):.0f} %" if members else "-"
            line += [f"{len(members)}", f"{doubted}", share]
        lines.append(line)
    return table(head, lines)


def missing_parts(found: Sections) -> list[str]:
    """Whether `valid` distinguishes points with a counterpart from those without one, where the data knows of both."""
    head = ["set", "pairs", "with counterpart, valid %", "without, not valid %", "pairs with such"]
    lines = []
    for label, rows in found.items():
        if figures(rows, "missing_found"):
            told = [row for row in rows if row.missing_found is not None]
            shares = [number(rows, "valid", digits=1), number(told, "missing_found", digits=1)]
            lines.append([label, count(rows), *shares, f"{len(told)}"])
    return table(head, lines)


def failures(found: Sections) -> list[str]:
    """The pairs that failed or whose error is large, worst first."""
    bad = [(label, row) for label, rows in found.items() for row in rows if _error(row) > LISTED_ABOVE]
    bad.sort(key=lambda item: -_error(item[1]))
    lines = [[label, row.pair, number([row], "direct"), number([row], "sym"), row.status] for label, row in bad]
    return table(["set", "pair", "direct", "sym", "status"], lines)


def _error(row: BenchmarkRow) -> float:
    return float("inf") if row.direct is None else row.direct
