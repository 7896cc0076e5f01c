"""What landmarks are worth, hard and soft, right and wrong: the error at landmarks that were not given.

    GMDS_DATA=... python -m benchmarks.accuracy.landmarks --half reporting

Whole animals of SHREC'20. Every fourth published landmark is given; *off*: moved by 0.05 root areas in a random
direction and back to the surface; *exchanged*: the first two swapped. The error is the geodesic one at all others,
mean x100. Writes results/landmarks_HALF.csv as it goes, what is there already is kept, and results/landmarks_HALF.md.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.halves import HALVES, PARTIAL, half_of, pairs_of
from benchmarks.accuracy.runs import ONE_THREAD, RESULTS, code_version
from benchmarks.markdown import table
from geodesics import SurfacePoints, read_mesh
from gmds import SoftLandmarks, geodesic_error, match
from gmds.files.table import read_table, write_table
from gmds.landmarks.checking import place_on

SET, EVERY, OFF = "shrec20", 4, 0.05  # every EVERY-th is given; OFF is in root areas, set by hand
COLUMNS = ("version", "pair", "landmarks", "error_x100", "worst_x100", "status")


def off(points: SurfacePoints, distance: float, rng: np.random.Generator) -> SurfacePoints:
    """Points moved by a distance, in root areas, and back to the surface."""
    away = rng.normal(size=(len(points), 3))
    away *= distance * np.sqrt(points.mesh.area) / np.linalg.norm(away, axis=1, keepdims=True)
    return place_on(points.positions + away, points.mesh)


def exchanged(points: SurfacePoints) -> SurfacePoints:
    """Points of which the first two have changed places."""
    return points[np.r_[1, 0, 2 : len(points)]]


CHANGES: dict[str, Callable[[SurfacePoints, np.random.Generator], SurfacePoints]] = {
    "right": lambda points, rng: points,
    "off": lambda points, rng: off(points, OFF, rng),
    "exchanged": lambda points, rng: exchanged(points),
}
KINDS = ("none", *(f"{kind}, {change}" for change in CHANGES for kind in ("hard", "soft")))


def judged(name: str) -> list[tuple[Any, ...]]:
    """The rows of a pair."""
    pair = next(pair for pair in pairs_of(SET) if pair.name == name)
    source, target = read_mesh(pair.source), read_mesh(pair.target)
    index, truth, _ = pair.truth(source, target)
    given = np.arange(0, len(index), EVERY)
    others = np.setdiff1d(np.arange(len(index)), given)
    here = SurfacePoints.at_vertices(source, index[given])
    rows = []
    for kind in KINDS:
        landmarks: Any = None
        if kind != "none":
            hardness, change = kind.split(", ")
            landmarks = here, CHANGES[change](truth[given], np.random.default_rng(0))
            landmarks = SoftLandmarks(landmarks, OFF) if hardness == "soft" else landmarks
        answer = match(source, target, landmarks=landmarks)
        error = 100 * geodesic_error(answer, truth[others], index[others])
        rows.append((name, kind, f"{error.mean():.2f}", f"{error.max():.1f}", answer.status.name))
    return rows


def kept(path: Path, version: str) -> Iterator[tuple[str, ...]]:
    """What is done already by this version."""
    if path.exists():
        yield from (tuple(row.values())[1:] for row in read_table(path) if row["version"] == version)


def main() -> None:
    """Run what is missing, write as it goes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=HALVES, default="reporting")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    version, path = code_version(), RESULTS / f"landmarks_{options.half}.csv"
    rows = list(kept(path, version))
    names = [p.name for p in pairs_of(SET) if p.group != PARTIAL and p.name in half_of(SET, options.half)]
    missing = [name for name in names if name not in {row[0] for row in rows}]
    with ProcessPoolExecutor(options.workers) as pool:
        for found in pool.map(judged, missing):
            rows += found
            print(*found, sep="\n", file=sys.stderr, flush=True)
            write_table(path, COLUMNS, ((version, *row) for row in sorted(rows)))
    error = {row[:2]: float(row[2]) for row in rows}
    lines = [[name, *(f"{error[name, kind]:.1f}" for kind in KINDS)] for name in names]
    means = [f"{np.mean([error[name, kind] for name in names]):.1f}" for kind in KINDS]
    text = [
        "# Landmarks",
        "",
        f"`python -m benchmarks.accuracy.landmarks --half {options.half}` (version {version}): mean error x100 at the",
        f"landmarks of SHREC'20 that were not given, {EVERY - 1} of {EVERY}. Soft ones have the tolerance {OFF}.",
        "",
        *table(["pair", *KINDS], [*lines, ["mean", *means]]),
    ]
    (RESULTS / f"landmarks_{options.half}.md").write_text("\n".join(text), encoding="utf-8")


if __name__ == "__main__":
    main()
