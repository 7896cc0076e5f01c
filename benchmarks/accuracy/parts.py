"""Parts of surfaces: error where there is a counterpart, and how well what has none is marked.

    GMDS_DATA=... python -m benchmarks.accuracy.parts [--groups PFAUST-M,PFAUST-H] [--half reporting] [--workers 2]

The pairs of `partial/pairs.json`, every mesh turned and resized at random, defaults only. Mean geodesic error x100 on
what has a counterpart (protocol of `gmds benchmark`), overlap IoU, precision and recall of `valid` by vertices with a
known answer. Hyper-parameters were chosen on the pairs named in `DEVELOPMENT`; figures are of the others. Writes
results/parts.csv, where what was measured at this version of the code is not measured again, and results/parts.md.
"""

from __future__ import annotations

import argparse
import csv
import json
import multiprocessing
import os
import sys
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np

import gmds
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import read_mesh
from gmds.benchmarking.run import turned
from gmds.evaluation import geodesic_error, protocol_subset
from gmds.shapes import quadruped

DEVELOPMENT = ("003", "008", "013", "023", "H_018", "9_dog", "9_lion", "0_cow", "24_cow")
COLUMNS = (
    "pair",
    "group",
    "version",
    "status",
    "error",
    "iou",
    "precision",
    "recall",
    "cpu_seconds",
    "part",
    "likelihood",
)
GOALS = {"PFAUST-M": "3.0", "PFAUST-H": "3.5", "PFAUST-M back": "4.0 / 0.90", "PFAUST-H back": "4.0 / 0.90"}
GOALS["PARTIALSMAL"] = "8.0 / 0.80"
FAILED = 20  # an error x100 above which a pair has failed


def is_development(name: str) -> bool:
    """Whether hyper-parameters were chosen on this pair."""
    return any(part in name for part in DEVELOPMENT)


def row(entry: Mapping[str, str], version: str) -> dict[str, Any]:
    """One pair, matched and judged."""
    data = Path(os.environ["GMDS_DATA"])
    rng = np.random.default_rng([0, *entry["name"].encode()])
    source, target = (turned(read_mesh(data / entry[side]), rng) for side in ("source", "target"))
    truth = np.load(data / entry["truth"])
    gmds.match(quadruped(n_vertices=600), quadruped(n_vertices=600))  # so that no pair pays for imports
    started = time.process_time()
    answer = gmds.match(source, target)
    seconds = time.process_time() - started
    judged = protocol_subset(len(truth["src"]))
    error = 100 * float(geodesic_error(answer, truth["gt"][judged], truth["src"][judged]).mean())
    there, gone = np.unique(truth["src"]), np.setdiff1d(truth["missing"], truth["src"])
    kept, wrong = int(answer.valid[there].sum()), int(answer.valid[gone].sum())
    evidence = answer.meta["evidence"]
    return {
        "pair": entry["name"],
        "group": entry["group"],
        "version": version,
        "status": answer.status.name,
        "error": f"{error:.3f}",
        "iou": f"{kept / max(len(there) + wrong, 1):.4f}",
        "precision": f"{kept / max(kept + wrong, 1):.4f}",
        "recall": f"{kept / max(len(there), 1):.4f}",
        "cpu_seconds": f"{seconds:.2f}",
        "part": evidence.get("part", "-"),
        "margin": f"{evidence.get('margin', 0):.2f}",
    }


def read_rows(path: Path, version: str) -> dict[str, dict[str, str]]:
    """The rows of this version of the code, by pair."""
    if not path.is_file():
        return {}
    with path.open(newline="", encoding="utf-8") as stream:
        return {line["pair"]: line for line in csv.DictReader(stream) if line["version"] == version}


def write_rows(path: Path, rows: Mapping[str, Mapping[str, Any]]) -> None:
    """All rows, ordered by group and pair."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(sorted(rows.values(), key=lambda one: (one["group"], one["pair"])))


def page(rows: Sequence[Mapping[str, str]], version: str) -> str:
    """The table of both halves."""
    lines = ["# Parts", "", f"`python -m benchmarks.accuracy.parts` at {version}; see the script for the protocol.", ""]
    for title, half in (("Reporting half", False), ("Development half", True)):
        cells = []
        for group in GOALS:
            some = [one for one in rows if one["group"] == group and is_development(one["pair"]) == half]
            if some:
                errors = np.array([float(one["error"]) for one in some])
                figures = [f"{errors.mean():.2f}", f"{np.median(errors):.2f}", f"{errors.max():.2f}"]
                means = [f"{np.mean([float(one[key]) for one in some]):.2f}" for key in ("iou", "precision", "recall")]
                good = sum(one["status"] == "GOOD" and float(one["error"]) > 15 for one in some)
                poor = sum(one["status"] == "POOR" and float(one["error"]) < 5 for one in some)
                seconds = f"{np.median([float(one['cpu_seconds']) for one in some]):.1f}"
                failed = f"{(errors > FAILED).sum()} of {len(some)}"
                cells.append([group, len(some), *figures, failed, *means, good, poor, seconds, GOALS[group]])
        names = ["group", "pairs", "error x100", "median", "worst", f"above {FAILED}", "IoU", "precision", "recall"]
        names += ["above 15 and GOOD", "below 5 and POOR", "CPU s", "goal"]
        lines += [f"## {title}", "", *table(names, cells), ""]
    return "\n".join(lines)


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--groups", type=lambda text: text.split(","), help="names, separated by commas")
    parser.add_argument("--half", choices=("development", "reporting"))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    entries = json.loads((Path(os.environ["GMDS_DATA"]) / "partial" / "pairs.json").read_text(encoding="utf-8"))
    entries = [one for one in entries if options.groups is None or one["group"] in options.groups]
    if options.half is not None:
        entries = [one for one in entries if is_development(one["name"]) == (options.half == "development")]
    path, version = options.output / "parts.csv", code_version()
    rows = read_rows(path, version)
    todo = [one for one in entries if one["name"] not in rows]
    with ProcessPoolExecutor(options.workers, multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(row, one, version) for one in todo]
        for done in as_completed(futures):
            found = done.result()
            rows[found["pair"]] = found
            write_rows(path, rows)
            print(*found.values(), file=sys.stderr)
    text = page(list(rows.values()), version)
    (options.output / "parts.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
