"""Whether the error bars of an atlas are honest: how many points are within them, where the truth is known.

    GMDS_DATA=... python -m benchmarks.study.spread MAPS [--sets 'FAUST;faces'] [--workers 1]

The sets, pairs and points of `benchmarks.study.atlas`, whose folder MAPS is: with one template (*atlas*), and with all
specimens as templates (*voted*). Points of one specimen are carried to another; their error, in space over the root of
the area, is beside the error bar of both ends (`Atlas.error_bar` of the root of the sum of squared spreads). *within*
is the share of points that are within it, *surest* and *least sure* those of the fifth with the least and the largest
spread; *rank* the correlation of ranks of spread and error. MAPS keeps the figures of each set. Writes
results/spread.md.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import spearmanr

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from benchmarks.study.atlas import ATLASES
from benchmarks.study.atlas_sets import DEVELOPMENT, SETS, Set
from geodesics import SurfacePoints
from geodesics.arrays import Floats
from gmds.atlases.error_bars import error_bars
from gmds.atlases.sheets import located
from gmds.batch import local_client

KINDS = ("atlas", "voted")
FIFTH = 0.2


def errors_and_spreads(made: gmds.Atlas, known: Set) -> tuple[Floats, Floats]:
    """Of all judged points the error (q,) and the spread (q,) of both ends; those that have one."""
    registered, found = made.registered, []
    for pair in known.pairs:
        i, j, target = made.index(pair.source), made.index(pair.target), known.meshes[pair.target]
        here = SurfacePoints.at_vertices(known.meshes[pair.source], pair.here)
        face, weights = located(here, registered[i].vertices, made.faces)
        there = SurfacePoints(registered[j], face, weights)
        away = np.linalg.norm(there.positions - target.vertices[pair.there], axis=1) / np.sqrt(target.area)
        found.append(np.stack([away, np.hypot(*(there.interpolate(made.spread[k]) for k in (i, j)))]))
    errors, spreads = np.concatenate(found, axis=1)
    there_is = np.isfinite(spreads)
    return errors[there_is], spreads[there_is]


def figures(errors: Floats, spreads: Floats) -> dict[str, float]:
    """How errors and spreads go together."""
    if not len(errors):
        return {}
    within = errors < error_bars(spreads)
    low, high = np.quantile(spreads, [FIFTH, 1 - FIFTH])
    return {
        "points": len(errors),
        "error": 100 * float(errors.mean()),
        "spread": 100 * float(spreads.mean()),
        "rank": float(spearmanr(spreads, errors)[0]),
        "within": float(within.mean()),
        "surest": float(within[spreads <= low].mean()),
        "least sure": float(within[spreads >= high].mean()),
    }


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("maps", type=Path)
    parser.add_argument("--sets", default=";".join(SETS))
    parser.add_argument("--workers", type=int, default=1)
    given = parser.parse_args()
    for name in given.sets.split(";"):
        known, folder, told = SETS[name](), given.maps / name, {}
        folder.mkdir(parents=True, exist_ok=True)
        with local_client(given.workers) as client:
            for kind in KINDS:
                options = {**ATLASES[kind], **known.options[1]}
                made = gmds.atlas(known.meshes, folder / "maps", client=client, **options)
                told[kind] = figures(*errors_and_spreads(made, known))
                print(name, kind, told[kind], flush=True)
        (folder / "spread.json").write_text(json.dumps({"version": code_version(), **told}), encoding="utf-8")
    places = {name: given.maps / name / "spread.json" for name in (*DEVELOPMENT, *SETS)}
    read = {name: json.loads(path.read_text(encoding="utf-8")) for name, path in places.items() if path.exists()}
    (RESULTS / "spread.md").write_text(page(read), encoding="utf-8")


def page(read: dict[str, dict[str, Any]]) -> str:
    """The table, development first."""
    lines = []
    for name, one in read.items():
        half = "development" if name in DEVELOPMENT else "reporting"
        for kind in KINDS:
            if row := one[kind]:
                shares = [f"{row[key]:.2f}" for key in ("rank", "within", "surest", "least sure")]
                numbers = [row["points"], f"{row['error']:.2f}", f"{row['spread']:.2f}"]
                lines.append([name, half, kind, *numbers, *shares, one["version"]])
    head = ["set", "half", "", "points", "error", "spread", "rank", "within", "surest", "least sure", "version"]
    told = "`python -m benchmarks.study.spread MAPS`; see the script for the protocol. Errors and spreads x100."
    about = (
        "The error bar is 0.02 and three times the spread, which was chosen so that nine of ten points of each "
        "development set are within it. Fewer than five specimens with one template have no spread. What all "
        "maps have in common is not in it: on smooth shapes without limbs, as endocasts, they slide together."
    )
    return "\n".join(["# Error bars of an atlas", "", told, about, "", *table(head, lines)])


if __name__ == "__main__":
    main()
