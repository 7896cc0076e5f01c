"""gmds check: what is unusual or wrong with a mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option

if TYPE_CHECKING:
    from geodesics.errors import Note

MOST_INDICES = 6  # of the faces or vertices that a finding means: as many as a line takes


@click.command(cls=Command, short_help="Say what is wrong with a mesh.")
@click.argument("mesh", type=click.Path(path_type=Path))
@json_option
def command(mesh: Path, as_json: bool) -> None:
    """Say what is unusual or wrong with the mesh in a file, without changing it.

    \b
      gmds check dog.ply

    A line for each finding, warnings first: a code that does not change between versions, how many faces or vertices
    are meant, the first of them (counted from 0), and what mends it: yes (gmds repair), a further option of it, or no.
    A mesh that cannot be used at all ends with exit code 1.
    """
    from geodesics.check import check
    from geodesics.io import read_with_notes

    found, notes = read_with_notes(mesh)
    findings = [_finding(note) for note in [*notes, *check(found)]]
    counts = {"file": str(mesh), "vertices": found.n_vertices, "faces": found.n_faces}
    emit({**counts, "notes": findings} if as_json else counts, as_json)
    if not as_json:
        _print_table(findings)


def _finding(note: Note) -> dict[str, Any]:
    """A note as JSON can carry it, with what `gmds repair` can do about it; None where there is nothing to mend."""
    from dataclasses import asdict

    from geodesics.check import REMEDIES

    mends = f"yes {REMEDIES[note.code]}".strip() if note.code in REMEDIES else "no"
    return {**asdict(note), "repair": mends if note.severity == "warning" or note.code in REMEDIES else None}


def _print_table(findings: list[dict[str, Any]]) -> None:
    rows = [("code", "", "count", "repair", "what", "first")]
    for found in findings:
        more = ", ..." if len(found["indices"]) > MOST_INDICES else ""
        first = ", ".join(map(str, found["indices"][:MOST_INDICES])) + more
        count = "" if found["count"] is None else str(found["count"])
        rows.append((found["code"], found["severity"], count, found["repair"] or "", found["message"], first))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        click.echo("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
