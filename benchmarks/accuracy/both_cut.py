"""Two surfaces that are both cut, of one creature or two: what they have in common is found, and the map of it.

    GMDS_DATA=... python -m benchmarks.accuracy.both_cut [--half reporting] [--workers 2]

Poses of TOSCA, built-in shapes of which a part grew, and animals of SHREC'20 of two species: those of
`benchmarks.trust.cases`, half of them for development. Of either mesh a plane across a random direction takes 25 to
50 % of the area, so that at least 30 % of the known points (8 landmarks) are on both. Turned, resized, matched and
judged as in `benchmarks.accuracy.parts`: mean geodesic error x100 on what has a counterpart, overlap IoU, precision and
recall of `valid`. Writes results/both_cut.csv, where what was measured at this version is not measured again, and
results/both_cut.md.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.part_tables import NAMES, cells_of, statuses
from benchmarks.accuracy.parts import Known, judged_row, read_rows, run
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from benchmarks.trust import cases
from geodesics import Mesh
from gmds.deformations import Part, cut

KINDS = ("TOSCA", "grown", "other species")
SHARES = (0.25, 0.5)  # of the area that a plane takes
COMMON, LANDMARKS = 0.3, 8  # a share of the known points, and their number, that both must have
TRIES = 50


def both_cut(known: cases.Known, rng: np.random.Generator) -> tuple[tuple[Mesh, Mesh], Known]:
    """Either surface cut by a plane, and what is known of what is left. Raises `ValueError` if no two cuts overlap."""
    ours, theirs = np.asarray(known.vertices), known.truth.nearest_vertices()
    for _ in range(TRIES):
        pieces = [_cut(mesh, rng) for mesh in (known.source, known.target)]
        here, there = ~pieces[0].missing[ours], ~pieces[1].missing[theirs]
        if (here & there).sum() >= max(LANDMARKS, COMMON * len(ours)):
            source, target = (np.cumsum(~piece.missing) - 1 for piece in pieces)
            both = here & there
            left = Known(source[ours[both]], target[theirs[both]], source[ours[here & ~there]])
            return (pieces[0].mesh, pieces[1].mesh), left
    raise ValueError(f"no two cuts of {TRIES} have enough in common")


def _cut(mesh: Mesh, rng: np.random.Generator) -> Part:
    return cut(mesh, float(rng.uniform(*SHARES)), normal=rng.standard_normal(3))


def wanted(half: str | None = None) -> list[cases.Case]:
    """The pairs, of one half or of both."""
    return [one for one in cases.cases() if one.kind in KINDS and half in (None, one.half)]


def row(name: str, version: str) -> dict[str, Any]:
    """One pair, cut, matched and judged."""
    case = next(one for one in wanted() if one.name == name)
    meshes, known = both_cut(case.load(), np.random.default_rng([7, *name.encode()]))
    return judged_row({"name": name, "group": case.kind}, meshes, known, version)


def page(rows: Sequence[Mapping[str, str]], version: str) -> str:
    """The table of both halves."""
    lines = ["# Both cut", "", f"`python -m benchmarks.accuracy.both_cut` at {version}; see the script.", ""]
    halves = {one.name: one.half for one in wanted()}
    known = {half: [one for one in rows if halves[one["pair"]] == half] for half in ("reporting", "development")}
    known = {half: some for half, some in known.items() if some}
    for half, some in known.items():
        groups = {kind: [one for one in some if one["group"] == kind] for kind in KINDS}
        cells = [cells_of(kind, those, "-") for kind, those in groups.items() if those]
        lines += [f"## {half.capitalize()} half", "", *table(NAMES, cells), ""]
    return "\n".join([*lines, "## Status", "", *statuses({**known, "all": rows})])


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=("development", "reporting"))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    version, path = code_version(), options.output / "both_cut.csv"
    done = read_rows(path, version)
    rows = run(row, [one.name for one in wanted(options.half) if one.name not in done], path, version, options.workers)
    text = page(list(rows.values()), version)
    (options.output / "both_cut.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
