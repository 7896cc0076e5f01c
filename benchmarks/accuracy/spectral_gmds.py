"""Spectral GMDS beside GMDS of points, at equal samples and equal eigenfunctions.

    GMDS_DATA=... python -m benchmarks.accuracy.spectral_gmds [--sets faust_5k] [--every 11]

Reporting pairs, those of plain.md. From one start, the true map shaken by normal noise of a twentieth of a root area in
each coordinate, `gmds.spectral_gmds` looks for the orthogonal matrix of 60 eigenfunctions; and `gmds.solve` places the
same 300 samples (least squares, the weights of `match`), which 60 eigenfunctions continue; nothing else. Geodesic
distances in |K|^a g, a = 0, 1/2, 1. Writes spectral_gmds.csv and spectral_gmds.md to benchmarks/results/.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import geodesics
import gmds
from benchmarks.accuracy.asymmetric import of_unit_area
from benchmarks.accuracy.plain import EVERY, spread
from benchmarks.accuracy.runs import chosen_pairs, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import SurfacePoints
from gmds.benchmarking.pairs import Pair
from gmds.files.table import read_table, write_table
from gmds.matching.given_distances import relative_weights
from gmds.spectral.extension import extend
from gmds.surface.measured import SMOOTHING
from gmds.surface.view import View

SAMPLES, FUNCTIONS = 300, 60  # as many samples as `match` has, and its eigenfunctions of a dense map
SHAKEN = 0.05  # root areas, in each coordinate: what a start is off by that is roughly right
EXPONENTS = (0.0, 0.5, 1.0)
COLUMNS = ("version", "set", "pair", "a", "start", "matrix", "matrix_cpu", "points", "samples", "points_cpu")
PAIRS = 3  # of each set at the most; scaled: the first three of all


def judged(pair: Pair) -> Iterator[tuple[float, ...]]:
    """Of each exponent: it, errors x100 of start, matrix and points, with CPU seconds of both, and of the samples."""
    source, target = (of_unit_area(path) for path in (pair.source, pair.target))
    vertices, truth, _ = pair.truth(source, target)
    noise = np.random.default_rng(0).normal(size=(source.n_vertices, 3))
    nearest = np.array([np.abs(vertices - one).argmin() for one in range(source.n_vertices)])  # truth is of nearly all
    start = SurfacePoints.closest(target, truth.positions[nearest] + SHAKEN * noise)

    def error(points: SurfacePoints, of: np.ndarray) -> float:
        return float(100 * gmds.geodesic_error(points[of], truth[nearest[of]]).mean())

    for a in EXPONENTS:
        metrics = [geodesics.scale_invariant(mesh, exponent=a, smoothing=SMOOTHING) for mesh in (source, target)]
        ours, theirs = (geodesics.GeodesicDistance(metric) for metric in metrics)
        spectral, one = timed(gmds.spectral_gmds, ours, theirs, start, count=FUNCTIONS, samples=SAMPLES)
        samples = geodesics.farthest_point_sampling(ours, SAMPLES)
        (placed, continued), two = timed(of_points, ours, theirs, samples, start)
        ends = (error(spectral.points, vertices), one, error(continued, vertices))
        own = np.isin(samples, vertices)
        at = float(100 * gmds.geodesic_error(placed[own], truth[nearest[samples[own]]]).mean())
        yield (a, error(start, vertices), *ends, at, two)


def of_points(
    ours: geodesics.GeodesicDistance, theirs: geodesics.GeodesicDistance, samples: np.ndarray, start: SurfacePoints
) -> tuple[SurfacePoints, SurfacePoints]:
    """Where samples are placed, and every vertex by what continues them."""
    tables = gmds.TabulatedDistance(ours), gmds.TabulatedDistance(theirs)
    problem = gmds.Problem(tables[0], samples, tables[1], weights=relative_weights)
    placed = gmds.solve(problem, start[samples]).points
    views = [View.of(geodesics.eigenpairs(one.metric, FUNCTIONS)) for one in (ours, theirs)]
    return placed, extend(views[0], views[1], samples, placed, FUNCTIONS)


def timed(work: Callable[..., Any], *of: Any, **how: Any) -> tuple[Any, float]:
    """What work returns, and its CPU seconds."""
    began = time.process_time()
    return work(*of, **how), time.process_time() - began


def page(rows: list[dict[str, str]]) -> str:
    """spectral_gmds.md."""
    lines, numbers = [], COLUMNS[4:]
    for row in rows:
        start, matrix, matrix_cpu, points, samples, points_cpu = (float(row[name]) for name in numbers)
        both = [f"{matrix:.2f} ({matrix_cpu:.1f} s)", f"{points:.2f} ({points_cpu:.1f} s)", f"{samples:.2f}"]
        lines.append([row["set"], row["pair"], f"{float(row['a']):g}", f"{start:.2f}", *both])
    told = []
    for a in EXPONENTS:
        mine = [row for row in rows if float(row["a"]) == a]
        better = sum(float(row["matrix"]) < float(row["points"]) for row in mine)
        matrix, points = (np.array([float(row[name]) for row in mine]) for name in ("matrix", "points"))
        told.append(
            f"- a = {a:g}: matrix {matrix.mean():.2f} in the mean, {np.median(matrix):.2f} in the median; points"
            f" {points.mean():.2f} and {np.median(points):.2f}; the matrix is better on {better} of {len(mine)} pairs."
        )
    return "\n".join(
        [
            "# Spectral GMDS beside GMDS of points",
            "",
            f"`python -m benchmarks.accuracy.spectral_gmds` at {rows[0]['version']}: see there for what is compared.",
            "Mean geodesic error x100 at all vertices that have a truth, CPU seconds with everything that is measured",
            "for it. Geodesic distances in |K|^a g. Samples: the error of the samples that `gmds.solve` placed.",
            "",
            *table(["set", "pair", "a", "start", "orthogonal matrix", "points, continued", "samples"], lines),
            "",
            *told,
            "",
        ]
    )


def main() -> None:
    """Measure what is not there yet, write rows and page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", default=",".join(EVERY))
    parser.add_argument("--every", type=int, help="every N-th pair only; as plain.md unless given")
    asked = parser.parse_args()
    version, path = code_version(), RESULTS / "spectral_gmds.csv"
    rows: list[tuple] = []
    for name in asked.sets.split(","):
        half = None if name == "scaled" else "reporting"
        for pair in spread(chosen_pairs(name, half, asked.every or EVERY[name]))[:PAIRS]:
            for found in judged(pair):
                rows.append((version, name, pair.name, *found))
                print(*rows[-1], flush=True)
            write_table(path, COLUMNS, rows, digits=4)
    (RESULTS / "spectral_gmds.md").write_text(page(read_table(path)), encoding="utf-8")


if __name__ == "__main__":
    main()
