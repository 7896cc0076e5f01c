"""Mirrored specimens: how many are found, how many bodies are called mirrored, and what that costs.

    GMDS_DATA=... python -m benchmarks.accuracy.mirrored [--half reporting] [--most 40]

Each pair as it is and, but for whole bodies, with the target mirrored as well, of whole surfaces (`parts="neither"`).
Whole bodies are all pairs of FAUST, TOSCA and SHREC'20. Of teeth, hands and left and right bones those are mirrored of
which the map to the mirror image is the right one by published landmarks. Hyper-parameters were chosen on the pairs
named in `DEVELOPMENT` and on the development halves of the bodies. Pairs that are in results/mirrored.csv are not run
again.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.accuracy.halves import half_of, pairs_of
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import read_mesh
from geodesics.threads import on_one_blas_thread
from gmds.files.table import read_table, write_table
from gmds.matching.attempts import Wanted, attempted
from gmds.matching.large_surfaces import CoarseCopies
from gmds.matching.other_images import gain_of, likelier_image, own_symmetry, rival_image, suspected_image
from gmds.mds.losses import LeastSquares
from gmds.surface.measured import Surface, measure

DEVELOPMENT = ("opensim", "w10-D09", "Q10-u19", "u19-i17", "V02-S09", "hippocampus", "0_AAFR", "hand", "f01-f09")
RIGHT_TO_LEFT = (
    "opensim",
    "J09-Q10",
    "Q10-u19",
    "u19-i17",
    "S09-j18",
    "hand",
)  # pairs of which one is a left, one a right specimen
BODIES = ("faust_5k", "tosca_5k", "tosca_cross_5k", "shrec20")
COLUMNS = (
    "pair",
    "group",
    "half",
    "mirrored",
    "told",
    "undecided",
    "weighed",
    "symmetry",
    "gain",
    "test_seconds",
    "seconds",
)
KEYS = ("told", "undecided")


class Case(NamedTuple):
    """A pair of mesh files, perhaps with the target mirrored, and whether it then is a mirrored specimen."""

    name: str
    group: str
    half: str
    source: Path
    target: Path
    reflect: bool
    mirrored: bool


def cases() -> Iterator[Case]:
    """All of them, bodies and others in turn."""
    data = Path(os.environ["GMDS_DATA"])
    for entry in json.loads((data / "anatomy" / "pairs.json").read_text(encoding="utf-8")):
        name = entry["name"]
        half = "development" if any(part in name for part in DEVELOPMENT) else "reporting"
        crossed = any(part in name for part in RIGHT_TO_LEFT)
        paths = data / entry["source"], data / entry["target"]
        yield Case(name, entry["group"], half, *paths, reflect=False, mirrored=crossed)
        if entry["group"] in ("teeth", "left-right", "brain parts", "endocasts"):
            yield Case(f"{name} mirrored", entry["group"], half, *paths, reflect=True, mirrored=not crossed)
    for body in BODIES:
        development = half_of(body, "development")
        for pair in pairs_of(body):
            half = "development" if pair.name in development else "reporting"
            yield Case(f"{body} {pair.name}", "whole bodies", half, pair.source, pair.target, False, False)


@on_one_blas_thread
def row(case: Case) -> dict[str, Any]:
    """What is told of one case."""
    source, target = (measure(read_mesh(path)) for path in (case.source, case.target))
    copies = CoarseCopies.of(source, target)
    source, target = (source, target) if copies is None else copies.copies
    if case.reflect:
        target = _as_given(target.reflection)
    wanted = Wanted(None, None, LeastSquares(), 300, "neither", lambda stage, share: None, looked_for=False)
    started = time.process_time()
    tried = attempted(source, target, "preserve", wanted)
    proposed = time.process_time()
    suspected = suspected_image(tried)
    tested = time.process_time()
    other = likelier_image(tried, "preserve", wanted)
    gain = "-" if other is None else f"{gain_of(tried, other):.2f}"
    return {
        "pair": case.name,
        "group": case.group,
        "half": case.half,
        "mirrored": case.mirrored,
        "told": other is not None,
        "undecided": other is None and rival_image(tried, "preserve", wanted) is not None,
        "weighed": suspected is not None,
        "symmetry": f"{own_symmetry(tried[0].pair):.2f}",
        "gain": gain,
        "test_seconds": f"{tested - proposed:.2f}",
        "seconds": f"{time.process_time() - started:.2f}",
    }


def _as_given(surface: Surface) -> Surface:
    """A mirror image as if it had been measured so."""
    return measure(surface.mesh)


def page(rows: Sequence[dict[str, Any]]) -> str:
    """The tables of both halves."""
    lines = ["# Mirrored specimens", "", "`python -m benchmarks.accuracy.mirrored`; the script says how.", ""]
    names = [
        "group",
        "mirrored",
        "found",
        "undecided",
        "not mirrored",
        "called mirrored",
        "others undecided",
        "weighed",
        "test, CPU s (median, most)",
    ]
    for half in ("reporting", "development"):
        some = [one for one in rows if one["half"] == half]
        found = []
        for group in dict.fromkeys(one["group"] for one in some):
            of = [one for one in some if one["group"] == group]
            yes, no = ([one for one in of if str(one["mirrored"]) == word] for word in ("True", "False"))
            told, open_ = ([sum(str(one[key]) == "True" for one in part) for part in (yes, no)] for key in KEYS)
            weighed = sum(str(one["weighed"]) == "True" for one in of)
            seconds = np.array([float(one["test_seconds"]) for one in of])
            spent = f"{np.median(seconds):.2f}, {seconds.max():.2f}"
            counts = [len(yes), told[0], open_[0], len(no), told[1], open_[1]]
            found.append([group, *counts, f"{weighed} of {len(of)}", spent])
        lines += [f"## {half.capitalize()} half", "", *table(names, found), ""]
    return "\n".join(lines)


def main() -> None:
    """Run what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=("development", "reporting"))
    parser.add_argument("--groups", type=lambda text: text.split(","))
    parser.add_argument("--most", type=int, default=10**6, help="pairs that are run, at most")
    options = parser.parse_args()
    path = RESULTS / "mirrored.csv"
    rows: dict[str, dict[str, Any]] = {}
    if path.is_file():
        rows = {one["pair"]: dict(one) for one in read_table(path)}
    todo = [
        case
        for case in cases()
        if case.name not in rows
        and (options.half is None or case.half == options.half)
        and (options.groups is None or case.group in options.groups)
    ]
    for case in todo[: options.most]:
        rows[case.name] = row(case)
        print(*rows[case.name].values(), flush=True)
        write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in rows.values()])
        (RESULTS / "mirrored.md").write_text(page(list(rows.values())), encoding="utf-8")


if __name__ == "__main__":
    main()
