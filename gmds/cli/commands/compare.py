"""gmds compare: how far apart the shapes of a folder are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import UNFINISHED, Command
from gmds.cli.output import emit, json_option, note, progress_bar

if TYPE_CHECKING:
    from gmds.comparison.folder import Compared


@click.command(cls=Command, short_help="Say how far apart the shapes of a folder are.")
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("-o", "--output", default="compared", show_default=True, type=click.Path(path_type=Path), help="Folder.")
@click.option("--embed", default=0, show_default=True, type=click.IntRange(min=0), help="Nearest shapes to embed.")
@click.option(
    "--by",
    default="distances",
    show_default=True,
    type=click.Choice(["distances", "self-functional-maps"]),
    help="What two shapes are compared by, before any is embedded.",
)
@json_option
def command(folder: Path, output: Path, embed: int, by: str, as_json: bool) -> None:
    """Compare all shapes of FOLDER, whatever their poses and sizes and, within limits, the sizes of their parts.

    \b
      gmds compare meshes -o compared
      gmds compare meshes -o compared --embed 3
      gmds compare meshes -o compared --by self-functional-maps

    Every pair gets a bound: the least distortion that a map of one surface to the other can have if it keeps area, in
    the scale-invariant metric; a millisecond or two. With --embed N every shape and the N others of least bound are
    also embedded in each other, and these pairs get the distortion of the best embeddings found, of the way round that
    distorts more: seconds each. When that is every pair, because there are N + 1 shapes, the matrix, the tree and the
    map are made of distortions, else of bounds.

    With --by self-functional-maps the bound is instead how far the self functional maps of two shapes are apart: how
    the eigenfunctions of the metric of space and of the scale-invariant one are made of each other (Halimi and Kimmel).

    The output folder holds matrix.csv; nearest.csv (for every shape the nearest others, with bound and distortion);
    tree.csv (a merge of two clusters a line; clusters are numbered after the shapes); map.csv (a point in
    the plane for every shape); a picture and a page with all of these. What was computed is kept there, and a run that
    was interrupted goes on. Files that cannot be used are named on stderr and left out; the exit code is then 3.
    """
    from gmds.comparison.clustering import families, neighbour_accuracy
    from gmds.comparison.described import ALL
    from gmds.comparison.folder import compare_files
    from gmds.comparison.output import write_comparison
    from gmds.files.folders import mesh_files

    paths = mesh_files(folder)
    with progress_bar("compare") as progress:
        compared = compare_files(paths, output / "kept", embed=embed, by=ALL[by], progress=progress)
    for name, reason in compared.failures.items():
        note(f"gmds: left out {name}: {reason}")
    if compared.names:
        write_comparison(compared, output)
    accuracy = neighbour_accuracy(compared.matrix, families(compared.names)) if compared.names else None
    emit(_summary(compared, output, by, accuracy), as_json)
    if compared.failures:
        raise click.exceptions.Exit(UNFINISHED)


def _summary(compared: Compared, output: Path, by: str, accuracy: float | None) -> dict[str, Any]:
    pairs = len(compared.names) * (len(compared.names) - 1) // 2
    return {
        "folder": str(output),
        "shapes": len(compared.names),
        "pairs": pairs,
        "by": by,
        "embedded_pairs": compared.embedded_pairs,
        "left_out": list(compared.failures),
        "nearest_has_same_name": accuracy,
    }
