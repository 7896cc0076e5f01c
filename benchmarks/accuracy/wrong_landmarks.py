"""What one wrong soft landmark, or two exchanged ones, do to a map, and whether they are named.

    GMDS_DATA=... python -m benchmarks.accuracy.wrong_landmarks

Built-in people and animals of seeds that nothing was chosen on, a third of them with a larger or smaller head, a third
with larger or smaller ears or hands, and whole animals of SHREC'20, the reporting half. One or six landmarks, farthest
points of the source: *right*; *wrong*, one of them where another such point belongs, 0.25 root areas off at the least;
*exchanged*, the first two swapped. Tolerance 0.05. The error is the geodesic one, mean x100, at 200 places. Writes
results/wrong_landmarks.csv as it goes; what is there already is kept.
"""

from __future__ import annotations

import argparse
import inspect
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.halves import PARTIAL, half_of, pairs_of
from benchmarks.accuracy.runs import ONE_THREAD, RESULTS, code_version
from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded, farthest_point_sampling, read_mesh
from geodesics.arrays import Integers
from gmds import SoftLandmarks, geodesic_error, match
from gmds.files.table import read_table, write_table
from gmds.shapes import humanoid, humanoid_poses, quadruped, quadruped_poses, truth

SEEDS = range(40, 46)  # those below 40 were looked at
SPREAD, FAR, TOLERANCE, PLACES = 9, 0.25, 0.05, 200  # points; root areas; root areas; judged. Set by hand
COUNTS = (1, 6)
COLUMNS = ("version", "pair", "landmarks", "error_x100", "status", "cpu_seconds", "wrong", "named", "notes")
Truth = tuple[Mesh, Mesh, Integers, SurfacePoints]
Case = tuple[Integers, SurfacePoints, list[int]]


def built_in(seed: int) -> Truth:
    """Two poses of a built-in shape, and where its vertices belong."""
    rng = np.random.default_rng(7000 + seed)
    make: Any
    make, poses = ((humanoid, humanoid_poses), (quadruped, quadruped_poses))[seed % 2]
    here, there = rng.choice(len(list(poses)), 2, replace=False)
    scale: dict[str, float] = {}
    if seed % 3 == 1:
        scale = {"head_scale": float(rng.choice([0.6, 1.5, 2.0]))}
    if seed % 3 == 2:
        parts = [
            name for name in ("ear_scale", "hand_scale", "leg_scale") if name in inspect.signature(make).parameters
        ]
        scale = {parts[0]: float(rng.choice([0.6, 1.7, 2.2]))}
    count = int(rng.choice([1000, 1500, 2200]))
    source = make(list(poses)[here], n_vertices=count, seed=seed)
    target = make(list(poses)[there], n_vertices=count, seed=seed + 100, **scale)
    return source, target, np.arange(source.n_vertices), truth(source, target)


def pair_of(name: str) -> Truth:
    """A pair by its name."""
    kind, rest = name.split(":")
    if kind == "builtin":
        return built_in(int(rest))
    pair = next(pair for pair in pairs_of(kind) if pair.name == rest)
    source, target = read_mesh(pair.source), read_mesh(pair.target)
    index, points, _ = pair.truth(source, target)
    return source, target, np.asarray(index), points


def cases(name: str, pair: Truth) -> dict[str, Case | None]:
    """What is given: vertices of the source, points of the target, and which rows are wrong."""
    source, target, index, there = pair
    seed, distance = sum(map(ord, name)), GeodesicDistance(embedded(source))
    first = int(np.random.default_rng(seed).integers(source.n_vertices))
    spread = farthest_point_sampling(distance, SPREAD + 1, first)[1:]
    near = [int(np.linalg.norm(source.vertices[index] - source.vertices[v], axis=1).argmin()) for v in spread]
    rng = np.random.default_rng(seed + 1)
    rows = rng.permutation(np.array(list(dict.fromkeys(near))))
    found: dict[str, Case | None] = {"none": None}
    for count in COUNTS:
        given, rest = rows[:count], rows[count:]
        found[f"{count}, right"] = index[given], there[given], []
        apart = np.linalg.norm(there[rest].positions[None] - there[given].positions[:, None], axis=2)
        row = int(rng.integers(count))
        far = np.flatnonzero(apart[row] > FAR * np.sqrt(target.area))
        if len(far):
            other = given.copy()
            other[row] = rest[int(rng.choice(far))]
            found[f"{count}, wrong"] = index[given], there[other], [row]
        if count > 1:
            found[f"{count}, exchanged"] = index[given], there[given[np.r_[1, 0, 2:count]]], [0, 1]
    return found


def judged(pair: Truth, case: Case | None) -> tuple[Any, ...]:
    """Error, status, seconds, what was wrong, what was named, and the codes of the notes."""
    source, target, index, there = pair
    given = None if case is None else SoftLandmarks((SurfacePoints.at_vertices(source, case[0]), case[1]), TOLERANCE)
    started = time.process_time()
    answer = match(source, target, landmarks=given, parts="neither")
    seconds = time.process_time() - started
    some = slice(None, None, max(1, len(index) // PLACES))
    error = 100 * geodesic_error(answer, there[some], index[some]).mean()
    named = [row for row, _ in answer.meta["evidence"].get("contradicted", [])]
    codes = " ".join(str(note)[:4] for note in answer.meta["notes"])
    wrong = "" if case is None else case[2]
    return f"{error:.2f}", answer.status.name, f"{seconds:.1f}", str(wrong), str(named), codes


def main() -> None:
    """Run what is missing, write as it goes."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    os.environ.update(ONE_THREAD)
    path, version = Path(RESULTS) / "wrong_landmarks.csv", code_version()
    kept = [tuple(row.values()) for row in read_table(path)] if path.exists() else []
    rows = [row for row in kept if row[0] == version]
    animals = [
        one.name for one in pairs_of("shrec20") if one.group != PARTIAL and one.name in half_of("shrec20", "reporting")
    ]
    for name in [*(f"builtin:{seed}" for seed in SEEDS), *(f"shrec20:{one}" for one in animals)]:
        pair = pair_of(name)
        for kind, case in cases(name, pair).items():
            if (name, kind) not in {row[1:3] for row in rows}:
                rows.append((version, name, kind, *judged(pair, case)))
                print(*rows[-1], file=sys.stderr, flush=True)
                write_table(path, COLUMNS, sorted(rows))


if __name__ == "__main__":
    main()
