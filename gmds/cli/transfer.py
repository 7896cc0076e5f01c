"""gmds transfer: values on the target of a map, carried to its source."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.fields import FILE, EndingIn, draw, picture_option, write_field
from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@click.command(cls=Command, short_help="Carry values from the target of a map to its source.")
@click.argument("map_file", metavar="MAP", type=FILE)
@click.option("--source", required=True, type=FILE, help="Mesh the map starts on, which gets the values.")
@click.option("--target", required=True, type=FILE, help="Mesh the map ends on, which has them.")
@click.option(
    "--values", required=True, type=EndingIn(".npy", ".csv", ".txt"), help="A row for every vertex of the target."
)
@click.option("--labels", is_flag=True, help="Values are names: the one of largest weight wins.")
@click.option("-o", "--output", required=True, type=EndingIn(".npy", ".csv"), help="Where the carried values go.")
@picture_option
@json_option
def command(
    map_file: Path,
    source: Path,
    target: Path,
    values: Path,
    labels: bool,
    output: Path,
    picture: Path | None,
    as_json: bool,
) -> None:
    """Carry values on the vertices of the target along the map in MAP, to the vertices of the source.

    \b
      gmds transfer map.npz --source dog.ply --target wolf.off --values heights.csv -o carried.csv
      gmds transfer map.npz --source dog.ply --target wolf.off --values parts.txt --labels -o parts.npy

    Numbers are interpolated on the triangle where a vertex goes. With --labels values are names, numbers or words, and
    a vertex gets the one with the largest weight there. A .npy holds an array with a row for every vertex; text has a
    line for every vertex, entries with commas (.csv) or blanks (.txt) between them, and perhaps a header, whose first
    column may be `vertex`, as in the files that gmds writes. Vertices without a counterpart (not valid in the map) get
    the values at the point that the map holds for them all the same. The picture shows the first column.
    """
    from geodesics import read_mesh
    from gmds import Correspondence
    from gmds.cli.values_file import read_values

    meshes = read_mesh(source), read_mesh(target)
    answer = Correspondence.load(map_file, *meshes)
    given = read_values(values, meshes[1].n_vertices, labels=labels)
    if given.dtype.kind in "bU" and not labels:
        raise click.UsageError(f"{values} holds names ({given.dtype}), not numbers; give --labels to carry them")
    if given.dtype.kind in "iu" and given.ndim == 1 and not labels:
        note("values are whole numbers and get interpolated; --labels carries them as names")
    carried = answer.transfer(given, labels=labels)
    table = carried.reshape(len(carried), -1)
    names = ["value"] if table.shape[1] == 1 else [f"value_{i}" for i in range(table.shape[1])]
    write_field(output, {"values": carried}, dict(zip(names, table.T, strict=True)))
    result: dict[str, Any] = {
        "file": str(output),
        "vertices": len(carried),
        "columns": table.shape[1],
        "carried": "as labels" if labels else "by interpolation",
        "valid": f"{int(answer.valid.sum())} of {len(answer.valid)}",
    }
    emit(result, as_json)
    first = given.reshape(len(given), -1)[:, 0], table[:, 0]
    shown = _shown(*first, labels=labels)
    captions = "target, values given", "source, values carried"
    draw(picture, list(zip(captions, reversed(meshes), shown, strict=True)), labels=labels)


def _shown(given: NDArray[Any], carried: NDArray[Any], *, labels: bool) -> tuple[NDArray[np.generic], ...]:
    """What the picture shows of both: numbers (the real part), or for every label its place among all labels."""
    import numpy as np

    if not labels:
        return given.real, carried.real
    place = np.unique(np.concatenate([given, carried]), return_inverse=True)[1].reshape(-1)
    return place[: len(given)], place[len(given) :]
