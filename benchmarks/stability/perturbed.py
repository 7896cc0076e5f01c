"""How far the map of a pair moves when nothing of the shapes has changed but rounding and numbering.

    GMDS_DATA=... python -m benchmarks.stability.perturbed [--every K]

Each pair is matched three times: as it is; with the vertices of both meshes moved by 1e-9 of the root area in random
directions; with vertices and faces of both renumbered at random. How far images moved is the geodesic distance on the
target over the root of its area, at the points of the protocol; how far the error, its mean x100. Writes
results/perturbed.csv, where what was measured at this version of the code is not measured again, and
results/perturbed.md.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

import gmds
from benchmarks.accuracy.halves import pairs_of
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.arrays import Floats, Integers
from gmds.benchmarking.pairs import Pair
from gmds.benchmarking.run import turned
from gmds.evaluation import geodesic_error, protocol_subset
from gmds.files.table import read_table, write_table

SETS = {"scaled": 1, "faust_5k": 10, "tosca_5k": 12, "tosca_cross_5k": 8, "shrec20": 4}  # every so many pairs: 40 or so
MOVED = 1e-9  # root areas
WAYS = ("rounded", "renumbered")
FIGURES = ("move", "most", "error", "status")
COLUMNS = ("pair", "set", "version", "status", "error", *(f"{way}_{what}" for way in WAYS for what in FIGURES))
SMALL = 0.1  # mean move in root areas below which a map stays what it was


def pairs(every: int) -> Iterator[tuple[str, Pair]]:
    """Set and pair."""
    for name, step in SETS.items():
        yield from ((name, pair) for pair in pairs_of(name)[:: step * every])


class Again(NamedTuple):
    """A mesh, and which vertex and face of it the vertices and faces of another became."""

    mesh: Mesh
    vertex: Integers
    face: Integers

    def points(self, points: SurfacePoints) -> SurfacePoints:
        """Points of the other mesh on this one: the corners of faces keep their order."""
        return SurfacePoints(self.mesh, self.face[points.face], points.barycentric)


def rounded(mesh: Mesh, rng: np.random.Generator) -> Again:
    """With its vertices moved by `MOVED`."""
    step = rng.normal(size=mesh.vertices.shape)
    step *= MOVED * np.sqrt(mesh.area) / np.linalg.norm(step, axis=1, keepdims=True)
    return Again(Mesh(mesh.vertices + step, mesh.faces), np.arange(mesh.n_vertices), np.arange(mesh.n_faces))


def renumbered(mesh: Mesh, rng: np.random.Generator) -> Again:
    """With vertices and faces in another order."""
    order, faces = rng.permutation(mesh.n_vertices), rng.permutation(mesh.n_faces)
    place = np.argsort(order)
    return Again(Mesh(mesh.vertices[order], place[mesh.faces][faces]), place, np.argsort(faces))


def row(name: str, pair: Pair, version: str) -> dict[str, Any]:
    """What becomes of one pair."""
    rng = np.random.default_rng([0, *pair.name.encode()])
    source, target = turned(read_mesh(pair.source), rng), turned(read_mesh(pair.target), rng)
    vertices, truth, _ = pair.truth(source, target)
    chosen = protocol_subset(len(vertices))
    rows = np.asarray(vertices)[chosen]
    true = truth[chosen] if isinstance(truth, SurfacePoints) else SurfacePoints.at_vertices(target, truth[chosen])
    first = gmds.match(source, target)
    error = 100 * geodesic_error(first, true, rows).mean()
    found: dict[str, Any] = {"pair": pair.name, "set": name, "version": version, "status": first.status.name}
    found["error"] = f"{error:.3f}"
    for way, change in zip(WAYS, (rounded, renumbered), strict=True):
        ours, theirs = change(source, rng), change(target, rng)
        again = gmds.match(ours.mesh, theirs.mesh)
        images = again.points[ours.vertex[rows]]
        moved = geodesic_error(images, theirs.points(first.points[rows]))
        after = 100 * geodesic_error(images, theirs.points(true)).mean()
        found |= {f"{way}_move": f"{moved.mean():.4f}", f"{way}_most": f"{moved.max():.4f}"}
        found |= {f"{way}_error": f"{after:.3f}", f"{way}_status": again.status.name}
    return found


HEAD = ("set", "pairs", "mean move, median", "worst", f"below {SMALL}", "error x100 changes by, median", "most")


def figures(name: str, moves: Floats, changes: Floats) -> tuple[Any, ...]:
    """A row of the table: the pairs of a set, how far each map moved and how much its error changed."""
    few = f"{int((moves < SMALL).sum())} of {len(moves)}"
    moved = f"{np.median(moves):.4f}", f"{moves.max():.4f}", few
    return name, len(moves), *moved, f"{np.median(changes):.2f}", f"{changes.max():.2f}"


def page(rows: Sequence[dict[str, Any]], version: str) -> str:
    """A table of all sets."""
    command = f"`python -m benchmarks.stability.perturbed` at {version}; the script says how."
    lines = ["# The same pair again", "", command, ""]
    for way in WAYS:
        found = []
        for name in dict.fromkeys(one["set"] for one in rows):
            some = [one for one in rows if one["set"] == name]
            moves = np.array([float(one[f"{way}_move"]) for one in some])
            changes = np.array([abs(float(one[f"{way}_error"]) - float(one["error"])) for one in some])
            found.append(figures(name, moves, changes))
        lines += [f"## {way.capitalize()}", "", *table(HEAD, found)]
    return "\n".join(lines)


def main() -> None:
    """Run what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description="How far maps move by rounding and numbering.")
    parser.add_argument("--every", type=int, default=1, help="of the pairs, every so many")
    every = parser.parse_args().every
    os.environ.update(ONE_THREAD)
    path, version = RESULTS / "perturbed.csv", code_version()
    rows = {one["pair"]: dict(one) for one in read_table(path)} if path.is_file() else {}
    rows = {name: one for name, one in rows.items() if one["version"] == version}
    for name, pair in pairs(every):
        if pair.name in rows:
            continue
        rows[pair.name] = row(name, pair, version)
        print(*rows[pair.name].values(), file=sys.stderr, flush=True)
        write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in rows.values()])
        (RESULTS / "perturbed.md").write_text(page(list(rows.values()), version), encoding="utf-8")


if __name__ == "__main__":
    main()
