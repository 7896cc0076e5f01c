"""How well |K| survives remeshing and local scale: the choice behind the default of `gaussian_curvature`.

    GMDS_DATA=... python -m benchmarks.stability.curvature_stability

Needs the `repair` extra. Hyper-parameters were chosen on the first half of the shapes; the table gives both halves.
Writes benchmarks/results/curvature_stability.md.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.places import RESULTS
from geodesics import DiffusionDistance, Mesh, Metric, SurfacePoints, eigenpairs, read_mesh
from geodesics.curvature import angle_defect, gaussian_curvature, smoothed_density
from geodesics.delaunay import intrinsic_delaunay
from geodesics.metric import conformal
from geodesics.metrics._regularised import regularised
from geodesics.one_ring import one_ring_curvature
from geodesics.repair.remeshing import remesh
from geodesics.smoothing import DEFAULT_SMOOTHING, FIRST_LOOK
from geodesics.topology.components import boundary_vertices

Array = NDArray[np.float64]
Estimator = Callable[[Mesh], Array]
DATA = Path(os.environ.get("GMDS_DATA", "."))
RESULT = RESULTS / "curvature_stability.md"
CHOSEN_ON = ("tosca_5k/cat0", "tosca_5k/centaur0", "tosca_5k/horse6", "tosca_5k/michael5", "faust_5k/tr_reg_000",
             "faust_5k/tr_reg_035")  # fmt: skip
KEPT_APART = ("tosca_5k/cat5", "tosca_5k/centaur3", "tosca_5k/horse0", "tosca_5k/michael0", "faust_5k/tr_reg_025",
              "faust_5k/tr_reg_045")  # fmt: skip


def fixed_time(smoothing: float) -> Estimator:
    """One implicit heat step of the same time everywhere, `smoothing` times the area of the surface."""

    def curvature(mesh: Mesh) -> Array:
        triangulation, interior = intrinsic_delaunay(mesh), ~boundary_vertices(mesh)
        time = np.full(len(triangulation.faces), smoothing * _area(mesh))
        return smoothed_density(triangulation, np.where(interior, angle_defect(mesh), 0.0), interior, time)

    return curvature


ESTIMATORS: dict[str, Estimator | None] = {
    "regular metric (control)": None,
    "to the letter, (4.5)": one_ring_curvature,
    "fixed time 1e-4": fixed_time(1e-4),
    "fixed time 3e-4": fixed_time(3e-4),
    "fixed time 1e-3": fixed_time(1e-3),
    "fixed time 3e-3": fixed_time(3e-3),
    "local time 1e-3": lambda mesh: gaussian_curvature(mesh, 1e-3),
    "local time 2e-3": lambda mesh: gaussian_curvature(mesh, 2e-3),
    f"**local time {DEFAULT_SMOOTHING:g} (default)**": gaussian_curvature,
    "local time 8e-3": lambda mesh: gaussian_curvature(mesh, 8e-3),
    "local time 1.6e-2": lambda mesh: gaussian_curvature(mesh, 1.6e-2),
}


def metric_of(mesh: Mesh, estimator: Estimator | None) -> Metric:
    """sqrt(K^2 + eps^2) g with the default eps, or g."""
    return conformal(mesh, np.ones(mesh.n_vertices) if estimator is None else regularised(mesh, estimator(mesh), 1.0))


def remeshing_change(meshes: list[Mesh], estimator: Estimator | None) -> float:
    """Mean relative change of the first 20 eigenvalues over all pairs of triangulations of one surface."""
    values = [eigenpairs(metric_of(mesh, estimator), 21).eigenvalues[1:] for mesh in meshes]
    return float(np.mean([abs(a / b - 1).mean() for a, b in combinations(values, 2)]))


def local_scale_change(source: Mesh, target: Mesh, truth: dict[str, Array], estimator: Estimator | None) -> Array:
    """Change of eigenvalues, of diffusion distances, and of |K| dA at true pairs: at all, and in the scaled part."""
    if estimator is None:  # the control is not to suffer from the unit of length
        source, target = (Mesh(mesh.vertices / np.sqrt(_area(mesh)), mesh.faces) for mesh in (source, target))
    a, b = (metric_of(mesh, estimator) for mesh in (source, target))
    here, there = eigenpairs(a, 100), eigenpairs(b, 100)
    eigen = abs(there.eigenvalues[1:21] / here.eigenvalues[1:21] - 1)
    size_here, size_there = np.sqrt(a.mass.sum()), np.sqrt(b.mass.sum())  # distances have the unit 1 / length
    src, gt = truth["src"][::4], truth["gt"][::4]
    d_here = DiffusionDistance(here, 0.003).field(SurfacePoints.at_vertices(source, src))[:, src] * size_here
    d_there = DiffusionDistance(there, 0.003).field(SurfacePoints.at_vertices(target, gt))[:, gt] * size_there
    scale = stretch(source.vertices[truth["src"]], target.vertices[truth["gt"]])
    assert a.conformal_factor is not None and b.conformal_factor is not None
    log = np.log(b.conformal_factor[truth["gt"]] * scale**2 / a.conformal_factor[truth["src"]])
    part = truth["part"]
    return np.array(
        [
            np.mean(eigen),
            np.sqrt(np.mean((d_here - d_there) ** 2) / np.mean(d_here**2)),
            np.median(np.abs(log)),
            np.median(np.abs(log[part])),
        ]
    )


def stretch(here: Array, there: Array) -> Array:
    """Local scale (p,) from the distances to the eight nearest other true points."""
    d_here, d_there = (np.linalg.norm(x[:, None] - x, axis=2) for x in (here, there))
    near = np.argsort(d_here, axis=1)[:, 1:9]
    rows = np.arange(len(here))[:, None]
    return np.clip(np.median(d_there[rows, near] / np.maximum(d_here[rows, near], 1e-12), axis=1), 0.3, 4)


def triangulations(name: str) -> list[Mesh]:
    """The published mesh, and two isotropic remeshings of it."""
    mesh = read_mesh(DATA / f"{name}.off")
    return [mesh, remesh(mesh, 5000), remesh(mesh, 8000)]


def rows(surfaces: list[list[Mesh]], pairs: list[tuple[Mesh, Mesh, dict[str, Array]]]) -> Iterator[tuple[str, Array]]:
    """One row an estimator: name, remeshing change (mean, worst), and the four numbers of local scale."""
    for name, estimator in ESTIMATORS.items():
        again = [remeshing_change(meshes, estimator) for meshes in surfaces]
        scaled = np.mean([local_scale_change(*pair, estimator) for pair in pairs], axis=0)
        yield name, np.array([np.mean(again), np.max(again), *scaled])


def table(names: tuple[str, ...], pairs: list[dict[str, str]]) -> str:
    """The rows as Markdown."""
    surfaces = [triangulations(name) for name in names]
    loaded = [
        (read_mesh(DATA / p["source"]), read_mesh(DATA / p["target"]), dict(np.load(DATA / p["truth"]))) for p in pairs
    ]
    head = ["estimator of K", "remeshed: eigenvalues, mean", "worst shape", "locally scaled: eigenvalues",
            "diffusion distances", "\\|log\\| of \\|K\\| dA", "the same in the scaled part"]  # fmt: skip
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for name, numbers in rows(surfaces, loaded):
        cells = [name, *(f"{x:.4f}" for x in numbers[:2]), *(f"{x:.3f}" for x in numbers[2:])]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    """Both halves to the results file."""
    pairs = json.loads((DATA / "scaled" / "pairs.json").read_text())
    text = f"""# Curvature under remeshing and local scale

`python -m benchmarks.stability.curvature_stability`. Mean relative change of the first 20 eigenvalues of the
scale-invariant Laplacian (eps = 4 pi / area) when the same surface is remeshed (published mesh, isotropic 5,000 and
8,000 vertices).
On pairs with parts scaled and remeshed: change of eigenvalues, of diffusion distances (time 0.003, rms) and of |K| dA
at 500 true pairs (median). "Fixed time": one implicit heat step of that share of the area. "Local time": that share of
the area of the sphere of the same curvature, from a look at K with fixed time {FIRST_LOOK:g}.

Shapes on which the constants were chosen:

{table(CHOSEN_ON, pairs[::2])}

Shapes kept apart:

{table(KEPT_APART, pairs[1::2])}
"""
    RESULT.parent.mkdir(exist_ok=True)
    RESULT.write_text(text)


def _area(mesh: Mesh) -> float:
    return float(conformal(mesh, np.ones(mesh.n_vertices)).mass.sum())


if __name__ == "__main__":
    main()
