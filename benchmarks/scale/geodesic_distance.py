"""Geodesic distance: time a source and error against exact polyhedral geodesics, beside other libraries.

    GMDS_DATA=... python -m benchmarks.scale.geodesic_distance [--sources 5]

Needs the `repair` extra, pygeodesic and potpourri3d. Times are CPU seconds of this process, after one warm-up, without
set-up, which has its own column. Writes benchmarks/results/geodesics.csv and .md.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import potpourri3d
import pygeodesic.geodesic
import pymeshlab
from numpy.typing import NDArray

from benchmarks.places import RESULTS
from benchmarks.scale.meshes import remeshed
from geodesics import GeodesicDistance, Mesh, Metric, SurfacePoints, embedded, farthest_point_sampling, read_mesh
from geodesics.delaunay import glued_delaunay
from geodesics.sampling import voronoi_cells
from gmds.files.table import write_table

Field = Callable[[int], NDArray[np.float64]]
DATA = Path(os.environ.get("GMDS_DATA", "."))


class Row(NamedTuple):
    """One method on one mesh."""

    mesh: str
    vertices: int
    method: str
    setup: float
    seconds: float
    mean_percent: float
    p99_percent: float
    worst_percent: float


def fine_mesh(target: int = 44_000) -> Mesh:
    """A well-shaped mesh of about `target` vertices: a TOSCA horse, subdivided and remeshed isotropically."""
    return Mesh(*remeshed(target))


def exact(mesh: Mesh) -> Field:
    """Exact geodesics by pygeodesic (Kirsanov's code)."""
    algorithm = pygeodesic.geodesic.PyGeodesicAlgorithmExact(mesh.vertices.copy(), mesh.faces.astype(np.int32))
    return lambda source: algorithm.geodesicDistances(np.array([source]), None)[0]


def ours(mesh: Mesh) -> Field:
    """Marching over the intrinsic Delaunay triangulation."""
    distance = GeodesicDistance(embedded(mesh), threads=1)
    distance.field(SurfacePoints.at_vertices(mesh, [0]))
    return lambda source: distance.field(SurfacePoints.at_vertices(mesh, [source]))[0]


def ours_on_own_faces(mesh: Mesh) -> Field:
    """Marching as in a metric that may differ across edges: over the mesh's own faces."""
    metric = embedded(mesh)
    distance = GeodesicDistance(Metric(mesh, metric.l_sq, metric.mass, None), threads=1)
    distance.field(SurfacePoints.at_vertices(mesh, [0]))
    return lambda source: distance.field(SurfacePoints.at_vertices(mesh, [source]))[0]


def potpourri3d_marching(mesh: Mesh) -> Field:
    """potpourri3d's fast marching (geometry-central)."""
    solver = potpourri3d.MeshFastMarchingDistanceSolver(mesh.vertices, mesh.faces)
    return lambda source: solver.compute_distance([[(source, [])]])


def potpourri3d_heat(mesh: Mesh) -> Field:
    """potpourri3d's heat method on the intrinsic Delaunay triangulation."""
    solver = potpourri3d.MeshHeatMethodDistanceSolver(mesh.vertices, mesh.faces)
    return lambda source: solver.compute_distance(source)


def pymeshlab_front(mesh: Mesh) -> Field:
    """pymeshlab's front propagation (VCG)."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))

    def field(source: int) -> NDArray[np.float64]:
        meshes.compute_scalar_by_geodesic_distance_from_given_point_per_vertex(startpoint=mesh.vertices[source])
        return meshes.current_mesh().vertex_scalar_array()

    return field


METHODS = {
    "this library": ours,
    "this library, own faces": ours_on_own_faces,
    "potpourri3d fast marching": potpourri3d_marching,
    "potpourri3d heat": potpourri3d_heat,
    "pymeshlab front propagation": pymeshlab_front,
}


def cpu(action: Callable[[], object]) -> tuple[float, object]:
    """CPU seconds and result of an action."""
    start = time.process_time()
    result = action()
    return time.process_time() - start, result


def measured(name: str, mesh: Mesh, sources: NDArray[np.int64]) -> list[Row]:
    """All methods on one mesh, each against the exact answer."""
    reference, truths, seconds = exact(mesh), [], []
    for source in sources:
        spent, field = cpu(lambda s=source: reference(int(s)))
        truths.append(field)
        seconds.append(spent)
    rows = [Row(name, mesh.n_vertices, "pygeodesic exact", 0.0, float(np.median(seconds)), 0.0, 0.0, 0.0)]
    ours(Mesh(mesh.vertices, mesh.faces))  # compiled once, not part of any set-up
    for method, make in METHODS.items():
        fresh = Mesh(mesh.vertices, mesh.faces)
        setup, field = cpu(lambda m=make, f=fresh: m(f))
        field(int(sources[0]))
        errors, seconds = [], []
        for source, truth in zip(sources, truths, strict=True):
            spent, found = cpu(lambda s=source, f=field: f(int(s)))
            seconds.append(spent)
            off = truth > 0
            errors.append(100 * np.abs(found - truth)[off] / truth[off])
        error = np.concatenate(errors)
        stats = error.mean(), np.percentile(error, 99), error.max()
        rows.append(Row(name, mesh.n_vertices, method, setup, float(np.median(seconds)), *map(float, stats)))
    return rows


def sampling(name: str, mesh: Mesh) -> list[str]:
    """CPU seconds of farthest-point sampling against one whole field a sample."""
    distance = GeodesicDistance(embedded(mesh), threads=1)
    one = cpu(lambda: distance.field(SurfacePoints.at_vertices(mesh, np.arange(5))))[0] / 5
    lines = []
    for count in (100, 400, 1000):
        seconds, samples = cpu(lambda c=count: farthest_point_sampling(distance, c))
        cells = cpu(lambda s=samples: voronoi_cells(distance, s))[0]
        lines.append(f"| {name} | {count} | {seconds:.3f} | {cells:.3f} | {one * count:.2f} | {seconds / one:.1f} |")
    return lines


def report(rows: list[Row], samples: list[str], meshes: dict[str, Mesh]) -> str:
    """The page of results."""
    lines = [
        "# Geodesic distance",
        "",
        "`GMDS_DATA=... python -m benchmarks.scale.geodesic_distance`; CPU seconds, errors against",
        "",
    ]
    lines[2] += (
        " exact polyhedral geodesics in percent, mean over all vertices and sources. Numbers depend on the machine."
    )
    lines += [
        "| mesh | vertices | method | set-up s | s a source | mean % | 99th % | worst % |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for r in rows:
        figures = (
            f"{r.setup:.3f} | {r.seconds:.4f} | {r.mean_percent:.4f} | {r.p99_percent:.3f} | {r.worst_percent:.2f}"
        )
        lines.append(f"| {r.mesh} | {r.vertices} | {r.method} | {figures} |")
    lines += ["", "Edges that intrinsic Delaunay flips replace:", ""]
    for name, mesh in meshes.items():
        flipped = (glued_delaunay(mesh).faces != mesh.faces).any(axis=1).mean()
        lines.append(f"- {name}: {100 * flipped:.0f} % of the faces are other than the mesh's own")
    lines += ["", "Farthest-point sampling, each front stopping where it meets a smaller distance:", ""]
    lines += [
        "| mesh | samples | CPU s | cells of given samples | as whole fields | in fields |",
        "|---|---|---|---|---|---|",
    ]
    return "\n".join([*lines, *samples, ""])


def main() -> None:
    """Measure and write both files."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sources", type=int, default=5)
    count = parser.parse_args().sources
    meshes = {"tosca_5k/cat0": read_mesh(DATA / "tosca_5k" / "cat0.off"), "horse0, 44k": fine_mesh()}
    rows, samples = [], []
    for name, mesh in meshes.items():
        sources = np.random.default_rng(0).choice(mesh.n_vertices, count, replace=False)
        rows += measured(name, mesh, sources)
        samples += sampling(name, mesh)
    RESULTS.mkdir(exist_ok=True)
    write_table(RESULTS / "geodesics.csv", Row._fields, rows)
    (RESULTS / "geodesics.md").write_text(report(rows, samples, meshes), encoding="utf-8")


if __name__ == "__main__":
    main()
