"""One measurement in a process of its own, as a line of JSON: python -m benchmarks.scale.tasks TASK MESH

Times are CPU seconds after a warm-up on a small mesh; `wall` where two threads work; `peak` is the process's, in MB.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

import geodesics
import gmds
from benchmarks.memory import peak_megabytes
from benchmarks.scale.meshes import load
from geodesics import GeodesicDistance, Mesh, SurfacePoints
from geodesics.sampling import farthest_point_cells
from gmds.shapes import quadruped

Result = dict[str, float]
SOURCES, MANY, SAMPLES, EIGENPAIRS = 5, 50, 1000, 200  # a convention: what the goals of scale.py are stated for


def timed(action: Callable[[], Any]) -> tuple[float, float, Any]:
    """CPU seconds, wall seconds and result of an action."""
    cpu, wall = time.process_time(), time.perf_counter()
    result = action()
    return time.process_time() - cpu, time.perf_counter() - wall, result


def sources(mesh: Mesh, count: int) -> Any:
    """The same vertices for all methods."""
    return np.random.default_rng(0).choice(mesh.n_vertices, count, replace=False)


def _each(prepare: Callable[[], Callable[[int], Any]], mesh: Mesh) -> Result:
    setup, _, field = timed(prepare)
    chosen = [int(v) for v in sources(mesh, SOURCES + 1)]
    first, *others = [timed(lambda v=v: field(v))[0] for v in chosen]
    return {"cpu": statistics.median(others), "setup": setup + max(0.0, first - statistics.median(others))}


def marching(mesh: Mesh) -> Result:
    """Ours, one source."""
    distance = GeodesicDistance(geodesics.embedded(mesh), threads=1)
    return _each(lambda: lambda v: distance.field(SurfacePoints.at_vertices(mesh, [v])), mesh)


def marching_potpourri3d(mesh: Mesh) -> Result:
    """geometry-central's fast marching."""
    import potpourri3d

    def prepare() -> Callable[[int], Any]:
        solver = potpourri3d.MeshFastMarchingDistanceSolver(mesh.vertices, mesh.faces)
        return lambda v: solver.compute_distance([[(v, [])]])

    return _each(prepare, mesh)


def heat_potpourri3d(mesh: Mesh) -> Result:
    """geometry-central's heat method on the intrinsic Delaunay triangulation."""
    import potpourri3d

    def prepare() -> Callable[[int], Any]:
        return potpourri3d.MeshHeatMethodDistanceSolver(mesh.vertices, mesh.faces).compute_distance  # type: ignore

    return _each(prepare, mesh)


def heat_igl(mesh: Mesh) -> Result:
    """libigl's heat method."""
    import igl

    def prepare() -> Callable[[int], Any]:
        data = igl.HeatGeodesicsData()
        igl.heat_geodesics_precompute(
            mesh.vertices, mesh.faces, igl.avg_edge_length(mesh.vertices, mesh.faces) ** 2, data
        )
        return lambda v: igl.heat_geodesics_solve(data, np.array([v]))

    return _each(prepare, mesh)


def front_pymeshlab(mesh: Mesh) -> Result:
    """VCG's front propagation."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    march = meshes.compute_scalar_by_geodesic_distance_from_given_point_per_vertex
    return _each(lambda: lambda v: march(startpoint=mesh.vertices[v]), mesh)


def many_sources(mesh: Mesh) -> Result:
    """Ours, all sources on both cores."""
    distance = GeodesicDistance(geodesics.embedded(mesh), threads=2)
    setup = timed(lambda: distance.field(SurfacePoints.at_vertices(mesh, [0])))[0]
    points = SurfacePoints.at_vertices(mesh, sources(mesh, MANY))
    cpu, wall, _ = timed(lambda: distance.field(points))
    return {"cpu": cpu, "wall": wall, "setup": setup}


def sampling(mesh: Mesh) -> Result:
    """Ours, farthest points and their Voronoi labels; `marches` is the cost in single-source marches."""
    distance = GeodesicDistance(geodesics.embedded(mesh), threads=1)
    one = statistics.median(
        [timed(lambda v=v: distance.field(SurfacePoints.at_vertices(mesh, [v])))[0] for v in sources(mesh, 6)][1:]
    )
    cpu, _, _ = timed(lambda: farthest_point_cells(distance, min(SAMPLES, mesh.n_vertices // 4)))
    return {"cpu": cpu, "marches": cpu / one}


def _residual(metric: geodesics.Metric, values: Any, functions: Any) -> float:
    stiffness, used = geodesics.stiffness(metric), metric.mass > 0
    rest = (stiffness @ functions - metric.mass[:, None] * functions * values)[used]
    size = np.linalg.norm(rest / np.sqrt(metric.mass[used])[:, None], axis=0)
    return float((size / np.maximum(values, 1 / metric.mass.sum())).max())


def _eigenpairs(mesh: Mesh, **settings: Any) -> Result:
    setup, _, metric = timed(lambda: geodesics.scale_invariant(mesh))
    cpu, _, spectrum = timed(lambda: geodesics.eigenpairs(metric, EIGENPAIRS, **settings))
    return {"cpu": cpu, "setup": setup, "residual": _residual(metric, spectrum.eigenvalues, spectrum.eigenfunctions)}


def eigenpairs(mesh: Mesh) -> Result:
    """Ours, as `eigenpairs` does it unless told otherwise."""
    return _eigenpairs(mesh)


def eigenpairs_exact(mesh: Mesh) -> Result:
    """Ours, with residuals of 1e-10."""
    return _eigenpairs(mesh, tolerance=1e-10)


def eigenpairs_scipy(mesh: Mesh) -> Result:
    """eigsh in shift-invert mode, its own factorisation (SuperLU)."""
    metric = geodesics.scale_invariant(mesh)
    a, b, start = (
        geodesics.stiffness(metric).tocsc(),
        metric.mass,
        np.random.default_rng(0).standard_normal(mesh.n_vertices),
    )
    area = b.sum()

    def solve() -> Any:
        return sla.eigsh(a, EIGENPAIRS, sp.diags(b / area).tocsc(), sigma=-1e-2, v0=start)

    cpu, _, (values, functions) = timed(solve)
    return {"cpu": cpu, "residual": _residual(metric, np.maximum(values, 0) / area, functions)}


def minimax(mesh: Mesh) -> Result:
    """Ours, the maximum over all pairs of 200 samples of a surface placed on itself, from a shaken start."""
    from geodesics.tracing import walk

    metric = geodesics.scale_invariant(mesh)
    distance = geodesics.CommuteTimeDistance(geodesics.eigenpairs(metric, 100))
    points = SurfacePoints.at_vertices(mesh, geodesics.farthest_point_sampling(distance, 200))
    shake = 0.02 * np.sqrt(mesh.area) * np.random.default_rng(0).normal(size=(200, 2))
    problem = gmds.Problem(distance, points, distance)
    cpu, _, solution = timed(lambda: gmds.solve(problem, walk(points, shake), gmds.Minimax()))
    return {"cpu": cpu, "stress": solution.stress, "iterations": solution.iterations}


TASKS: dict[str, Callable[[Mesh], Result]] = {
    task.__name__: task
    for task in (marching, marching_potpourri3d, heat_potpourri3d, heat_igl, front_pymeshlab, many_sources, sampling)
}
TASKS |= {task.__name__: task for task in (eigenpairs, eigenpairs_exact, eigenpairs_scipy, minimax)}


def main() -> None:
    """Warm up, measure, print."""
    name, path = sys.argv[1:]
    TASKS[name](quadruped(n_vertices=1600))
    result = TASKS[name](load(Path(path)))
    peak = peak_megabytes()
    print(json.dumps({key: float(value) for key, value in {**result, "peak": peak}.items()}))


if __name__ == "__main__":
    main()
