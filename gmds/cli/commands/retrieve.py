"""gmds retrieve: the meshes of a folder, the most alike first."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gmds.cli.group import BAD_INPUT, UNFINISHED, Command
from gmds.cli.output import emit, json_option, note, progress_bar, seed_option
from gmds.cli.paths import OutputFile

if TYPE_CHECKING:
    from gmds.retrieval import Described

COLUMNS = ("rank", "mesh", "distance")


@click.command(cls=Command, short_help="Rank the meshes of a folder by likeness.")
@click.argument("query", type=click.Path(path_type=Path))
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path, exists=True, file_okay=False))
@click.option("-o", "--output", type=OutputFile(), help="Write the ranking as CSV.")
@click.option("--words", default=48, show_default=True, type=click.IntRange(min=1), help="Size of the vocabulary.")
@seed_option
@json_option
def command(query: Path, folder: Path, output: Path | None, words: int, seed: int, as_json: bool) -> None:
    """Rank the meshes of DIR by their likeness to QUERY, whatever their poses and the sizes of their parts.

    \b
      gmds retrieve dog.ply meshes -o ranking.csv

    Meshes are compared by bags of features (ShapeGoogle, Table 1 of the paper) whose vocabulary is learned from DIR and
    QUERY. A distance is from 0 (alike) to 2 (nothing in common). QUERY itself is left out where it lies in DIR; a mesh
    that cannot be read or measured is named on stderr and left out, and the exit code is 3.

    QUERY and the meshes of DIR are to be of similar resolution: what is said of a vertex depends on it. Where a folder
    holds shapes that are much alike, one of them with 5,000 vertices in place of 1,000 is 0.3 from all of them.
    """
    from gmds.files.folders import SUFFIXES, mesh_files
    from gmds.files.table import write_table
    from gmds.retrieval import DEFAULT, learned, ranking

    asked = _described(query)
    paths = [path for path in mesh_files(folder) if not path.samefile(query)]
    if not paths:
        note(f"gmds: {folder}: no mesh there to compare with ({', '.join(SUFFIXES)})")
        raise click.exceptions.Exit(BAD_INPUT)
    found: dict[str, tuple[Described, ...]] = {}
    with progress_bar("retrieve") as progress:
        for i, path in enumerate(paths):
            progress(path.name, i / len(paths))
            try:
                found[path.name] = _described(path)
            except (ValueError, OSError, ArithmeticError) as error:
                note(f"gmds: {path.name} left out: {error}")
    bags = learned(DEFAULT, [asked, *found.values()], words, rng=seed)
    ranked = ranking(bags.of(asked), [bags.of(parts) for parts in found.values()])
    names = [list(found)[i] for i in ranked.order]
    rows = [
        dict(zip(COLUMNS, (rank, name, float(distance)), strict=True))
        for rank, (name, distance) in enumerate(zip(names, ranked.distances, strict=True), 1)
    ]
    if output is not None:
        write_table(output, COLUMNS, (list(row.values()) for row in rows), digits=6)
    failed = len(paths) - len(found)
    if as_json:
        emit({"query": str(query), "ranking": rows, "left_out": failed}, as_json)
    for row in [] if as_json else rows:
        click.echo(f"{row['rank']:>4}  {row['distance']:.4f}  {row['mesh']}")
    if failed:
        note(f"gmds: {failed} of {len(paths)} meshes left out")
        raise click.exceptions.Exit(UNFINISHED)


def _described(path: Path) -> tuple[Described, ...]:
    from geodesics import read_mesh
    from gmds.retrieval import DEFAULT, signatures_of

    return signatures_of(read_mesh(path), DEFAULT)
