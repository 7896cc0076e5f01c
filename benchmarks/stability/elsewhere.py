"""Whether another machine, other versions of what gmds is built on, or more threads give the same maps.

    GMDS_DATA=... python -m benchmarks.stability.elsewhere FILE.npz [--every K]     in each environment
    GMDS_DATA=... python -m benchmarks.stability.elsewhere --compare FIRST.npz OTHER.npz ...

The first form matches the pairs of `benchmarks.stability.perturbed` and keeps where the points of the protocol go; the
second writes results/elsewhere.md: how far each other file moves the images of the first, in root areas, and by how
much the mean error x100 differs. Threads are what NUMBA_NUM_THREADS and OMP_NUM_THREADS say.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from benchmarks.stability.perturbed import HEAD, figures, pairs
from geodesics import SurfacePoints, read_mesh
from gmds.benchmarking.pairs import Pair
from gmds.benchmarking.run import turned
from gmds.evaluation import geodesic_error, protocol_subset

PACKAGES = ("numpy", "scipy", "numba", "libigl", "trimesh")


def environment() -> str:
    """Python, versions, processors and threads, in a line."""
    versions = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    threads = os.environ.get("NUMBA_NUM_THREADS", str(os.cpu_count()))
    return f"Python {platform.python_version()}, {versions}; {platform.machine()}, {threads} threads"


def matched(pair: Pair) -> dict[str, Any]:
    """Where the points of the protocol go, and the mean error x100, of a pair turned as always."""
    rng = np.random.default_rng([0, *pair.name.encode()])
    source, target = turned(read_mesh(pair.source), rng), turned(read_mesh(pair.target), rng)
    vertices, truth, _ = pair.truth(source, target)
    chosen = protocol_subset(len(vertices))
    true = truth[chosen] if isinstance(truth, SurfacePoints) else SurfacePoints.at_vertices(target, truth[chosen])
    images = gmds.match(source, target).points[np.asarray(vertices)[chosen]]
    error = 100 * geodesic_error(images, true).mean()
    return {"face": images.face, "barycentric": images.barycentric, "error": error}


def keep(path: Path, every: int) -> None:
    """Match what the file does not have yet."""
    kept = dict(np.load(path)) if path.is_file() else {"environment": environment(), "code": code_version()}
    for name, pair in pairs(every):
        if f"{pair.name}/face" in kept:
            continue
        found = matched(pair)
        kept |= {f"{pair.name}/{key}": value for key, value in found.items()} | {f"{pair.name}/set": name}
        part = path.with_suffix(".part.npz")
        np.savez_compressed(part, **kept)
        os.replace(part, path)
        print(f"{name:16} {pair.name:40} {found['error']:6.2f}", file=sys.stderr, flush=True)


def moved(pair: Pair, first: dict[str, Any], other: dict[str, Any]) -> tuple[float, float]:
    """How far the images of the first file lie from those of the other, in the mean, and how much the error differs."""
    target = read_mesh(pair.target)
    here, there = (
        SurfacePoints(target, kept[f"{pair.name}/face"], kept[f"{pair.name}/barycentric"]) for kept in (first, other)
    )
    before, after = (float(kept[f"{pair.name}/error"]) for kept in (first, other))
    return float(geodesic_error(there, here).mean()), abs(after - before)


def page(paths: Sequence[Path]) -> str:
    """A table for each file but the first."""
    first, *others = (dict(np.load(path)) for path in paths)
    lines = ["# The same pair elsewhere", ""]
    lines += [f"`python -m benchmarks.stability.elsewhere` at {first['code']}; the script says how.", ""]
    lines += [f"First: {first['environment']}.", ""]
    for other in others:
        rows: dict[str, list[tuple[float, float]]] = {}
        for name, pair in pairs(1):
            if f"{pair.name}/face" in first and f"{pair.name}/face" in other:
                rows.setdefault(name, []).append(moved(pair, first, other))
        found = [figures(name, *np.array(values).T) for name, values in rows.items()]
        lines += [f"## {other['environment']}", "", *table(HEAD, found)]
    return "\n".join(lines)


def main() -> None:
    """Match, or compare."""
    parser = argparse.ArgumentParser(description="Whether maps are the same elsewhere.")
    parser.add_argument("files", type=Path, nargs="+", metavar="FILE.npz")
    parser.add_argument("--compare", action="store_true", help="what the files hold")
    parser.add_argument("--every", type=int, default=1, help="of the pairs, every so many")
    asked = parser.parse_args()
    if asked.compare:
        (RESULTS / "elsewhere.md").write_text(page(asked.files), encoding="utf-8")
        return
    for path in asked.files:
        keep(path, asked.every)


if __name__ == "__main__":
    main()
