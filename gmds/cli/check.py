"""gmds check: what is unusual or wrong with a mesh."""

from __future__ import annotations

from pathlib import Path

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option


@click.command(cls=Command, short_help="Say what is wrong with a mesh.")
@click.argument("mesh", type=click.Path(path_type=Path))
@json_option
def command(mesh: Path, as_json: bool) -> None:
    """Say what is unusual or wrong with the mesh in a file, without changing it.

    \b
      gmds check dog.ply

    Warnings come first, each with a code that does not change between versions and the first faces or vertices meant.
    A mesh that can not be used at all ends with exit code 1.
    """
    from dataclasses import asdict

    from geodesics.check import check
    from geodesics.io import read_with_notes

    found, notes = read_with_notes(mesh)
    notes = [*notes, *check(found)]
    counts = {"file": str(mesh), "vertices": found.n_vertices, "faces": found.n_faces}
    if as_json:
        emit({**counts, "notes": [asdict(note) for note in notes]}, as_json)
        return
    emit(counts, as_json)
    for note in notes:
        shown = ", ".join(map(str, note.indices[:8])) + (", ..." if len(note.indices) > 8 else "")
        click.echo(f"{note.severity:<8} {note}" + (f" ({shown})" if shown else ""))
