"""Cost of the distance layer from 5 thousand to 528 thousand vertices, beside other libraries in the same run.

    GMDS_DATA=... python -m benchmarks.scale.scale [--meshes DIR] [--sizes 5k,44k] [--tasks eigenpairs,marching]

Every figure is of a process of its own (`tasks.py`), one by one: CPU seconds on one thread after a warm-up,
wall seconds where two threads work, peak memory. Peers (potpourri3d, libigl, pymeshlab, scipy) that are missing are
named and left out. Meshes are made once and kept in DIR. Measurements are added to results/scale.csv, where a later one
of the same task and size replaces an earlier one, and results/scale.md is written from it.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from benchmarks.places import RESULTS
from benchmarks.scale.meshes import SIZES, load, mesh_path
from gmds.files.table import read_table, write_table

CSV, PAGE = RESULTS / "scale.csv", RESULTS / "scale.md"
COLUMNS = "task", "size", "vertices", "cpu", "wall", "setup", "peak", "marches", "residual", "stress", "iterations"
THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
PLAN = {
    "marching": ("5k", "44k", "132k", "528k"),
    "marching_potpourri3d": ("5k", "44k", "528k"),
    "front_pymeshlab": ("5k", "44k", "528k"),
    "heat_potpourri3d": ("44k", "528k"),
    "heat_igl": ("44k", "528k"),
    "many_sources": ("44k", "528k"),
    "sampling": ("5k", "44k", "132k", "528k"),
    "eigenpairs": ("5k", "44k", "132k", "528k"),
    "eigenpairs_exact": ("5k", "44k", "132k"),
    "eigenpairs_scipy": ("5k", "44k", "132k"),
    "minimax": ("5k", "44k"),
}
GOALS = (
    ("one source, 44k", "marching", "44k", "cpu", "marching_potpourri3d", "half of potpourri3d's fast marching"),
    ("one source, 528k", "marching", "528k", "cpu", "marching_potpourri3d", "half of potpourri3d's fast marching"),
    ("1,000 farthest points, 528k", "sampling", "528k", "marches", "", "12 marches"),
    ("200 eigenpairs, 5k", "eigenpairs", "5k", "cpu", "eigenpairs_scipy", "0.6 s"),
    ("200 eigenpairs, 44k", "eigenpairs", "44k", "cpu", "eigenpairs_scipy", "5 s"),
    ("200 eigenpairs, 132k", "eigenpairs", "132k", "cpu", "eigenpairs_scipy", "16 s"),
    ("200 eigenpairs, tolerance 1e-10, 5k", "eigenpairs_exact", "5k", "cpu", "eigenpairs_scipy", "scipy"),
    ("200 eigenpairs, tolerance 1e-10, 44k", "eigenpairs_exact", "44k", "cpu", "eigenpairs_scipy", "scipy"),
    ("200 eigenpairs, tolerance 1e-10, 132k", "eigenpairs_exact", "132k", "cpu", "eigenpairs_scipy", "scipy"),
    ("minimax, 200 samples, 44k", "minimax", "44k", "cpu", "", "5 s"),
)

Rows = dict[tuple[str, str], Mapping[str, str]]


def measure(task: str, size: str, folder: Path) -> Mapping[str, str] | None:
    """One row, from a process of its own; None where it failed, which is reported on stderr."""
    path = mesh_path(size, folder)
    command = [sys.executable, "-m", "benchmarks.scale.tasks", task, str(path)]
    done = subprocess.run(command, env={**THREADS, **os.environ}, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"{task} {size}: left out ({done.stderr.strip().splitlines()[-1:]})", file=sys.stderr)
        return None
    figures = {name: f"{value:.4g}" for name, value in json.loads(done.stdout.splitlines()[-1]).items()}
    print(f"{task} {size}: {figures}", file=sys.stderr)
    return {"task": task, "size": size, "vertices": str(load(path).n_vertices), **figures}


def read_rows() -> Rows:
    """What has been measured."""
    if not CSV.is_file():
        return {}
    return {(row["task"], row["size"]): row for row in read_table(CSV)}


def write_rows(rows: Rows) -> None:
    """All rows, in the order of the plan."""
    order = [(task, size) for task in PLAN for size in SIZES if (task, size) in rows]
    write_table(CSV, COLUMNS, ([rows[key].get(column) for column in COLUMNS] for key in order))


def goals(rows: Rows) -> list[str]:
    """Ours beside the goal and the peer of the same run."""
    lines = ["| what | ours | goal: at most | peer | ours / peer | residuals |", "|---|---|---|---|---|---|"]
    for name, task, size, figure, peer, goal in GOALS:
        if (task, size) in rows:
            ours = float(rows[task, size][figure])
            other = float(rows[peer, size]["cpu"]) if (peer, size) in rows else np.nan
            cells = ("-", "-") if np.isnan(other) else (f"{other:.3g} s", f"{ours / other:.2f}")
            residuals = (rows[key]["residual"] for key in ((task, size), (peer, size)) if key in rows)
            shown = f"{ours:.3g}{' s' if figure == 'cpu' else ''}"
            lines.append(f"| {name} | {shown} | {goal} | {' | '.join(cells)} | {' / '.join(filter(None, residuals))} |")
    if ("many_sources", "528k") in rows:
        ours, heat = rows["many_sources", "528k"], rows.get(("heat_potpourri3d", "528k"))
        peer = f"{50 * float(heat['cpu']):.3g} s and {float(heat['setup']):.3g} s to set up" if heat else "-"
        cells = f"{float(ours['cpu']) / 2:.3g} s on each of two cores (wall {ours['wall']} s on a shared machine)"
        lines.append(f"| 50 sources, 528k | {cells} | potpourri3d's heat method, without set-up | {peer} | | |")
    return lines


def slopes(rows: Rows) -> list[str]:
    """How time and memory grow: the slope of log cost over log n."""
    lines = ["| task | vertices | CPU s | peak MB | slope of time | slope of memory |", "|---|---|---|---|---|---|"]
    for task in PLAN:
        found = [rows[task, size] for size in SIZES if (task, size) in rows]
        n, cpu, peak = (np.array([float(row[key]) for row in found]) for key in ("vertices", "cpu", "peak"))
        fits = ["-", "-"]
        if len(found) > 2:
            fits = [f"{np.polyfit(np.log(n[-3:]), np.log(cost[-3:]), 1)[0]:.2f}" for cost in (cpu, peak)]
        cells = (" / ".join(f"{x:.3g}" for x in column) for column in (n, cpu, peak))
        lines.append(f"| {task} | {' | '.join([*cells, *fits])} |")
    return lines


def page(rows: Rows) -> str:
    """The results in words."""
    docs = (__doc__ or "").split("\n\n")
    about = f"`{docs[1].strip()}`. {' '.join(docs[2].split())}"
    return "\n".join(
        ["# Cost of the distance layer", "", about, "", *goals(rows), "", "## Growth", "", *slopes(rows), ""]
    )


def main() -> None:
    """Measure the tasks that were chosen, and write both files after each measurement."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", type=Path, default=Path(tempfile.gettempdir()) / "gmds_scale")
    parser.add_argument("--sizes", default=",".join(SIZES))
    parser.add_argument("--tasks", default=",".join(PLAN))
    chosen = parser.parse_args()
    for task in chosen.tasks.split(","):
        for size in PLAN[task]:
            if size in chosen.sizes.split(",") and (row := measure(task, size, chosen.meshes)):
                rows = {**read_rows(), (task, size): row}
                write_rows(rows)
                PAGE.write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
