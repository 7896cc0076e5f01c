"""gmds distances: from some vertices to all vertices of a mesh."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.fields import FILE, distance_option, draw, metric_option, output_option, picture_option, write_field
from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, progress_bar

if TYPE_CHECKING:
    from geodesics import Distance


def _starts(_ctx: click.Context, _param: click.Parameter, given: tuple[str, ...]) -> tuple[str, ...]:
    for text in given:
        if not re.fullmatch(r"\d{1,18}|farthest:[1-9]\d{0,8}", text, re.ASCII) and not Path(text).suffix:
            raise click.BadParameter(
                f"{text!r} is neither a vertex number (from 0), farthest:COUNT nor a file of landmarks"
            )
    return given


@click.command(cls=Command, short_help="Measure distances from vertices to all others.")
@click.argument("mesh", type=FILE)
@click.option(
    "--from",
    "starts",
    required=True,
    multiple=True,
    callback=_starts,
    metavar="VERTEX",
    help="A vertex, numbered from 0, farthest:COUNT, or a file of landmarks; may be given often.",
)
@metric_option
@distance_option
@output_option
@picture_option
@json_option
def command(
    mesh: Path, starts: tuple[str, ...], metric: str, distance: str, output: Path, picture: Path | None, as_json: bool
) -> None:
    """Measure distances on MESH from the vertices given by --from to every vertex.

    \b
      gmds distances dog.ply --from 0 --from 99 -o distances.npz --picture distances.png
      gmds distances dog.ply --from dog.csv -o from-landmarks.csv
      gmds distances dog.ply --from farthest:10 --metric scale-invariant --distance diffusion -o distances.csv

    farthest:COUNT stands for that many vertices, each the farthest from those before it; a file of landmarks for the
    vertices nearest to them, and columns of a .csv have their names then.
    A .npz holds `distance`, a row for every vertex given, `points`, these vertices, and `names`, what landmarks are
    called and else the numbers; a .csv has a line for every vertex of the mesh. What cannot be reached is infinitely
    far. The picture shows the distance to the nearest of the vertices given. Metrics and diffusion time are those of
    `gmds match --metric --distance`.
    """
    import time

    import numpy as np

    from geodesics import SurfacePoints, read_mesh
    from gmds.cli.choices import ChosenDistance

    surface = read_mesh(mesh)
    started = time.process_time()
    numbers = [int(text) for text in starts if text.isdigit()]
    SurfacePoints.at_vertices(surface, numbers)  # refuses a wrong number before anything is measured
    with progress_bar("distances"):
        measured = ChosenDistance(metric, distance)(surface)
        named = [_vertices(text, measured, mesh) for text in starts]
        points = np.array([vertex for one in named for vertex in one.values()], dtype=np.int64)
        field = measured.field(SurfacePoints.at_vertices(surface, points))
    names = [name for one in named for name in one]
    titles = [f"from_{name}" for name in names]
    if len(set(titles)) < len(titles):  # landmarks of two files may be called the same
        titles = [f"{title}_{vertex}" for title, vertex in zip(titles, points, strict=True)]
    columns = dict(zip(titles, field, strict=True))
    write_field(output, {"distance": field, "points": points, "names": np.array(names)}, columns)
    finite = np.isfinite(field)
    result: dict[str, Any] = {
        "file": str(output),
        "points": points.tolist(),
        "vertices": surface.n_vertices,
        "largest": float(field[finite].max(initial=0.0)),
        "unreachable": int(np.count_nonzero(~finite)),
        "cpu_seconds": time.process_time() - started,
    }
    emit(result, as_json)
    shown = [(f"{distance} distance, {metric} metric", surface, field.min(axis=0))]
    unit = "distance, in units of the mesh" if metric == "embedded" and distance == "geodesic" else "distance"
    draw(picture, shown, name=mesh, marked=points, label=unit, isolines=True)


def _vertices(text: str, distance: Distance, mesh_file: Path) -> dict[str, int]:
    """The vertices that one --from stands for, by what they are called."""
    from geodesics import farthest_point_sampling
    from geodesics.errors import BadArgument
    from gmds.cli.landmark_options import landmarks_of
    from gmds.landmarks.checking import place_on

    if text.isdigit():
        return {text: int(text)}
    if not text.startswith("farthest:"):
        marks = landmarks_of(Path(text), "LPS", distance.mesh, mesh_file)
        names = [name for name, there in zip(marks.distinct_names, marks.defined, strict=True) if there]
        placed = place_on(marks.at[marks.defined], distance.mesh, "mesh", names)
        return dict(zip(names, placed.nearest_vertices().tolist(), strict=True))
    try:
        found = farthest_point_sampling(distance, int(text.partition(":")[2]))
    except BadArgument as error:
        raise BadArgument(f"--from {text}: {error.args[0]}") from error
    return {str(vertex): vertex for vertex in found.tolist()}
