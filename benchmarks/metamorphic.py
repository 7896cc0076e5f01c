"""What must not change an answer: renumbering, motion, size, mirroring, finer faces. By how much it does change it.

    python benchmarks/metamorphic.py --meshes 1000 --pairs 20

Distances and eigenvalues of generated surfaces, and maps of generated pairs, each measured again on a changed copy.
Deviations are relative: distances and images over the largest, eigenvalues over themselves. Writes
results/metamorphic.md; exit code 1 when a deviation is above what is allowed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from markdown import table
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

import shapes
from matched import permuted, reflected, shuffled

import gmds
from geodesics import GeodesicDistance, Mesh, SurfacePoints, eigenpairs, embedded, scale_invariant

RESULTS = Path(__file__).resolve().parent / "results"
SOURCES, EIGENVALUES = 5, 12
ROUNDING, REFINED = 1e-6, 0.03


class Copy(NamedTuple):
    """A changed mesh, and the new index (n,) of each old vertex."""

    mesh: Mesh
    place: NDArray[np.int64]


def same(mesh: Mesh, old: Mesh) -> Copy:
    """Vertices are where they were."""
    return Copy(mesh, np.arange(old.n_vertices))


CHANGES: dict[str, tuple[Callable[[Mesh, int], Copy], float]] = {
    "vertices renumbered": (lambda m, i: Copy(*permuted(m, i)), ROUNDING),
    "faces renumbered, corners turned round": (lambda m, i: same(shuffled(m, i), m), ROUNDING),
    "turned and moved": (lambda m, i: same(shapes.moved(m, seed=i), m), ROUNDING),
    "scaled by 1e-6": (lambda m, i: same(shapes.moved(m, 1e-6, seed=None), m), ROUNDING),
    "scaled by 1e6": (lambda m, i: same(shapes.moved(m, 1e6, seed=None), m), ROUNDING),
    "scaled by 1e-12": (lambda m, i: same(shapes.moved(m, 1e-12, seed=None), m), ROUNDING),
    "scaled by 1e12": (lambda m, i: same(shapes.moved(m, 1e12, seed=None), m), ROUNDING),
    "mirrored": (lambda m, i: same(reflected(m), m), ROUNDING),
    "faces turned over": (lambda m, i: same(Mesh(m.vertices, m.faces[:, ::-1]), m), ROUNDING),
    "every face in four": (lambda m, i: same(shapes.subdivided(m), m), REFINED),
}


def generated(i: int) -> Mesh:
    """The i-th surface: closed or open, of genus 0 or 1, with bumps."""
    match i % 4:
        case 0:
            return shapes.bumpy_sphere(2, seed=i)
        case 1:
            return shapes.jittered(shapes.torus(18, 10), 0.05, seed=i)
        case 2:
            return shapes.jittered(shapes.disc(6), 0.05, seed=i)
        case _:
            return shapes.jittered(shapes.cylinder(18, 8), 0.05, seed=i)


def measured(mesh: Mesh, sources: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (s, n) in the metric of space and eigenvalues (k,) of the scale-invariant one."""
    points = SurfacePoints.at_vertices(mesh, sources)
    return GeodesicDistance(embedded(mesh)).field(points), eigenpairs(scale_invariant(mesh), EIGENVALUES).eigenvalues[
        1:
    ]


def of_distances(count: int) -> dict[str, tuple[float, float]]:
    """Largest deviation of distances and of eigenvalues, by change."""
    worst = dict.fromkeys(CHANGES, (0.0, 0.0))
    for i in range(count):
        mesh = generated(i)
        sources = np.random.default_rng(i).choice(mesh.n_vertices, SOURCES, replace=False)
        before, values = measured(mesh, sources)
        for name, (change, _) in CHANGES.items():
            copy = change(mesh, i)
            after, others = measured(copy.mesh, copy.place[sources])
            after = after[:, copy.place] * (
                np.ptp(mesh.vertices) / np.ptp(copy.mesh.vertices[copy.place]) if "scaled" in name else 1
            )
            off = np.abs(after - before).max() / before.max()
            worst[name] = max(worst[name][0], float(off)), max(worst[name][1], float(np.abs(others / values - 1).max()))
    return worst


def of_maps(count: int) -> dict[str, float]:
    """Largest distance of an image from where it was, over the extent of the target, by change of the source."""
    worst = dict.fromkeys(CHANGES, 0.0)
    for i in range(count):
        source = shapes.bumpy_sphere(2, seed=i)
        target = gmds.deformations.remeshing(source, 150, rng=i)[0]
        before = gmds.match(source, target, n_samples=60).points.positions
        for name, (change, _) in CHANGES.items():
            if name == "every face in four" or name == "mirrored":
                continue  # other samples; another map
            copy = change(source, i)
            after = gmds.match(copy.mesh, target, n_samples=60).points.positions[copy.place]
            worst[name] = max(worst[name], float(np.abs(after - before).max() / np.ptp(target.vertices)))
    return worst


def page(meshes: int, pairs: int, found: dict[str, tuple[float, float]], maps: dict[str, float]) -> str:
    """The table."""
    lines = ["# What must not change an answer", ""]
    lines += [f"`python benchmarks/metamorphic.py --meshes {meshes} --pairs {pairs}`: largest relative deviations.", ""]
    rows: list[Sequence[object]] = []
    for name, (_, allowed) in CHANGES.items():
        of_map = "-" if name in ("every face in four", "mirrored") or not pairs else f"{maps[name]:.1e}"
        rows.append([name, *(f"{value:.1e}" for value in found[name]), of_map, f"{allowed:.0e}"])
    head = ["change", f"distances, {meshes} meshes", "eigenvalues", f"images, {pairs} pairs", "allowed"]
    return "\n".join([*lines, *table(head, rows)])


def main() -> int:
    """Run, write, judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", type=int, default=1000)
    parser.add_argument("--pairs", type=int, default=20)
    options = parser.parse_args()
    found, maps = of_distances(options.meshes), of_maps(options.pairs)
    text = page(options.meshes, options.pairs, found, maps)
    (RESULTS / "metamorphic.md").write_text(text, encoding="utf-8")
    print(text)
    bad = [name for name, (_, allowed) in CHANGES.items() if max(found[name][0], maps[name]) > allowed]
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
