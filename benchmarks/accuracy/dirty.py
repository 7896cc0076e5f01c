"""Meshes with faults: what they cost, and how right their maps are, beside the clean pair.

    GMDS_DATA=... python -m benchmarks.accuracy.dirty [--faults pinched,charts] [--pairs horse] [--label before]

Both meshes of a pair are given each fault (`benchmarks.accuracy.spoiled`), the target renumbered and turned and resized
at random. Mean geodesic error x100 on the clean target at vertices of the clean source; CPU seconds of `match` on one
thread, the second of two matches of a process being timed. Rows of results/dirty.csv that are of this version are not
measured again; `--label` names another column of versions. Writes results/dirty.md.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

import numpy as np

import gmds
from benchmarks.accuracy import spoiled
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, MeshError, SurfacePoints, read_mesh
from geodesics.arrays import Integers
from gmds.benchmarking.run import turned
from gmds.evaluation import geodesic_error, protocol_subset
from gmds.files.table import read_table, write_table
from gmds.shapes import humanoid, quadruped, truth

COLUMNS = ("pair", "fault", "version", "status", "error", "valid", "cpu_seconds")
NO_FAULT = "clean"
REAL = "as published"
Pair = tuple[Mesh, Mesh, Integers, SurfacePoints]


def built_in() -> dict[str, Pair]:
    """Source, target, judged source vertices and their true points, of shapes that are made here."""
    found = {}
    for name, make, n in (("quadruped", quadruped, 3000), ("humanoid", humanoid, 12500)):
        one, other = make(n_vertices=n), make("walk", n_vertices=n, seed=1)
        judged = protocol_subset(one.n_vertices)
        found[name] = (one, other, judged, truth(one, other)[judged])
    return found


def published(name: str) -> Pair:
    """The same of meshes in `GMDS_DATA`."""
    data = Path(os.environ["GMDS_DATA"])
    if name.startswith(("horse", "centaur")):
        one, other = (read_mesh(data / "tosca_hires" / f"{part}.off") for part in name.split("-"))
        judged = protocol_subset(one.n_vertices)
        return one, other, judged, SurfacePoints.at_vertices(other, judged)
    entries = json.loads((data / "anatomy" / "pairs.json").read_text(encoding="utf-8"))
    entry = next(one for one in entries if one["name"] == name)
    one, other = (read_mesh(data / entry[side]) for side in ("source", "target"))
    known = np.load(data / entry["truth"])
    return one, other, known["src"], SurfacePoints.at_vertices(other, known["gt"])


PAIRS = ("quadruped", "humanoid", "horse0-horse10")
SKULLS = ("mouse_skulls_A_J-PWD", "mouse_skulls_PWD-C57BL6_J", "mouse_skulls_C57BL6_J-MOLF")


def jobs() -> Iterator[tuple[str, str]]:
    """All pairs and faults."""
    faults = (NO_FAULT, *(fault.__name__ for fault in spoiled.FAULTS))
    yield from ((pair, fault) for pair in PAIRS for fault in faults)
    yield from ((pair, REAL) for pair in SKULLS)


def row(pair: str, fault: str, version: str) -> dict[str, str]:
    """One pair with one fault, matched and judged."""
    source, target, judged, true = built_in()[pair] if pair in ("quadruped", "humanoid") else published(pair)
    rng = np.random.default_rng([0, *f"{pair}{fault}".encode()])
    spoil = next((one for one in spoiled.FAULTS if one.__name__ == fault), None)
    given = [mesh if spoil is None else spoil(mesh, rng) for mesh in (source, target)]
    order = rng.permutation(given[1].n_vertices)  # old number of each new vertex
    new = np.argsort(order)
    moved = turned(Mesh(given[1].vertices[order], new[given[1].faces]), rng)
    clean = Mesh(moved.vertices[new[: target.n_vertices]], target.faces)
    gmds.match(quadruped(n_vertices=600), quadruped(n_vertices=600))  # so that no pair pays for imports
    started = time.process_time()
    told = {"pair": pair, "fault": fault, "version": version}
    try:
        answer = gmds.match(given[0], moved)
    except MeshError as error:
        return {**told, "status": str(error)[:4], "error": "none", "valid": "none", "cpu_seconds": "none"}
    seconds = time.process_time() - started
    points = SurfacePoints.closest(clean, answer.points.positions[judged])
    errors = geodesic_error(points, SurfacePoints(clean, true.face, true.barycentric))
    return {
        **told,
        "status": answer.status.name,
        "error": f"{100 * float(errors.mean()):.3f}",
        "valid": f"{answer.valid[judged].mean():.3f}",
        "cpu_seconds": f"{seconds:.2f}",
    }


def page(rows: list[dict[str, str]]) -> str:
    """The table, a row for each pair and fault, with columns for each version."""
    versions = list(dict.fromkeys(one["version"] for one in rows))
    head = ["pair", "fault", *(f"{what}, {v}" for v in versions for what in ("error", "status", "valid", "CPU s"))]
    lines = []
    for pair, fault in dict.fromkeys((one["pair"], one["fault"]) for one in rows):
        cells = []
        for version in versions:
            key = (pair, fault, version)
            found = next((one for one in rows if (one["pair"], one["fault"], one["version"]) == key), {})
            cells += [found.get(column, "-") for column in ("error", "status", "valid", "cpu_seconds")]
        lines.append([pair, fault, *cells])
    text = ["# Meshes with faults", "", "`python -m benchmarks.accuracy.dirty`; see the script for the protocol.", ""]
    return "\n".join([*text, *table(head, lines)])


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", help="names, separated by commas")
    parser.add_argument("--faults", help="names, separated by commas")
    parser.add_argument("--label", help="what to call this version of the code")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    path, version = options.output / "dirty.csv", options.label or code_version()
    rows = read_table(path) if path.is_file() else []
    done = {(one["pair"], one["fault"]) for one in rows if one["version"] == version}
    todo = [(pair, fault) for pair, fault in jobs() if (pair, fault) not in done]
    todo = [one for one in todo if options.pairs is None or one[0] in options.pairs.split(",")]
    todo = [one for one in todo if options.faults is None or one[1] in options.faults.split(",")]
    order = {key: number for number, key in enumerate(jobs())}
    with ProcessPoolExecutor(options.workers, multiprocessing.get_context("spawn")) as pool:
        for future in as_completed([pool.submit(row, *one, version) for one in todo]):
            rows.append(future.result())
            print(*rows[-1].values(), file=sys.stderr)
            rows.sort(key=lambda one: order[one["pair"], one["fault"]])
            write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in rows])
    text = page(rows)
    (options.output / "dirty.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
