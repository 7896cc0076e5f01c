"""Accuracy of `self_symmetry` against published left-right truth, plain and with a limb or an ear rescaled.

    GMDS_DATA=... python -m benchmarks.accuracy.symmetry [--shapes tosca_hires/cat0,faust_5k/tr_reg_000] [--workers 2]

Every mesh is turned and resized at random; mean geodesic error x100 of the first symmetry found, on the protocol's 125
truth points. In a rescaled copy one ear, arm or leg is larger or smaller; its faces, and so the truth, stay the same.
Writes results/symmetry.csv row by row, does not do again what it holds for this version, and makes symmetry.md of it.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from statistics import fmean, median
from typing import Any

import numpy as np

import gmds
from benchmarks.accuracy.runs import ONE_THREAD, RESULTS, code_version
from benchmarks.markdown import table
from geodesics import Mesh, read_mesh
from gmds.benchmarking.run import turned
from gmds.benchmarking.truth_files import read_vts
from gmds.deformations.local_scaling import branch_log_scale, local_scaling
from gmds.evaluation import geodesic_error, protocol_subset, summary
from gmds.files.table import read_table, write_table

SHAPES = (
    *("tosca_hires/" + name for name in ("cat0", "horse0", "centaur0")),
    *("faust_5k/" + name for name in ("tr_reg_000", "tr_reg_013")),
    *("tosca_5k/" + name for name in ("cat2", "michael3", "centaur2")),
    *("tosca_hires/" + name for name in ("cat10", "horse10")),
)
SCALES = ("plain", "x2", "x0.5")  # of one ear, arm or leg
GOALS = {"plain": 2.5, "rescaled": 4.0}  # mean error x100, set before the first run
COLUMNS = ("version", "shape", "scale", "found", "status", "mean", "median", "within_010", "twice", "cpu_seconds")
Row = dict[str, Any]


def truth(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (p,) and the vertices they should be sent to; lines that name no vertex are left out."""
    corres = path.parent / "corres"
    if corres.is_dir():
        return read_vts(corres / f"{path.stem}.vts"), read_vts(corres / f"{path.stem}.sym.vts")
    goal = np.loadtxt(path.with_name(path.stem.rstrip("0123456789") + ".sym"), dtype=np.int64) - 1
    rows = np.flatnonzero((goal >= 0) & (goal < len(goal)))
    return rows, goal[rows]


def one_side(mesh: Mesh, indices: np.ndarray, goals: np.ndarray) -> np.ndarray:
    """A field (n,), 1 at an extremity that has a partner on the other side, and 0 away from it."""
    for rng in range(20):  # a nose or a tail is its own partner
        field = branch_log_scale(mesh, np.e, count=1, rng=rng)
        if np.abs(field[indices] - field[goals]).max() > 0.9:
            return field
    raise ValueError("no extremity has a partner")


def judge(shape: str, scale: str) -> Row:
    """One row, in a worker."""
    path = Path(os.environ["GMDS_DATA"]) / f"{shape}.off"
    indices, goals = truth(path)
    mesh, seed = read_mesh(path), [0, *shape.encode()]
    if scale != "plain":
        mesh, _ = local_scaling(mesh, np.log(float(scale[1:])) * one_side(mesh, indices, goals))
    mesh = turned(mesh, np.random.default_rng(seed))
    started = time.process_time()
    found = gmds.self_symmetry(mesh)
    seconds = time.process_time() - started
    row: Row = {"shape": shape, "scale": scale, "found": len(found), "status": "none", "cpu_seconds": seconds}
    if found:
        chosen = protocol_subset(len(indices))
        errors = summary(geodesic_error(found[0], goals[chosen], indices[chosen]))
        row |= {"status": found[0].status.name, "twice": 100 * found[0].meta["symmetry"]["twice"]}
        row |= {name: getattr(errors, name) for name in ("mean", "median", "within_010")}
    return row


def run(shapes: list[str], path: Path, version: str, workers: int) -> list[Row]:
    """All rows of this version, those in the CSV among them."""
    os.environ.update(ONE_THREAD)
    rows = stored(path, version)
    known = {(row["shape"], row["scale"]) for row in rows}
    todo = [(shape, scale) for shape in shapes for scale in SCALES if (shape, scale) not in known]
    with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn")) as pool:
        for future in as_completed([pool.submit(judge, *key) for key in todo]):
            rows.append({"version": version, **future.result()})
            write(path, rows)
            print({key: rows[-1].get(key) for key in ("shape", "scale", "mean", "status")}, file=sys.stderr)
    return rows


def stored(path: Path, version: str) -> list[Row]:
    """The rows of a version in a CSV."""
    if not path.is_file():
        return []
    lines = [line for line in read_table(path) if line["version"] == version]
    words = ("version", "shape", "scale", "status")
    return [{key: cell if key in words else float(cell) for key, cell in line.items() if cell} for line in lines]


def write(path: Path, rows: list[Row]) -> None:
    """The rows as CSV, ordered, written atomically."""
    ordered = sorted(rows, key=lambda row: (row["shape"], row["scale"]))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_table(path, COLUMNS, ([row.get(column) for column in COLUMNS] for row in ordered), digits=6)


def report(rows: list[Row], version: str) -> str:
    """symmetry.md: a line for each class and kind of scale, then a line for each shape."""
    head = ["set", "kind", "shapes", "mean", "median", "worst", "% < 0.10", "symmetries", "CPU s", "goal"]
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in sorted(rows, key=lambda row: row["shape"]):
        kind = "plain" if row["scale"] == "plain" else "rescaled"
        for name in (row["shape"].partition("/")[0], "all"):
            groups.setdefault((name, kind), []).append(row)
    lines = []
    for (name, kind), members in sorted(groups.items(), key=lambda item: (item[0][0] == "all", item[0])):
        means = [float(row.get("mean", 100.0)) for row in members]
        others = [fmean(float(row.get(key, 0.0)) for row in members) for key in ("within_010", "found", "cpu_seconds")]
        figures = [f"{value:.2f}" for value in (fmean(means), median(means), max(means))]
        figures += [f"{others[0]:.1f}", f"{others[1]:.1f}", f"{others[2]:.0f}"]
        lines.append([name, kind, str(len(members)), *figures, f"mean <= {GOALS[kind]}"])
    text = [
        "# Intrinsic symmetry",
        "",
        f"`GMDS_DATA=... python -m benchmarks.accuracy.symmetry` at {version}. Mean geodesic",
    ]
    text += ["error x100 of the first symmetry that `self_symmetry` finds; one ear, arm or leg twice or half as big in"]
    text += [
        "`rescaled`. `twice`: how far points are from home after the map is done twice, x100; no truth needed.",
        "",
    ]
    each = []
    for row in sorted(rows, key=lambda row: (row["shape"], row["scale"])):
        figures = [f"{float(row.get(key, 100)):.2f}" for key in ("mean", "twice")]
        others = [f"{row['found']:.0f}", str(row["status"]), f"{row['cpu_seconds']:.0f}"]
        each.append([str(row["shape"]), str(row["scale"]), *figures, *others])
    text += table(head, lines) + table(["shape", "scale", "mean", "twice", "symmetries", "status", "CPU s"], each)
    return "\n".join(text)


def main() -> None:
    """Run, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shapes", type=lambda text: text.split(","), default=list(SHAPES), help="folder/name, ...")
    parser.add_argument("--workers", type=int, default=2, help="processes (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where CSV and table go (default: results/)")
    options = parser.parse_args()
    version = code_version()
    rows = run(options.shapes, options.output / "symmetry.csv", version, options.workers)
    text = report(rows, version)
    (options.output / "symmetry.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
