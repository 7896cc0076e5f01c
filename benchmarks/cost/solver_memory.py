"""What the solver holds in memory: against samples, and against vertices.

    python -m benchmarks.cost.solver_memory [--only all-pairs]

Pairs of surfaces and starts are those of `solver_cost`. "Pairs to the first" is a problem as `match` poses it: of more
than 1,000 samples only pairs that one of the first 250 belongs to, solved by `gmds.solve_by_ladder`, or, from the first
100 places, by `gmds.solve_multiresolution`. "All pairs" is `gmds.solve` of all of them. Of surfaces of 5,000, 20,000
and 50,000 vertices geodesic distances in g are tabulated (300 farthest points, rank 120), and 2,000 samples placed in
them. "match" is the whole of it by geodesics in |K| g. Each case runs in a process of its own, after a small one, so
that kernels are compiled; what that process held before is taken off. Linux alone tells this. CPU seconds are of one
thread. Writes results/solver_memory.md and .csv.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import geodesics
import gmds
from benchmarks.cost.solver_cost import animal, in_a_process, placed
from benchmarks.markdown import table
from benchmarks.memory import peak_megabytes
from benchmarks.places import RESULTS
from gmds.files.table import write_table
from gmds.mds.losses import LeastSquares
from gmds.mds.many_samples import HEADS, MANY, pairs_asked
from gmds.shapes import quadruped

PAGE, ROWS = RESULTS / "solver_memory.md", RESULTS / "solver_memory.csv"
CLEAR = Path("/proc/self/clear_refs")  # 5 written to it: the peak starts anew from what is held now
IN_TABLES = ("first-in-table", "multiresolution-in-table")
CASES = [
    *(f"first {count} 5000" for count in (250, 500, 1000, 2000, 4000)),
    *(f"all-pairs {count} 5000" for count in (250, 500, 1000, 2000, 4000)),
    *(f"multiresolution {count} 5000" for count in (1000, 2000, 4000)),
    *(f"marched {count} 5000" for count in (250, 500, 1000)),
    *(f"{what} 2000 {vertices}" for vertices in (5000, 20_000, 50_000) for what in ("table", *IN_TABLES)),
    *(f"match {count} 5000" for count in (500, 2000, 4000)),
]
FEW = 100  # samples that `solve_multiresolution` starts with; set by hand
MEANS = {
    "first": "pairs to the first, as `match` poses it",
    "all-pairs": "all pairs",
    "multiresolution": "`solve_multiresolution` from 100, the same pairs",
    "marched": "pairs to the first, of fields that are marched",
    "table": "two tables of geodesic distances made",
    "first-in-table": "pairs to the first, in these tables",
    "multiresolution-in-table": "`solve_multiresolution` from 100, in these tables",
    "match": "`match(distance=...)`, all of it",
}


def geodesic(mesh: geodesics.Mesh) -> geodesics.GeodesicDistance:
    """Geodesic distances in |K| g."""
    return geodesics.GeodesicDistance(geodesics.scale_invariant(mesh))


def commute(mesh: geodesics.Mesh) -> geodesics.CommuteTimeDistance:
    """Commute-time distances by 100 eigenfunctions."""
    return geodesics.CommuteTimeDistance(geodesics.eigenpairs(mesh, 100))


def distance_for(what: str) -> Callable[[geodesics.Mesh], geodesics.Distance]:
    """The distance that a case is measured in."""
    if what == "marched":
        return geodesics.GeodesicDistance
    if "table" in what:
        return lambda mesh: gmds.TabulatedDistance(geodesics.GeodesicDistance(mesh))
    return commute


def grown(work: Callable[[], Any]) -> dict[str, float]:
    """CPU seconds of some work, and by how many megabytes memory grew in it at the most."""
    CLEAR.write_text("5", encoding="ascii")
    before, cpu = peak_megabytes(), time.process_time()
    work()
    return {"megabytes": peak_megabytes() - before, "cpu": time.process_time() - cpu, "base": before}


def measured(what: str, count: int, vertices: int) -> dict[str, float]:
    """One case, in this process: megabytes, CPU seconds, megabytes held before; and the stress of all pairs."""
    small = quadruped(n_vertices=600), quadruped("walk", n_vertices=600, seed=1)
    start, _ = placed(*small, range(30))
    here = geodesics.SurfacePoints.at_vertices(small[0], range(30))
    distances = [distance_for(what)(mesh) for mesh in small]
    gmds.solve_by_ladder(gmds.Problem(distances[0], here, distances[1]), start)
    gmds.solve_multiresolution(gmds.Problem(distances[0], here, distances[1]), start[:20])
    both = animal(vertices), animal(vertices, "walk")
    if what == "match":
        gmds.match(*small, distance=geodesic, n_samples=30)
        return grown(lambda: gmds.match(*both, distance=geodesic, n_samples=count))
    if what == "table":
        gmds.TabulatedDistance(geodesics.GeodesicDistance(small[0]), landmarks=30)
        return grown(lambda: [gmds.TabulatedDistance(geodesics.GeodesicDistance(mesh)) for mesh in both])
    ours, theirs = (distance_for(what)(mesh) for mesh in both)
    samples = geodesics.farthest_point_sampling(commute(both[0]), count)
    points, (start, _) = geodesics.SurfacePoints.at_vertices(both[0], samples), placed(*both, samples)
    found: list[gmds.Solution] = []

    def work() -> None:
        asked = gmds.Problem(ours, points, theirs, pairs=None if what == "all-pairs" else pairs_asked(count))
        if "multiresolution" in what:
            found.append(gmds.solve_multiresolution(asked, start[:FEW]))
        else:
            found.append((gmds.solve if what == "all-pairs" else gmds.solve_by_ladder)(asked, start))

    row = grown(work)
    every = gmds.Problem(ours, points, theirs).at(found[0].points).residuals
    return {**row, "stress": LeastSquares().value(every)}


def page(rows: list[dict[str, str]]) -> str:
    """solver_memory.md."""
    told = [
        [MEANS[row["what"]], *(f"{int(row[name]):,}" for name in ("samples", "vertices")), row["megabytes"], row["cpu"]]
        for row in rows
    ]
    told = [[*cells, row["stress"] or "-"] for cells, row in zip(told, rows, strict=True)]
    held = sorted(float(row["base"]) for row in rows)
    return "\n".join(
        [
            "# Memory of the solver",
            "",
            "`python -m benchmarks.cost.solver_memory`: see there for what is solved. Megabytes by which memory grew",
            f"at the most; the process held {held[0]:.0f} to {held[-1]:.0f} MB before (Python, libraries, compiled",
            f"kernels, both surfaces, their spectra or tables). Of more than {MANY:,} samples `match` asks for pairs",
            f"to the first {HEADS} alone: what it holds is then linear in samples. The stress is that of all pairs.",
            "",
            *table(["what", "samples", "vertices", "MB", "CPU s", "stress"], told),
            "",
            "What is not linear in samples: a problem of all pairs holds four numbers a pair, and `gmds.solve` of it",
            "the derivative of each by both its points as well; `pairs=250` of `gmds.Problem` avoids that, and what",
            "does not fit is refused with that advice. A distance without coordinates, such as `GeodesicDistance`,",
            "holds samples by vertices numbers of the target; `gmds.TabulatedDistance` of it does not, and `match`",
            "makes that by itself.",
            "",
        ]
    )


def row(case: str) -> dict[str, str]:
    """One case, in a process of its own."""
    found = in_a_process("benchmarks.cost.solver_memory", case)
    what, count, vertices = case.split()
    numbers = {"megabytes": f"{found['megabytes']:.0f}", "cpu": f"{found['cpu']:.1f}", "base": f"{found['base']:.0f}"}
    stress = f"{found['stress']:.3g}" if "stress" in found else ""
    return {"what": what, "samples": count, "vertices": vertices, **numbers, "stress": stress}


def main() -> None:
    """Run the cases, write the page and its rows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="cases whose names have this in them, printed")
    parser.add_argument("--case", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.case:
        what, count, vertices = options.case.split()
        print(json.dumps(measured(what, int(count), int(vertices))))
        return
    rows = []
    for case in CASES:
        if options.only in case:
            rows.append(row(case))
            print(*rows[-1].values(), flush=True)
    if not options.only:
        write_table(ROWS, list(rows[0]), [list(row.values()) for row in rows])
        PAGE.write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
