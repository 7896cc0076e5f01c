"""What the solver costs: samples from 500 to 2,000, least squares and the maximum; and distances of 50,000 vertices.

    python -m benchmarks.cost.solver_cost [--only table]

Two poses of the built-in animal, 5,000 vertices, commute-time distances by 100 eigenfunctions, from the truth shaken by
3 % of a root area. "At once" is `gmds.solve` of all pairs; what is beside it is `gmds.solve_by_ladder`, of the pairs
that `match` asks for. The stress is that of all pairs. The table of geodesic distances is that of an animal of 50,000
vertices, each face of a coarser one in four. Each case runs in a process of its own, after a small problem, so that
kernels are compiled. CPU seconds are of one thread. Writes results/solver_cost.md.
"""

from __future__ import annotations

import argparse
import functools
import json
import os
import resource
import subprocess
import sys
import time
from typing import Any

import igl
import numpy as np
from numpy.typing import ArrayLike

import geodesics
import gmds
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import SurfacePoints
from geodesics.tracing import walk
from gmds.mds.many_samples import pairs_asked
from gmds.shapes import Figure, quadruped, truth

PAGE = RESULTS / "solver_cost.md"
LARGE = 50_000
SAMPLED = 5000  # vertices of a built-in animal as they are made; more are made of fewer, which is quicker
CASES = ["500 LeastSquares", "2000 LeastSquares", "2000 LeastSquares at-once", "500 Minimax", "table 300"]
ONE = dict.fromkeys(("GMDS_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
JUDGED = 20  # points whose marched distances a table is compared with


def problem(
    count: int, vertices: int = 5000, *, every: bool = False
) -> tuple[gmds.Problem, SurfacePoints, SurfacePoints]:
    """What is asked, of the pairs that `match` asks for or of every pair, from where, and the truth."""
    source, target = animal(vertices), animal(vertices, "walk")
    ours, theirs = (geodesics.CommuteTimeDistance(geodesics.eigenpairs(mesh, 100)) for mesh in (source, target))
    samples = geodesics.farthest_point_sampling(ours, count)
    here = SurfacePoints.at_vertices(source, samples)
    pairs = None if every else pairs_asked(count)
    return gmds.Problem(ours, here, theirs, pairs=pairs), *placed(source, target, samples)


@functools.cache
def animal(vertices: int, pose: str = "stand") -> Figure:
    """The built-in animal; of many vertices, one of fewer with each face cut in four."""
    seed = 0 if pose == "stand" else 1
    if vertices <= SAMPLED:
        return quadruped(pose, n_vertices=vertices, seed=seed)
    coarse = quadruped(pose, n_vertices=vertices // 4 + 2, seed=seed)
    (finer, faces), (rest, _) = (igl.upsample(corners, coarse.faces) for corners in (coarse.vertices, coarse.rest))
    return Figure(finer, faces, rest)


def placed(source: Figure, target: Figure, samples: ArrayLike) -> tuple[SurfacePoints, SurfacePoints]:
    """Where samples of the source start, and where they truly belong."""
    true = truth(source, target)[np.asarray(samples)]
    shift = 0.03 * np.sqrt(target.area) * np.random.default_rng(0).normal(size=(len(true), 2))
    return walk(true, shift), true


def solved(count: int, loss: str, *, at_once: bool) -> dict[str, Any]:
    """CPU seconds, the stress, the certificate, and the error of the samples."""
    small, start, _ = problem(30, 600)
    gmds.solve_by_ladder(small, start, getattr(gmds, loss)())
    asked, start, true = problem(count, every=at_once)
    cpu = time.process_time()
    found = (gmds.solve if at_once else gmds.solve_by_ladder)(asked, start, getattr(gmds, loss)())
    cpu = time.process_time() - cpu
    return {
        "cpu": cpu,
        "stress": getattr(gmds, loss)().value(problem(count, every=True)[0].at(found.points).residuals),
        "certificate": found.certificate,
        "error": float(100 * gmds.geodesic_error(found.points, true).mean()),
    }


def tabulated(landmarks: int) -> dict[str, Any]:
    """CPU seconds and peak of memory of a table, and how far it is from marched distances, as a share of their mean."""
    gmds.TabulatedDistance(geodesics.GeodesicDistance(quadruped(n_vertices=600)), landmarks=30)
    mesh = animal(LARGE)
    exact = geodesics.GeodesicDistance(mesh)
    before, cpu = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    quick = gmds.TabulatedDistance(exact, landmarks=landmarks)
    cpu, peak = time.process_time() - cpu, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    some = np.random.default_rng(0).choice(mesh.n_vertices, JUDGED, replace=False)
    true, rows = exact.field(some), quick.embedding
    square = np.array([((rows - rows[v]) ** 2) @ quick.signature for v in some])
    gap = np.abs(np.sqrt(np.maximum(square, 0.0)) - true).mean() / true.mean()
    megabytes = (peak - before) / 2**10
    return {"cpu": cpu, "vertices": mesh.n_vertices, "rank": rows.shape[1], "megabytes": megabytes, "gap": float(gap)}


def page(found: dict[str, dict[str, Any]]) -> str:
    """solver_cost.md."""
    solver, tables = [], []
    for name, row in found.items():
        what, kind, *more = name.split()
        if what == "table":
            numbers = f"{row['cpu']:.1f}", f"{row['megabytes']:.0f}", f"{100 * row['gap']:.2f} %"
            tables.append([f"{row['vertices']:,}", kind, row["rank"], *numbers])
        else:
            numbers = f"{row['cpu']:.1f}", f"{row['stress']:.3g}", f"{row['certificate']:.1g}", f"{row['error']:.2f}"
            solver.append([what, kind, "at once" if more else "", *numbers])
    return "\n".join(
        [
            "# Cost of the solver",
            "",
            "`python -m benchmarks.cost.solver_cost`: see there for what is solved. Goals: 3",
            "CPU seconds for 2,000 samples with least squares, 10 for the maximum of 500, with a certificate of 1 %.",
            "",
            *table(["samples", "loss", "", "CPU s", "stress", "certificate", "error x100"], solver),
            "",
            "## Geodesic distances of many vertices, tabulated",
            "",
            "Never n x n. The megabytes are what the peak of memory grew by, the gap is to marched distances, over",
            "their mean.",
            "",
            *table(["vertices", "landmarks", "rank", "CPU s", "MB", "gap"], tables),
            "",
        ]
    )


def measured(case: str) -> dict[str, Any]:
    """One case, in this process."""
    what, kind, *more = case.split()
    return tabulated(int(kind)) if what == "table" else solved(int(what), kind, at_once=bool(more))


def in_a_process(script: str, case: str) -> dict[str, Any]:
    """What a script prints of one case, in a process of its own on one thread."""
    command = [sys.executable, "-m", script, "--case", case]
    told = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env={**os.environ, **ONE})
    return dict(json.loads(told.stdout))


def main() -> None:
    """Run the cases, write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="cases whose names have this in them, printed")
    parser.add_argument("--case", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.case:
        print(json.dumps(measured(options.case)))
        return
    found = {}
    for case in CASES:
        if options.only in case:
            found[case] = in_a_process("benchmarks.cost.solver_cost", case)
            print(case, found[case], flush=True)
    if not options.only:
        PAGE.write_text(page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
