"""gmds voronoi: farthest points of a mesh and the cells around them."""

from __future__ import annotations

from pathlib import Path

import click

from gmds.cli.fields import FILE, distance_option, draw, metric_option, output_option, picture_option, write_field
from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, progress_bar


@click.command(cls=Command, short_help="Spread samples over a mesh, with their Voronoi cells.")
@click.argument("mesh", type=FILE)
@click.option("--samples", default=30, show_default=True, type=click.IntRange(min=1), help="How many samples.")
@metric_option
@distance_option
@output_option
@picture_option
@json_option
def command(
    mesh: Path, samples: int, metric: str, distance: str, output: Path, picture: Path | None, as_json: bool
) -> None:
    """Choose vertices of MESH, each the farthest from those before it, and find which of them is nearest to a vertex.

    \b
      gmds voronoi dog.ply --samples 50 -o cells.npz --picture cells.png
      gmds voronoi dog.ply --metric scale-invariant --distance diffusion -o cells.csv

    A .npz holds `samples`, the vertices chosen, in order; for every vertex `cell`, the place of the nearest one in that
    order, from 0, and its `distance`. A .csv has a line for every vertex, with the nearest sample itself as well. A
    vertex that no sample reaches is in cell -1. Metrics and diffusion time are those of
    `gmds match --metric --distance`.
    """
    import time

    import numpy as np

    from geodesics import read_mesh
    from geodesics.errors import BadArgument
    from geodesics.sampling import farthest_point_cells
    from gmds.cli.choices import ChosenDistance

    surface = read_mesh(mesh)
    started = time.process_time()
    with progress_bar("voronoi"):
        measured = ChosenDistance(metric, distance)(surface)
        try:
            cells = farthest_point_cells(measured, samples)
        except BadArgument as error:
            raise BadArgument(f"--samples {samples}: {error.args[0]}") from error
    sample = np.where(cells.nearest < 0, -1, cells.samples[cells.nearest])
    write_field(
        output,
        {"samples": cells.samples, "cell": cells.nearest, "distance": cells.distance},
        {"cell": cells.nearest, "sample": sample, "distance": cells.distance},
    )
    reached = cells.distance[np.isfinite(cells.distance)]
    result = {
        "file": str(output),
        "samples": cells.samples.tolist(),
        "vertices": surface.n_vertices,
        "radius": float(reached.max(initial=0.0)),
        "unreachable": int(surface.n_vertices - len(reached)),
        "cpu_seconds": time.process_time() - started,
    }
    emit(result, as_json)
    caption = f"{samples} cells, {distance} distance, {metric} metric"
    draw(picture, [(caption, surface, cells.nearest)], name=mesh, labels=True, marked=cells.samples)
