"""The page of the fault table, in Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from benchmarks.faults import judge as fault_judge
from benchmarks.faults.judge import CLASSES
from benchmarks.markdown import table

GOOD = ("right", "clear error")
DOORS = {"V": "arrays (V)", "G": "odd surfaces (G)", "F": "files (F, S)", "S": "files (F, S)"}


class Row(NamedTuple):
    """One case at one entry point; `kept` says whether this project did as it promises, None for others."""

    library: str
    version: str
    entry: str
    row: str
    case: str
    expected: str
    outcome: str
    kept: bool | None
    seconds: float
    said: str


def page(rows: Sequence[Row]) -> str:
    """The whole page."""
    libraries = list(dict.fromkeys(row.library for row in rows))
    versions = dict.fromkeys(f"{row.library} {row.version}" for row in rows)
    ours = [row for row in rows if row.kept is not None]
    kept = sum(row.kept is True for row in ours)
    lines = [
        "# Fault table",
        "",
        "`python -m benchmarks.faults.faults`; each case and message: [faults.csv](faults.csv).",
        "",
    ]
    lines += [f"This project: {kept} of {len(ours)} runs end in the promised error or the right answer.", ""]
    lines += ["## Beside others", "", *summary(rows, libraries)]
    for door in dict.fromkeys(DOORS.values()):
        chosen = [row for row in rows if DOORS[row.row[0]] == door]
        lines += [f"### {door[0].upper()}{door[1:]}", "", *by_entry(chosen)]
    lines += ["## Rules", "", *(fault_judge.__doc__ or "").splitlines()[2:], ""]
    lines += ["Readers are only given formats that they read when the file is sound, and no file that is refused by a"]
    lines += ["rule of this project alone (`OWN_RULES`). Versions: " + ", ".join(versions) + ".", ""]
    lines += ["## This project, row by row", "", *row_by_row(ours)]
    return "\n".join(lines)


def summary(rows: Sequence[Row], libraries: Sequence[str]) -> list[str]:
    """Classes by library: the short table."""
    lines: list[list[object]] = []
    for kind in CLASSES:
        counts = [sum(row.library == name and row.outcome == kind for row in rows) for name in libraries]
        lines.append([kind, *counts])
    runs = [sum(row.library == name for row in rows) for name in libraries]
    good = [sum(row.library == name and row.outcome in GOOD for row in rows) for name in libraries]
    lines.append(["runs", *runs])
    lines.append(["right or clear", *(f"{100 * of / all_:.1f} %" for of, all_ in zip(good, runs, strict=True))])
    return table(["", *libraries], lines)


def by_entry(rows: Sequence[Row]) -> list[str]:
    """Classes by entry point."""
    lines: list[list[object]] = []
    for entry in dict.fromkeys(row.entry for row in rows):
        found = Counter(row.outcome for row in rows if row.entry == entry)
        lines.append([f"`{entry}`", *(found[kind] for kind in CLASSES), sum(found.values())])
    return table(["entry point", *CLASSES, "runs"], lines)


def row_by_row(rows: Sequence[Row]) -> list[str]:
    """Cases, those kept, and the slowest, by row of the contract."""
    lines: list[list[object]] = []
    for name in sorted({row.row for row in rows}):
        chosen = [row for row in rows if row.row == name]
        expected = ", ".join(sorted({row.expected for row in chosen}))
        kept = sum(row.kept is True for row in chosen)
        lines.append([name, expected, len(chosen), kept, f"{max(row.seconds for row in chosen):.2f}"])
    return table(["row", "expected", "runs", "kept", "slowest, s"], lines)
