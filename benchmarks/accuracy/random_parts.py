"""Parts drawn at random, matched with another pose and back: on what no pair of the other tables has.

    GMDS_DATA=... python -m benchmarks.accuracy.random_parts [--pairs 20] [--seed 77001] [--only 3,8]

Poses of built-in shapes, TOSCA and FAUST of which a plane across a random direction, a geodesic ball around a random
vertex or several balls have taken 12 to 60 % of the area, or of which a scan from a random direction is left. Both
meshes turned and resized at random, defaults only. Mean geodesic error x100 on what has a counterpart; overlap IoU on
the whole, `covered` of the part's map or `valid` of the way back. No hyper-parameter was chosen on these pairs. Writes
results/random_parts.csv, row by row, where what is there is not measured again, and results/random_parts.md.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import gmds
from benchmarks.accuracy.cuts import MAKERS, VERTICES
from benchmarks.accuracy.part_tables import FAILED, statuses
from benchmarks.accuracy.parts import Known, read_rows
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.arrays import Floats
from gmds.benchmarking.overlap import overlap_scores
from gmds.benchmarking.run import turned
from gmds.benchmarking.truth_files import read_vts
from gmds.deformations import Part, carried, cut, scan
from gmds.evaluation import geodesic_error, protocol_subset
from gmds.files.table import write_table
from gmds.shapes import quadruped, truth

KINDS = ("TOSCA", "FAUST", "built-in")
FOLDERS = {"TOSCA": "tosca_5k", "FAUST": "faust_5k"}
HOW = ("plane", "scan", "balls", "ball")
POSES = {"animal": ("walk", "stand", "graze", "turn"), "person": ("kick", "stand", "wave", "walk")}
PEOPLE, OF_EACH = 5, 10  # and their poses, in the folder of FAUST
MOST_OF_BALLS = 0.5  # a share of the area: what is left of more holds together no longer
COLUMNS = ("pair", "group", "version", "status", "error", "iou", "cpu_seconds", "part", "margin", "curvature")


class Drawn(NamedTuple):
    """A pose to be cut, one that stays whole, how it is cut, and what was drawn for that."""

    number: int
    kind: str
    part: str
    whole: str
    how: str
    share: float
    seed: int
    direction: Floats
    balls: int


def drawn(count: int, seed: int) -> list[Drawn]:
    """The first so many."""
    rng = np.random.default_rng(seed)
    data = Path(os.environ["GMDS_DATA"])
    creatures: dict[str, list[str]] = {}
    for path in sorted((data / "tosca_5k").glob("*.off")):
        creatures.setdefault(path.stem.rstrip("0123456789"), []).append(path.stem)
    found = []
    for i in range(count):
        kind = KINDS[i % len(KINDS)]
        if kind == "TOSCA":
            names = creatures[rng.choice([name for name, poses in creatures.items() if len(poses) > 1])]
        elif kind == "FAUST":
            who = rng.integers(PEOPLE)
            names = [f"tr_reg_{OF_EACH * who + k:03d}" for k in range(OF_EACH)]
        else:
            who = rng.choice(list(POSES))
            names = [f"{who}:{pose}" for pose in POSES[who]]
        one, other = rng.choice(names, 2, replace=False)
        share, number = float(rng.uniform(0.12, 0.6)), int(rng.integers(1 << 30))
        how = HOW[(i // len(KINDS) + i % len(KINDS)) % len(HOW)]
        direction, balls = rng.standard_normal(3), int(rng.integers(2, 13))
        found.append(Drawn(i, kind, str(one), str(other), how, share, number, direction, balls))
    return found


def part_of(mesh: Mesh, one: Drawn) -> Part:
    """What is left of a mesh."""
    if one.how == "plane":
        return cut(mesh, one.share, normal=one.direction)
    if one.how == "scan":
        return scan(mesh, one.direction)
    if one.how == "balls":
        return cut(mesh, min(one.share, MOST_OF_BALLS), count=one.balls, rng=one.seed)
    return cut(mesh, one.share, centre=int(np.random.default_rng(one.seed).choice(np.unique(mesh.faces))))


def made(one: Drawn) -> tuple[Part, Mesh, Known, Known]:
    """Part, whole, and the truth of the part's map and of the way back; `missing` is of the whole in both."""
    if one.kind == "built-in":
        sides = [side.split(":") for side in (one.part, one.whole)]
        posed, whole = (
            MAKERS[who](pose, n_vertices=VERTICES, seed=one.seed % 1000 + k) for k, (who, pose) in enumerate(sides)
        )
        part, points = part_of(posed, one), truth(whole, posed)
        rest = np.flatnonzero(~part.missing)
        gone = points.interpolate(part.missing.astype(np.float64)) > 0
        there = np.flatnonzero(~gone)
        onto = Known(np.arange(len(rest)), truth(posed, whole)[rest], np.flatnonzero(gone))
        return part, whole, onto, Known(there, carried(points[there], part.truth), np.flatnonzero(gone))
    folder = Path(os.environ["GMDS_DATA"]) / FOLDERS[one.kind]
    posed, whole = (read_mesh(folder / f"{name}.off") for name in (one.part, one.whole))
    here, theirs = (read_vts(folder / "corres" / f"{name}.vts") for name in (one.part, one.whole))
    part = part_of(posed, one)
    number, kept = np.cumsum(~part.missing) - 1, ~part.missing[here]
    onto = Known(number[here[kept]], theirs[kept], theirs[~kept])
    return part, whole, onto, Known(theirs[kept], number[here[kept]], theirs[~kept])


def row(one: Drawn, part: Part, whole: Mesh, known: tuple[Known, Known], back: bool) -> dict[str, Any]:
    """The part onto the whole, or the whole onto the part, matched and judged."""
    name = f"{one.number} {one.kind} {one.part}-{one.whole} {one.how} kept {(~part.missing).mean():.2f}"
    name += " back" if back else ""
    rng = np.random.default_rng([5, *name.encode()])
    meshes = (whole, part.mesh) if back else (part.mesh, whole)
    source, target = (turned(mesh, rng) for mesh in meshes)
    there, points, _ = known[back]
    if isinstance(points, SurfacePoints):
        points = SurfacePoints(target, points.face, points.barycentric)
    started = time.process_time()
    answer = gmds.match(source, target)
    seconds = time.process_time() - started
    judged = protocol_subset(len(there))
    error = geodesic_error(answer, points[judged], there[judged]).mean()
    on_whole = overlap_scores(answer.valid if back else answer.covered, known[1].there, known[1].missing)
    evidence = answer.meta.get("evidence", {})
    figures = [evidence.get("margin", np.nan), evidence.get("whole", {}).get("curvature", np.nan)]
    group = one.how + (" back" if back else "")
    cells = [name, group, code_version(), answer.status.name, f"{100 * error:.2f}", f"{on_whole.iou or 0:.3f}"]
    cells += [f"{seconds:.1f}", answer.meta.get("part", "-"), *(f"{value:.2f}" for value in figures)]
    return dict(zip(COLUMNS, cells, strict=True))


def page(rows: Sequence[dict[str, Any]], version: str) -> str:
    """Tables by how parts were made, of how honest the status is, and of the maps that are wrong."""
    groups = {how + back: [one for one in rows if one["group"] == how + back] for back in ("", " back") for how in HOW}
    cells = []
    for group, some in groups.items():
        errors, iou = (np.array([float(one[key]) for one in some]) for key in ("error", "iou"))
        if some:
            figures = [
                f"{value:.2f}" for value in (errors.mean(), np.median(errors), errors.max(), iou.mean(), iou.min())
            ]
            cells.append([group, len(some), *figures, f"{(errors > FAILED).sum()} of {len(some)}"])
    head = ["group", "pairs", "error x100", "median", "worst", "IoU", "least", f"above {FAILED}"]
    count = len({one["pair"].split()[0] for one in rows})
    command = "python -m benchmarks.accuracy.random_parts"
    about = f"`{command}` at {version}; {count} of the pairs drawn; see the script for the protocol."
    lines = ["# Parts drawn at random", "", about, ""]
    lines += [*table(head, cells), "## Status", "", *statuses({"all": rows})]
    worst = sorted(rows, key=lambda one: -float(one["error"]))
    doubtful = [one for one in worst if float(one["error"]) > 5 or float(one["iou"]) < 0.8]
    head = ["pair", "error x100", "IoU", "status"]
    told = [[one[key] for key in ("pair", "error", "iou", "status")] for one in doubtful]
    lines += ["## Above 5, or overlap below 0.8", "", *table(head, told)]
    return "\n".join(lines)


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=20)
    parser.add_argument("--seed", type=int, default=77001)
    parser.add_argument("--only", type=lambda text: [int(one) for one in text.split(",")], help="numbers of pairs")
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    path, version = options.output / "random_parts.csv", code_version()
    rows: dict[str, Any] = dict(read_rows(path, version))
    gmds.match(quadruped(n_vertices=600), quadruped(n_vertices=600))  # so that no pair pays for imports
    for one in drawn(options.pairs, options.seed):
        done = [name for name in rows if name.split()[0] == str(one.number)]
        if len(done) == 2 or (options.only is not None and one.number not in options.only):
            continue
        part, whole, *known = made(one)
        for back in (False, True):
            found = row(one, part, whole, (known[0], known[1]), back)
            rows[found["pair"]] = found
            write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in rows.values()])
            print(*found.values(), file=sys.stderr)
    text = page(list(rows.values()), version)
    (options.output / "random_parts.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
