"""A mesh of a million vertices from its file to distances: read, metric, 100 eigenpairs, farthest points, one march.

    GMDS_DATA=... python -m benchmarks.scale.million [--meshes DIR] [--size 1M]

Says on a progress line what it is at. Writes CPU seconds and the peak of memory after each stage to results/million.md.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.memory import peak_megabytes
from benchmarks.places import RESULTS
from benchmarks.scale.meshes import SIZES, load, mesh_path
from geodesics import GeodesicDistance, SurfacePoints, eigenpairs, embedded, read_mesh, scale_invariant, write_mesh
from geodesics.sampling import farthest_point_cells
from gmds.cli.output import progress_bar

PAGE = RESULTS / "million.md"
EIGENPAIRS, SAMPLES = 100, 1000  # a convention: what the table says


def ply(size: str, folder: Path) -> Path:
    """The mesh as a binary PLY file, made if it is not there."""
    path = folder / f"{size}.ply"
    if not path.is_file():
        write_mesh(load(mesh_path(size, folder)), path)
    return path


def main() -> None:
    """Go through the stages and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", type=Path, default=Path(tempfile.gettempdir()) / "gmds_scale")
    parser.add_argument("--size", choices=SIZES, default="1M")
    chosen = parser.parse_args()
    path, rows = ply(chosen.size, chosen.meshes), []
    with progress_bar(chosen.size) as progress:

        def stage(name: str, fraction: float, action: Callable[[], Any]) -> Any:
            progress(name, fraction)
            start = time.process_time()
            result = action()
            peak = peak_megabytes() / 1024
            rows.append(f"| {name} | {time.process_time() - start:.1f} | {peak:.2f} |")
            return result

        mesh = stage("read", 0.0, lambda: read_mesh(path))
        metric = stage("scale-invariant metric", 0.05, lambda: scale_invariant(mesh))
        stage(f"{EIGENPAIRS} eigenpairs", 0.3, lambda: eigenpairs(metric, EIGENPAIRS))
        distance = GeodesicDistance(embedded(mesh), threads=1)
        source = SurfacePoints.at_vertices(mesh, [0])
        stage("first march", 0.9, lambda: distance.field(source))
        stage("another march", 0.93, lambda: distance.field(source))
        stage(f"{SAMPLES} farthest points and their cells", 0.95, lambda: farthest_point_cells(distance, SAMPLES))
        progress("done", 1.0)
    title = f"# {mesh.n_vertices:,} vertices, {mesh.n_faces:,} faces"
    about = (
        "`GMDS_DATA=... python -m benchmarks.scale.million`; CPU seconds on one thread, and the peak of memory so far."
    )
    table = ["| stage | CPU s | peak GB |", "|---|---|---|", *rows]
    PAGE.write_text("\n".join([title, "", about, "", *table, ""]), encoding="utf-8")


if __name__ == "__main__":
    main()
