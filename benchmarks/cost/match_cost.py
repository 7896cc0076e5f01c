"""What `match` costs from 5 thousand vertices a side to 250 thousand: time by stage, peak of memory, and the error.

    GMDS_DATA=... python -m benchmarks.cost.match_cost [--sizes 5k,50k,250k]

Two poses of a TOSCA cat; the large ones are `tosca_hires` meshes with every face divided, whose vertices correspond.
One is decimated to the size, so that triangles do not. Each size runs in a process of its own after a small match, so
that kernels are compiled. Writes results/match_cost.md.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import igl
import numpy as np
from scipy.spatial import cKDTree

import gmds
from benchmarks.memory import peak_megabytes
from benchmarks.places import RESULTS
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.threads import threads
from gmds.benchmarking.datasets import dataset_pairs
from gmds.shapes import quadruped

PAGE = RESULTS / "match_cost.md"
SIZES = {"5k": 5_000, "50k": 50_000, "250k": 250_000}
GOALS = {"5k": (4, 0.5), "50k": (12, 1.5), "250k": (60, 5)}  # seconds of wall time, GB
JUDGED = 125  # true points, as in the protocol


def pair(size: int) -> tuple[Mesh, Mesh, np.ndarray, SurfacePoints]:
    """Source, target, some source vertices and the points of the target they belong to."""
    data = Path(os.environ["GMDS_DATA"])
    if size == SIZES["5k"]:
        found = next(p for p in dataset_pairs(data / "tosca_5k") if p.name == "cat0-cat2")
        source, target = read_mesh(found.source), read_mesh(found.target)
        indices, truth, _ = found.truth(source, target)
        return source, target, indices, truth
    one, other = (read_mesh(data / "tosca_hires" / f"{name}.off") for name in ("cat0", "cat10"))
    for _ in range(int(np.ceil(np.log(size / one.n_vertices) / np.log(4)))):
        one, other = (Mesh(*igl.upsample(m.vertices, m.faces)) for m in (one, other))
    vertices, faces, *_ = igl.decimate(one.vertices, one.faces, 2 * size)
    source = Mesh(vertices, np.asarray(faces, dtype=np.int64))
    gap, nearest = cKDTree(one.vertices).query(source.vertices)
    kept = np.flatnonzero(gap <= 1e-3 * np.sqrt(source.area))
    return source, other, kept, SurfacePoints.at_vertices(other, nearest[kept])


def measured(size: str) -> dict[str, Any]:
    """In a process of its own: CPU and wall seconds, when each stage began, the peak of memory, the error."""
    gmds.match(quadruped(n_vertices=600), quadruped("walk", n_vertices=600))
    source, target, indices, truth = pair(SIZES[size])
    stages: dict[str, float] = {}
    cpu, wall = time.process_time(), time.perf_counter()
    answer = gmds.match(source, target, progress=lambda stage, _: stages.setdefault(stage, time.perf_counter() - wall))
    seconds = time.process_time() - cpu, time.perf_counter() - wall
    peak = peak_megabytes() / 1024
    some = np.random.default_rng(0).choice(len(indices), min(JUDGED, len(indices)), replace=False)
    error = 100 * gmds.geodesic_error(answer.points[indices[some]], truth[some]).mean()
    return {
        "vertices": [source.n_vertices, target.n_vertices],
        "cpu": seconds[0],
        "wall": seconds[1],
        "peak": peak,
        "error": float(error),
        "stages": stages,
    }


def page(found: dict[str, dict[str, Any]]) -> str:
    """match_cost.md."""
    lines = [
        "# Cost of a match",
        "",
        "`GMDS_DATA=... python -m benchmarks.cost.match_cost`: two poses of a TOSCA cat, warm, on",
    ]
    lines += [f"{threads()} threads of {os.cpu_count()} processors.", ""]
    lines += ["| vertices | wall s | goal | CPU s | peak GB | goal | error x100 |", "|---" * 7 + "|"]
    for size, one in found.items():
        seconds, memory = GOALS[size]
        cells = [" / ".join(f"{n:,}" for n in one["vertices"]), f"{one['wall']:.1f}", str(seconds), f"{one['cpu']:.1f}"]
        lines.append(f"| {' | '.join(cells)} | {one['peak']:.2f} | {memory} | {one['error']:.2f} |")
    lines += ["", "When each stage begins, seconds:", ""]
    for size, one in found.items():
        lines.append(f"- {size}: " + ", ".join(f"{stage} {at:.1f}" for stage, at in one["stages"].items()))
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure every size in turn, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=lambda text: text.split(","), default=list(SIZES))
    parser.add_argument("--one", choices=SIZES, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measured(options.one)))
        return
    found = {}
    for size in options.sizes:
        run = subprocess.run(
            [sys.executable, "-m", "benchmarks.cost.match_cost", "--one", size],
            capture_output=True,
            text=True,
            check=True,
        )
        found[size] = json.loads(run.stdout)
        print(size, found[size], file=sys.stderr)
    PAGE.write_text(page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
