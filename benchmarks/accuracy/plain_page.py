"""What benchmarks/results/plain.md says of plain generalised multidimensional scaling."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.accuracy.plain_maximum import of_later
from benchmarks.accuracy.plain_tosca_page import of_tosca
from benchmarks.accuracy.runs import Rows, read_rows
from benchmarks.markdown import table
from benchmarks.trust.page import RIGHT, STATUSES, WRONG
from gmds.benchmarking.run import BenchmarkRow
from gmds.files.table import read_table

# Versions whose rows count as well where the one that is told has none: plain maps are nearly the same (ABOUT).
VERSIONS = ("179cb88", "293a08f")
FAILED = 15.0  # mean error x100 above which a map is wrong, as the goals of this table say


def figures(rows: list[BenchmarkRow]) -> str:
    """Mean, median, worst and failures of some rows."""
    errors = [row.direct for row in rows if row.direct is not None]
    if not errors:
        return "-"
    wrong = sum(error > FAILED for error in errors) + len(rows) - len(errors)
    return f"{np.mean(errors):.1f} ({np.median(errors):.1f}, {max(errors):.1f}; {wrong} of {len(rows)})"


def report(found: Mapping[str, Rows], cells: Sequence[str], about: str) -> list[str]:
    """A line for each cell: mean error (median, worst; failures) on each set, the groups of `scaled` apart."""
    groups = {name: sorted({row.group for row in rows.values()}) for name, rows in found.items() if rows}
    columns = [(name, group) for name, those in groups.items() for group in those]
    lines = []
    for one in cells:
        kind, a, eps, smoothing, loss = one.split()
        mine = [
            [row for (who, _), row in found[name].items() if who == one and row.group == group]
            for name, group in columns
        ]
        if any(mine):
            lines.append([kind, a, eps, smoothing, loss, *map(figures, mine)])
    head = ["distance", "a", "eps", "smoothing", "loss", *(f"{name} {group}".strip() for name, group in columns)]
    return [about, "", *table(head, lines)]


def write(output: Path, version: str, tables: Mapping[str, tuple[Sequence[str], Mapping[str, int]]]) -> None:
    """plain.md, of the rows that are there: a table of the cells of each kind and its sets, by the prefix of files."""
    sections = ["# Plain generalised multidimensional scaling", "", f"Measured at {version}. {ABOUT}", ""]
    for prefix, (cells, sets) in tables.items():
        files = {name: output / f"{prefix}_{name}.csv" for name in sets}
        found = {name: rows_of(file, version) for name, file in files.items()}
        if any(found.values()):
            sections += report({name: rows for name, rows in found.items() if rows}, cells, TITLES[prefix])
        if prefix == "plain":
            sections += of_goals(found, cells) + of_tosca(output, found["tosca_5k"], cells)
            sections += of_later(output, found, cells)
    sections += of_status(output, version, tables)
    sections += of_truth(output / "plain_truth.csv")
    (output / "plain.md").write_text("\n".join(sections), encoding="utf-8")


def rows_of(file: Path, version: str) -> Rows:
    """The rows of a version, and of those that made the same maps."""
    rows: Rows = {}
    for one in (*VERSIONS, version):
        rows |= read_rows(file, one)
    return rows


def of_goals(found: Mapping[str, Rows], cells: Sequence[str]) -> list[str]:
    """How many cells with a loss of ours reach each goal, how far Minimax is from least squares, and what failed."""
    cells = [one for one in cells if not one.endswith("_50")]
    lines = []
    for (name, group, exponent), goal in GOALS.items():
        means = {}
        for one in cells:
            errors = [row.direct for (who, _), row in found[name].items() if who == one and row.group == group]
            if exponent in ("", one.split()[1]) and errors and None not in errors:
                means[one] = float(np.mean([error for error in errors if error is not None]))
        if not means:
            continue
        most = max(means, key=lambda one: means[one])
        least = min(means, key=lambda one: means[one])
        pairs = len({pair for (_, pair), row in found[name].items() if row.group == group})
        reach = f"{sum(value <= goal for value in means.values())} of {len(means)}"
        ends = [f"{means[one]:.2f} ({one.replace(' 1 0.02', '')})" for one in (least, most)]
        lines.append([f"{name} {group}".strip(), exponent or "all", goal, pairs, reach, *ends])
    head = ["pairs", "a", "goal", "how many pairs", "cells that reach it", "least mean", "largest mean"]
    return [OF_GOALS, "", *table(head, lines), *of_minimax(found, cells)]


def of_minimax(found: Mapping[str, Rows], cells: Sequence[str]) -> list[str]:
    """How far the maximum is from least squares, pair by pair, and how many of all maps failed."""
    rows = {key: row for those in found.values() for key, row in those.items() if key[0] in cells}
    errors = {key: row.direct for key, row in rows.items() if row.direct is not None}
    gaps = [
        error - errors[least]
        for (who, pair), error in errors.items()
        if who.endswith("Minimax") and (least := (who.replace("Minimax", "LeastSquares"), pair)) in errors
    ]
    wrong = sum(error > FAILED for error in errors.values()) + len(rows) - len(errors)
    far = f"Minimax is within 1.0 of least squares, or better, in {sum(gap <= 1.0 for gap in gaps)} of {len(gaps)} maps"
    return [f"{far}; the largest gap is {max(gaps):.2f}. Of all {len(rows)} maps {wrong} failed.", ""] if gaps else []


def of_status(output: Path, version: str, tables: Mapping[str, tuple[Sequence[str], Mapping[str, int]]]) -> list[str]:
    """How many maps of reporting pairs are right, and which status they have."""
    lines = []
    for prefix, pairs in REPORTED.items():
        files = [output / f"{prefix}_{name}.csv" for name in tables[prefix][1]]
        rows = [row for file in files for row in rows_of(file, version).values() if row.status in STATUSES]
        errors = np.array([row.direct for row in rows], dtype=np.float64)
        kinds = {"right": errors < RIGHT, "between": (errors >= RIGHT) & (errors <= WRONG), "wrong": errors > WRONG}
        for kind, those in kinds.items():
            words = [row.status for row, one in zip(rows, those, strict=True) if one]
            lines.append([pairs, kind, len(words), *map(words.count, STATUSES)])
    return [OF_STATUS, "", *table(["pairs", "maps", "how many", *STATUSES], lines)]


def of_truth(path: Path) -> list[str]:
    """The stress of maps found and of true maps, by distance and set, in per cent."""
    if not path.is_file():
        return []
    rows = read_table(path)
    sets = sorted({row["set"] for row in rows})
    lines = []
    for cell in dict.fromkeys(row["cell"] for row in rows):
        kind, a, *_ = cell.split()
        line = [kind, a]
        for name in sets:
            mine = [row for row in rows if (row["cell"], row["set"]) == (cell, name)]
            means = [
                np.mean([float(row[column]) for row in mine]) for column in ("stress_of_answer", "stress_of_truth")
            ]
            line.append(" / ".join(f"{100 * value:.1f}" for value in means) if mine else "-")
        lines.append(line)
    return [OF_TRUTH, "", *table(["distance", "a", *sets], lines)]


ABOUT = f"""Mean geodesic error x100, direct, of `match(distance=..., loss=...)`, without registration
(the median, the worst; how many are above {FAILED:g} or failed, of how many). Distances are those of the metric
(K^2 + eps^2)^(a/2) g. Rows of {VERSIONS[0]} that were not measured again (of one pair of the second table) count as
well: of 133 that were, all but four agree in every digit; three of these differ by 0.17 at the most, and FAUST 032-037
by geodesics in g, AMBIGUOUS both times, is mirrored now. Rows of other classes and species are of {VERSIONS[1]}.
`cpu_seconds` in plain_*.csv lack what another cell of the pair had found already. The status is that of the model of
trust_plain.md."""
TITLES = {
    "plain": """## Distances and losses

`python -m benchmarks.accuracy.plain --half reporting`: some pairs of each set, spread over its reporting half. `L2_50`
and `L4_50` are the settings of the TOSCA toolbox (Bronstein, Bronstein, Kimmel 2006), made with our solver: geodesics
of space, 50 farthest samples, their squares or fourth powers; start and extension are ours, as it has none. The toolbox
itself needs Matlab and was not run. The one other GMDS in Python, `GMDS.py` of github.com/ctralie/G-RFLCT, was read and
not run: it is for Python 2 with wxPython and OpenGL, is not on PyPI, needs all distances of the target, vertex to
vertex, and starts by ICP, so that both shapes have to be in one pose.""",
    "plain_grid": """## What a, eps and smoothing do to geodesic distances

`python -m benchmarks.accuracy.plain --half development --grid`, of `scaled` the pairs that
`python -m benchmarks.accuracy.development_pairs` makes.""",
    "plain_hard": """## Other classes and species

`python -m benchmarks.accuracy.plain --half reporting --hard`: gorilla and human (TOSCA), animals of other species and
half scans (SHREC'20). No distance is kept between these, so the figures say what plain GMDS is not for; whether it says
so itself is told below.""",
}
GOALS = {  # of a set and group, and of cells with this exponent (all of them)
    ("tosca_5k", "", ""): 2.5,
    ("faust_5k", "", ""): 2.5,
    ("scaled", "self", "1"): 2.5,
    ("scaled", "pose", "1"): 4.0,
}
OF_GOALS = """### Against the goals

Means over the pairs, of the losses LeastSquares, Huber and Minimax."""
REPORTED = {"plain": "of one class", "plain_hard": "of other classes and species"}
OF_STATUS = f"""## Status of these maps

Of those measured with the shipped model of confidence: right below {RIGHT:g}, wrong above {WRONG:g}."""
OF_TRUTH = """## The distance or the solver

`python -m benchmarks.accuracy.plain_truth`: root mean square residual, in per cent of the mean distance, near pairs
weighing more as in `match`, of the map that was found with least squares / of the true map. Where the true map has
more, no solver would have found it: so it is for distances of space where parts grew, and for geodesics on TOSCA. Where
it has less, the rest was lost on the way: by the solver, between samples, and by smoothing."""
