"""What must not change an answer: renumbering, motion, size, mirroring, finer faces. By how much it does change it.

    python -m benchmarks.fuzzing.metamorphic --meshes 1000 --pairs 20

Distances and eigenvalues of generated surfaces, and maps of generated pairs, each measured again on a changed copy.
Deviations are relative: distances over the largest, images over the extent of the target, eigenvalues over themselves.
Writes results/metamorphic.md as it goes; exit code 1 when a deviation is above what is allowed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import generated_shapes as shapes
import numpy as np
from matched_shapes import permuted, reflected, shuffled
from numpy.typing import NDArray

import gmds
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import GeodesicDistance, Mesh, SurfacePoints, eigenpairs, embedded, scale_invariant

SOURCES, EIGENVALUES = 5, 12  # of each mesh; set by hand
REFINED = "every face in four"
ROUNDING, FINER_DISTANCES, FINER_SPECTRUM = 1e-6, 0.03, 1 / 12  # relative deviations allowed; the page says why


class Copy(NamedTuple):
    """A changed mesh, and the new index (n,) of each old vertex."""

    mesh: Mesh
    place: NDArray[np.int64]


def same(mesh: Mesh, old: Mesh) -> Copy:
    """Vertices are where they were."""
    return Copy(mesh, np.arange(old.n_vertices))


CHANGES: dict[str, Callable[[Mesh, int], Copy]] = {
    "vertices renumbered": lambda m, i: Copy(*permuted(m, i)),
    "faces renumbered, corners turned round": lambda m, i: same(shuffled(m, i), m),
    "turned and moved": lambda m, i: same(shapes.moved(m, seed=i), m),
    "scaled by 1e-6": lambda m, i: same(shapes.moved(m, 1e-6, seed=None), m),
    "scaled by 1e6": lambda m, i: same(shapes.moved(m, 1e6, seed=None), m),
    "scaled by 1e-12": lambda m, i: same(shapes.moved(m, 1e-12, seed=None), m),
    "scaled by 1e12": lambda m, i: same(shapes.moved(m, 1e12, seed=None), m),
    "mirrored": lambda m, i: same(reflected(m), m),
    "faces turned over": lambda m, i: same(Mesh(m.vertices, m.faces[:, ::-1]), m),
    REFINED: lambda m, i: same(shapes.subdivided(m), m),
}
NO_MAPS = (REFINED, "mirrored")  # other samples; another map


@dataclass
class Worst:
    """The largest deviation of all, of which mesh or pair, and the largest as a share of what is allowed."""

    deviation: float = 0.0
    which: int = -1
    share: float = 0.0

    def seen(self, which: int, deviations: NDArray[np.float64], allowed: Any) -> None:
        """Take note of the deviations of a mesh; one that is not a number is worse than any."""
        deviations = np.where(np.isnan(deviations), np.inf, np.abs(deviations))
        self.share = max(self.share, float((deviations / allowed).max()))
        if self.which < 0 or deviations.max() > self.deviation:
            self.deviation, self.which = float(deviations.max()), which


Found = dict[str, Worst]


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
    values = eigenpairs(scale_invariant(mesh), EIGENVALUES).eigenvalues
    return GeodesicDistance(embedded(mesh)).field(points), values[1:]


def measure(i: int, distances: Found, eigenvalues: Found) -> None:
    """The i-th mesh and its copies."""
    mesh = generated(i)
    sources = np.random.default_rng(i).choice(mesh.n_vertices, SOURCES, replace=False)
    before, values = measured(mesh, sources)
    coarseness = values * scale_invariant(mesh).l_sq.max()  # lambda h^2
    for name, change in CHANGES.items():
        copy = change(mesh, i)
        after, others = measured(copy.mesh, copy.place[sources])
        size = np.ptp(mesh.vertices) / np.ptp(copy.mesh.vertices[copy.place]) if "scaled" in name else 1
        off = (after[:, copy.place] * size - before) / before.max()
        distances[name].seen(i, off, FINER_DISTANCES if name == REFINED else ROUNDING)
        eigenvalues[name].seen(i, others / values - 1, FINER_SPECTRUM * coarseness if name == REFINED else ROUNDING)


def match(i: int, images: Found) -> None:
    """The i-th pair, and the copies of its source: images over the extent of the target."""
    source = shapes.bumpy_sphere(2, seed=i)
    target = gmds.deformations.remeshing(source, 150, rng=i)[0]
    before = gmds.match(source, target, n_samples=60).points.positions
    for name, change in CHANGES.items():
        if name not in NO_MAPS:
            copy = change(source, i)
            after = gmds.match(copy.mesh, target, n_samples=60).points.positions[copy.place]
            images[name].seen(i, (after - before) / np.ptp(target.vertices), ROUNDING)


def page(meshes: int, pairs: int, found: Sequence[Found]) -> str:
    """The table."""
    lines = ["# What must not change an answer", "", "`python -m benchmarks.fuzzing.metamorphic --meshes "]
    lines[-1] += f"{meshes} --pairs {pairs}`: largest relative deviations, and of which mesh or pair."
    lines += [f"Allowed is rounding, {ROUNDING:.0e}. Finer faces: {FINER_DISTANCES} for distances, and for eigenvalues"]
    lines += ["lambda h^2 / 12, h the longest edge: what linear elements with a lumped mass are off by where faces are"]
    lines += ["coarse; when h is halved three quarters of it go.", ""]
    rows: list[Sequence[object]] = []
    for name in CHANGES:
        cells: list[object] = [name]
        for column in found:
            worst = column[name]
            cells.append("-" if worst.which < 0 else f"{worst.deviation:.1e} ({worst.which})")
        most = max(column[name].share for column in found)
        rows.append([*cells, f"{most:.0%}" if most >= 0.005 else "0"])
    head = ["change", f"distances, {meshes} meshes", "eigenvalues", f"images, {pairs} pairs", "of what is allowed"]
    return "\n".join([*lines, *table(head, rows)])


def main() -> int:
    """Run, write as it goes, judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", type=int, default=1000)
    parser.add_argument("--pairs", type=int, default=20)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    found: list[Found] = [{name: Worst() for name in CHANGES} for _ in range(3)]
    done = [0, 0]

    def tell() -> None:
        (options.output / "metamorphic.md").write_text(page(*done, found), encoding="utf-8")
        print(f"{done[0]} meshes, {done[1]} pairs", file=sys.stderr)

    for i in range(options.meshes):
        measure(i, found[0], found[1])
        done[0] = i + 1
        if done[0] % 50 == 0:
            tell()
    for i in range(options.pairs):
        match(i, found[2])
        done[1] = i + 1
        tell()
    tell()
    print(page(*done, found))
    return 1 if any(worst.share > 1 for column in found for worst in column.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
