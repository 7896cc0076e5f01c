"""Values on the vertices of a surface: the options, files and pictures that several commands share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.choices import DISTANCES, METRICS
from gmds.cli.output import tell_written
from gmds.cli.paths import EndingIn

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from geodesics import Mesh


FILE = click.Path(path_type=Path)
metric_option = click.option(
    "--metric", type=click.Choice(METRICS), default="embedded", show_default=True, help="Metric of the surface."
)
distance_option = click.option(
    "--distance", type=click.Choice(DISTANCES), default="geodesic", show_default=True, help="Distance in that metric."
)
output_option = click.option(
    "-o", "--output", required=True, type=EndingIn(".npz", ".csv"), help="Where the values go: .npz or .csv."
)
PICTURES = (".png", ".jpg", ".jpeg", ".svg", ".pdf")
picture_option = click.option(
    "--picture", type=EndingIn(*PICTURES), help="Draw the surface as well: .png, .jpg, .svg or .pdf."
)


def write_field(path: Path, arrays: Mapping[str, NDArray[Any]], columns: Mapping[str, NDArray[Any]]) -> None:
    """Write the arrays (.npz), the first of them (.npy), or a table with the columns and a row a vertex (.csv).

    The file is complete or untouched. Numbers in a table keep every bit.
    """
    import numpy as np

    from geodesics.io import atomic_write
    from gmds.files.table import write_table

    ending = path.suffix.lower()
    if ending == ".csv":
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        write_table(path, ["vertex", *columns], ((vertex, *row) for vertex, row in enumerate(rows)))
        return
    with atomic_write(path) as stream:
        if ending == ".npz":
            packed: dict[str, Any] = dict(arrays)
            np.savez_compressed(stream, **packed)
        else:
            np.save(stream, next(iter(arrays.values())), allow_pickle=False)


def draw(
    path: Path | None,
    surfaces: Sequence[tuple[str, Mesh, NDArray[Any]]],
    *,
    name: Path,
    marked: NDArray[np.generic] | None = None,
    **options: Any,
) -> None:
    """The picture of (caption, mesh, values) that was asked for, named on stderr once it is written.

    `name`: the file of the mesh, whose ending says what is up; `marked`: vertices that get a little ball, on each;
    `options`: of `gmds.pictures.write_values`.
    """
    if path is None:
        return
    from gmds.cli.directions import upwards
    from gmds.pictures.values import write_values

    balls = None if marked is None else [marked] * len(surfaces)
    up = upwards(None, str(name))
    tell_written(path, write_values(path, surfaces, marked=balls, up=up, **options))
