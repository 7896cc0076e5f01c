"""Growth of maps against the true field: built-in shapes with parts scaled, and the locally scaled pairs.

    GMDS_DATA=... python -m benchmarks.study.growth MAPS [--half development|reporting]

Defaults of `match` only. Built-in pairs: the source in the pose and with the scales of the target is a mesh with the
same faces, so the true field is half the logarithm of the growth of the area around each vertex
(`achieved_log_scale`), raw and as smooth as the estimate. Locally scaled pairs know where 500 vertices go: their field
is the mean logarithm of the growth of the distance to the 20 nearest of the others, on the surfaces, and so is what the
map says in its place. The smoothing was chosen on the development half of the built-in pairs, the figures are of the
others. MAPS is a folder that keeps maps from run to run. Writes results/growth.csv and results/growth.md.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import spearmanr

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded, read_mesh
from geodesics.arrays import Floats, Integers
from gmds.benchmarking.datasets import dataset_pairs
from gmds.deformations import achieved_log_scale
from gmds.files.table import write_table
from gmds.maps.growth import SMOOTHING, growth_between, growth_of
from gmds.shapes.humanoid import BODY as PERSON
from gmds.shapes.humanoid import POSES as PERSON_POSES
from gmds.shapes.humanoid import humanoid
from gmds.shapes.quadruped import BODY as ANIMAL
from gmds.shapes.quadruped import POSES as ANIMAL_POSES
from gmds.shapes.quadruped import quadruped
from gmds.shapes.skeleton import scaled

N = 2500  # vertices of a built-in shape
NEIGHBOURS = 20  # of a sample, to which distances are compared: nearer ones are off by half an edge
CHANGED = 0.05  # log length, from which on a part has changed: below it order is that of rounding and bending
SMOOTHINGS = (1e-4, 3e-4, 1e-3, 3e-3)
ANIMAL_SCALES = {"head_scale": "head", "ear_scale": "ear_", "leg_scale": ("shoulder_", "hip_"), "tail_scale": "tail"}
BUILT_IN: dict[str, list[tuple[str, str, dict[str, float]]]] = {
    "development": [
        ("animal", "walk", {"head_scale": 1.6}),
        ("animal", "graze", {"leg_scale": 0.7, "ear_scale": 1.5}),
        ("animal", "turn", {"tail_scale": 1.8, "head_scale": 0.8}),
    ],
    "reporting": [
        ("animal", "walk", {"leg_scale": 1.3, "ear_scale": 1.8}),
        ("animal", "graze", {"head_scale": 1.5, "tail_scale": 0.6}),
        ("animal", "turn", {"leg_scale": 0.75, "head_scale": 1.3, "ear_scale": 0.7}),
        ("person", "", {"head_scale": 1.5}),
    ],
}
"""Kind, pose and scales of the targets; the sources are the same bodies as they stand."""


class Case(NamedTuple):
    """A pair: `after` is the source as it becomes, of built-in shapes; else `known` vertices and `places` of these."""

    name: str
    kind: str
    source: Mesh
    target: Mesh
    after: Mesh | None = None
    known: Integers | None = None
    places: SurfacePoints | None = None


def built_in(half: str) -> Iterator[Case]:
    """The built-in pairs of one half."""
    for number, (what, pose, scales) in enumerate(BUILT_IN[half]):
        make, body, poses = (quadruped, ANIMAL, ANIMAL_POSES) if what == "animal" else (humanoid, PERSON, PERSON_POSES)
        pose = pose or next(name for name in poses if poses[name])
        source, target = make(n_vertices=N), make(pose, n_vertices=N, seed=number + 1, **scales)
        branches: dict[str, float] = {}
        for name, factor in scales.items():
            for branch in np.atleast_1d(ANIMAL_SCALES[name]).tolist():
                branches[branch] = factor
        after = Mesh(body.pose(source.rest, scaled(poses, pose, branches)), source.faces)
        words = " ".join(f"{name.removesuffix('_scale')} {factor:g}" for name, factor in scales.items())
        yield Case(f"{what} {pose}: {words}", "built-in", source, target, after)


def published() -> Iterator[Case]:
    """The locally scaled pairs."""
    for pair in dataset_pairs(Path(os.environ["GMDS_DATA"]) / "scaled"):
        source, target = read_mesh(pair.source), read_mesh(pair.target)
        known, places, _ = pair.truth(source, target)
        yield Case(pair.name, "scaled", source, target, known=known, places=places)


def matched(case: Case, folder: Path) -> gmds.Correspondence:
    """The map, from the folder if it is there."""
    path = folder / f"{case.name.replace(' ', '_').replace(':', '')}.npz"
    if path.exists():
        return gmds.Correspondence.load(path, case.source, case.target)
    answer = gmds.match(case.source, case.target)
    answer.save(path)
    return answer


def of_samples(source: Mesh, target: Mesh, known: Integers, places: SurfacePoints) -> Floats:
    """The mean logarithm (k,) of the growth of the distances from each known vertex to the nearest of the others."""
    here = GeodesicDistance(embedded(source)).field(SurfacePoints.at_vertices(source, known))[:, known]
    field = GeodesicDistance(embedded(target)).field(places)
    there = np.stack([places.interpolate(row) for row in field])
    here, there = (here + here.T) / 2, (there + there.T) / 2
    near = np.argsort(here, axis=1)[:, 1 : NEIGHBOURS + 1]
    rows = np.arange(len(known))[:, None]
    return np.log(np.maximum(there[rows, near], 1e-9) / here[rows, near]).mean(axis=1)


def figures(case: Case, answer: gmds.Correspondence, smoothing: float) -> dict[str, Any]:
    """How near the growth of a map comes to the truth."""
    found = growth_of(answer, smoothing).length
    if case.after is not None:
        raw, smooth = achieved_log_scale(case.source, case.after), growth_between(case.source, case.after, smoothing)
        return {**compared(found, raw), **{f"{k}_smooth": v for k, v in compared(found, smooth.length).items()}}
    assert case.known is not None and case.places is not None
    truth = of_samples(case.source, case.target, case.known, case.places)
    mapped = of_samples(case.source, case.target, case.known, answer.points[case.known])
    vertex = compared(found[case.known], truth)
    return {**vertex, **{f"{k}_smooth": v for k, v in compared(mapped, truth).items()}}


def compared(found: Floats, truth: Floats) -> dict[str, float]:
    """Correlations and median absolute error where something was found; `changed`: where the truth is beyond 0.05."""
    there = np.isfinite(found) & np.isfinite(truth)
    x, y = found[there], truth[there]
    error = np.abs(x - y)
    far = np.abs(y) > CHANGED
    ranks = {"rank": float(spearmanr(x, y)[0]), "rank_changed": float(spearmanr(x[far], y[far])[0])}
    return {**ranks, "correlation": float(np.corrcoef(x, y)[0, 1]), "error": float(np.median(error))}


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("maps", type=Path)
    parser.add_argument("--half", choices=["development", "reporting"], default="reporting")
    given = parser.parse_args()
    given.maps.mkdir(parents=True, exist_ok=True)
    cases = [*built_in(given.half), *(published() if given.half == "reporting" else ())]
    rows = []
    for case in cases:
        started = time.process_time()
        answer = matched(case, given.maps)
        spent = time.process_time() - started
        for smoothing in SMOOTHINGS if given.half == "development" else (SMOOTHING,):
            row = {"pair": case.name, "kind": case.kind, "smoothing": smoothing, "status": answer.status.name}
            rows.append({**row, **figures(case, answer, smoothing)})
            print(rows[-1], f"{spent:.1f} CPU s", flush=True)
    name = "growth" if given.half == "reporting" else "growth_development"
    write_table(RESULTS / f"{name}.csv", list(rows[0]), ([*row.values()] for row in rows), digits=4)
    if given.half == "reporting":
        (RESULTS / "growth.md").write_text(page(rows), encoding="utf-8")


def page(rows: list[dict[str, Any]]) -> str:
    """The table of the reporting half, with medians by kind."""
    head = ["pair", "kind", "status", "rank correlation", "where changed", "correlation", "median error of log length"]
    head += ["smoothed truth: rank", "where changed", "correlation", "median error"]
    keys = [f"{name}{of}" for of in ("", "_smooth") for name in ("rank", "rank_changed", "correlation", "error")]
    cells = [[r["pair"], r["kind"], r["status"], *(f"{r[key]:.3f}" for key in keys)] for r in rows]
    for kind in dict.fromkeys(row["kind"] for row in rows):
        of_kind = [row for row in rows if row["kind"] == kind]
        cells.append([f"**median, {kind}**", kind, "", *(f"{np.median([r[k] for r in of_kind]):.3f}" for k in keys)])
    told = f"`python -m benchmarks.study.growth MAPS` at {code_version()}; see the script for the protocol."
    limits = (
        "Where a shape is the same but for one part, the field is mostly rounding and bending, whose order no map "
        "can tell; *where changed* is the rank correlation where the truth is beyond 0.05. The truth of the locally "
        "scaled pairs is to the nearest of some 5,000 vertices, so that their field is off by about 0.03 itself."
    )
    return "\n".join(["# Growth", "", told, limits, "", *table(head, cells)])


if __name__ == "__main__":
    main()
