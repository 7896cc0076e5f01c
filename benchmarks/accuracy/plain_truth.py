"""Whether a distance or the solver is to blame: the stress of the true map beside that of the map that was found.

    GMDS_DATA=... python -m benchmarks.accuracy.plain --half reporting --signs FOLDER
    GMDS_DATA=... python -m benchmarks.accuracy.plain_truth FOLDER

Root mean square residual, as the weights of `match` have it, of the vertices that FOLDER knows of each map with least
squares. Where the true map has more stress than the one that was found, no solver would have found the true one. Writes
plain_truth.csv to benchmarks/results/, of which `plain.md` has means.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.accuracy.plain import CELLS, EVERY, distance
from benchmarks.accuracy.runs import chosen_pairs
from benchmarks.places import RESULTS
from benchmarks.trust.plain import thinned
from benchmarks.trust.plain_signs import key_of
from geodesics import SurfacePoints, read_mesh
from gmds.benchmarking.pairs import Pair
from gmds.files.table import write_table
from gmds.matching.given_distances import relative_weights
from gmds.mds.pair_distances import pairwise
from gmds.mds.problem import Problem
from gmds.surface.measured import measure

COLUMNS = ("cell", "set", "pair", "stress_of_answer", "stress_of_truth")


def main() -> None:
    """Measure what is there."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--output", type=Path, default=RESULTS)
    asked = parser.parse_args()
    rows = []
    for name, every in EVERY.items():
        for pair in chosen_pairs(name, None if name == "scaled" else "reporting", every):
            rows += [(cell, name, pair.name, *both) for cell, *both in stresses(pair, asked.folder)]
            write_table(asked.output / "plain_truth.csv", COLUMNS, rows, digits=4)


def stresses(pair: Pair, folder: Path) -> Iterator[tuple[str, float, float]]:
    """Of each distance: its cell, the stress of the map that was found and that of the true one."""
    given, other = read_mesh(pair.source), read_mesh(pair.target)
    files = {cell: folder / f"{key_of(given, other)}_{cell.replace(' ', '_')}.npz" for cell in CELLS}
    there = {cell: file for cell, file in files.items() if cell.endswith("LeastSquares") and file.exists()}
    if not there:
        return
    vertices, truth, _ = pair.truth(given, other)
    source, target = measure(given), measure(other)
    back = np.empty(other.n_faces, dtype=np.int64)  # from faces of the original to those that were measured
    back[target.face_index] = np.arange(target.mesh.n_faces)
    for cell, file in there.items():
        kind, *settings, _ = cell.split()
        ours, theirs = (distance(one.mesh, kind, *map(float, settings)) for one in (source, target))
        with np.load(file) as kept:
            shared, place, at = thinned(*np.intersect1d(kept["rows"], vertices, return_indices=True))
            found = SurfacePoints(target.mesh, back[kept["face"][place]], kept["barycentric"][place])
        true = truth[at]
        true = SurfacePoints(target.mesh, back[true.face], true.barycentric)
        here = SurfacePoints.at_vertices(source.mesh, shared)
        problem = Problem(ours, here, theirs, weights=relative_weights(pairwise(ours, here).distances()))
        answer, right = (float(np.sqrt(np.mean(problem.at(points).residuals ** 2))) for points in (found, true))
        yield cell, answer, right


if __name__ == "__main__":
    main()
