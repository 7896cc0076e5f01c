"""What a match costs beside pyFM's ZoomOut, in CPU seconds of one thread, in turn in one process.

    pip install pyfmaps==1.3.1
    GMDS_DATA=... python -m benchmarks.cost.against_pyfm

Six development pairs of 5,000 vertices a side, two each of FAUST and TOSCA, one locally scaled, one of two species; the
peer as in `benchmarks.accuracy.peers`. The better of two runs each, after one that compiles; then a pair of stored
surfaces, as in a batch; the same settled, as in an atlas, from where the match has it, with all that reads and writes;
and two threads. Writes results/against_pyfm.md.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.peers import functional_map
from benchmarks.places import RESULTS
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.threads import one_blas_thread, threads
from gmds import geodesic_error, match
from gmds.batch.surface_file import read_surface, write_surface
from gmds.benchmarking.datasets import Pair, dataset_pairs
from gmds.matching.settling import CommonPoints, settled_places
from gmds.surface.measured import measure

PAGE = RESULTS / "against_pyfm.md"
PAIRS = (
    ("faust_5k", "tr_reg_010", "tr_reg_012"),
    ("faust_5k", "tr_reg_024", "tr_reg_044"),
    ("tosca_5k", "cat0", "cat5"),
    ("tosca_5k", "horse14", "horse5"),
    ("scaled", "b05_faust_x3", ""),
    ("tosca_cross_5k", "8_gorilla_02", "8_man_02"),
)
JUDGED = 125  # true points, as in the protocol


def found(folder: Path, source: str, target: str) -> Pair:
    """A pair of a set."""
    names = (source,) if not target else (f"{source}-{target}",)
    return next(pair for pair in dataset_pairs(folder) if pair.name in names)


def spent(work: Callable[[], Any]) -> tuple[float, float, Any]:
    """CPU and wall seconds of the better of two runs, and what the last returned."""
    seconds = []
    for _ in range(2):
        cpu, wall = time.process_time(), time.perf_counter()
        result = work()
        seconds.append((time.process_time() - cpu, time.perf_counter() - wall))
    return min(cpu for cpu, _ in seconds), min(wall for _, wall in seconds), result


def row(pair: Pair, folder: Path) -> tuple[list[str], list[float]]:
    """The line of a pair, and the numbers of it: ours, theirs, stored, settled, wall on one thread and on all."""
    source, target = read_mesh(pair.source), read_mesh(pair.target)
    indices, truth, _ = pair.truth(source, target)
    some = np.random.default_rng(0).choice(len(indices), min(JUDGED, len(indices)), replace=False)

    def error(answer: Any) -> float:
        placed = SurfacePoints(target, answer.points.face[indices[some]], answer.points.barycentric[indices[some]])
        return float(100 * geodesic_error(placed, truth[some]).mean())

    def again() -> tuple[Mesh, Mesh]:
        return Mesh(source.vertices, source.faces), Mesh(target.vertices, target.faces)

    os.environ["GMDS_THREADS"] = "1"
    ours, wall, answer = spent(lambda: match(*again()))
    with one_blas_thread():
        theirs, _, other = spent(lambda: functional_map(*again()))
    paths = [folder / f"{pair.name}_{i}.npz" for i in range(2)]
    for path, mesh in zip(paths, again(), strict=True):
        write_surface(path, measure(mesh))
    stored, _, _ = spent(lambda: match(*(read_surface(path) for path in paths)))
    common = CommonPoints(source.vertices, answer.points.positions, source.faces)
    settled, _, _ = spent(lambda: settled_places(*(read_surface(path) for path in paths), common))
    del os.environ["GMDS_THREADS"]
    _, wall_of_all, _ = spent(lambda: match(*again()))
    numbers = [ours, theirs, stored, settled, wall, wall_of_all]
    return [pair.name, *cells(*numbers), f"{error(answer):.2f}", f"{error(other):.2f}"], numbers


def cells(ours: float, theirs: float, stored: float, settled: float, wall: float, of_all: float) -> list[str]:
    """Seconds as columns of the table, with the ratios that the goals are about."""
    cpu = [f"{ours:.2f}", f"{theirs:.2f}", f"{ours / theirs:.2f}", f"{stored:.2f}", f"{settled:.2f}"]
    return [*cpu, f"{wall:.2f}", f"{of_all:.2f}", f"{wall / of_all:.2f}"]


def main() -> None:
    """Measure, and write the page."""
    data = Path(os.environ["GMDS_DATA"])
    pairs = [found(data / name, source, target) for name, source, target in PAIRS]
    first = read_mesh(pairs[0].source), read_mesh(pairs[0].target)
    match(*first)
    functional_map(*first)
    with tempfile.TemporaryDirectory() as folder:
        rows, numbers = zip(*(row(pair, Path(folder)) for pair in pairs), strict=True)
    last = ["median", *cells(*np.median(np.array(numbers), axis=0)), "", ""]
    head = ["pair", "match", f"pyfmaps {version('pyfmaps')}", "ratio", "stored pair", "settled pair"]
    head += ["wall", f"wall, {threads()} threads", "faster", "error", "error of pyFM"]
    lines = ["# What a match costs beside pyFM", ""]
    lines += ["`GMDS_DATA=... python -m benchmarks.cost.against_pyfm`: CPU seconds of one thread, mean error x100.", ""]
    lines += [" | ".join(("", *line, "")).strip() for line in (head, ["---"] * len(head), *rows, last)]
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
