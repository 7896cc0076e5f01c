"""gmds repair: a better mesh, and which old vertices and faces it is made of."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option

if TYPE_CHECKING:
    from geodesics.repair.repairing import Repaired

from gmds.cli.paths import OutputFile

FILE = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Write a better version of a mesh.")
@click.argument("mesh", type=FILE)
@click.option(
    "-o", "--output", required=True, type=OutputFile(), help="Where the new mesh goes; the ending says the format."
)
@click.option("--maps", type=OutputFile(), help="Write the old index of every new vertex and face, and back (.npz).")
@click.option("--weld", is_flag=True, help="Join vertices at exactly equal positions.")
@click.option("--sew", is_flag=True, help="Split open edges at vertices that lie on them (T-junctions).")
@click.option(
    "--cut", is_flag=True, help="Take apart edges of more than two faces, and vertices that join several fans."
)
@click.option("--largest", is_flag=True, help="Keep the largest component only.")
@click.option("--fill-holes", type=int, metavar="EDGES", help="Close holes of at most so many edges (extra: repair).")
@click.option("--decimate", type=int, metavar="FACES", help="Reduce to about so many faces.")
@click.option(
    "--remesh", type=int, metavar="VERTICES", help="Triangulate anew, about so many vertices (extra: repair)."
)
@click.option("--turn", is_flag=True, help="Turn all faces inside out.")
@json_option
def command(mesh: Path, output: Path, maps: Path | None, as_json: bool, **steps: Any) -> None:
    """Write a better version of MESH: no repeated or degenerate faces, none turned against its neighbours.

    \b
      gmds repair dog.ply -o better.ply --maps maps.npz
      gmds repair scan.ply -o small.ply --decimate 5000

    Positions do not change and what stays keeps its order, unless one of the other steps is asked for; these follow
    in the order in which they are listed here. `gmds check` says which of them a mesh needs. .stl and .glb have single
    precision; where that moves vertices by more than the shape can bear, it is told. --maps holds `vertex` and
    `face`, for each new one the old index, and `new_vertex` and `new_face`, for each old one the new; -1 is none. A
    remeshed surface has nothing but new ones, so it goes without --maps.
    """
    from dataclasses import asdict

    import numpy as np

    from geodesics import Mesh, read_with_notes, write_mesh
    from geodesics.io import atomic_write
    from geodesics.repair.remeshing import remesh
    from geodesics.repair.repairing import repair

    if maps is not None and steps["remesh"] is not None:
        raise click.UsageError("--remesh makes every vertex new, so there are no --maps to write")
    given, notes = read_with_notes(mesh)
    found = repair(given, weld=steps["weld"], sew=steps["sew"], cut=steps["cut"], largest=steps["largest"])
    found = _with_new_faces(found, steps["fill_holes"], steps["decimate"])
    better = found.mesh if steps["remesh"] is None else remesh(found.mesh, steps["remesh"])
    better = Mesh(better.vertices, better.faces[:, [0, 2, 1]]) if steps["turn"] else better
    notes = [*notes, *found.notes, *write_mesh(better, output)]
    if maps is not None:
        with atomic_write(maps) as stream:
            np.savez_compressed(
                stream, vertex=found.vertex, face=found.face, new_vertex=found.new_vertex, new_face=found.new_face
            )
    counts = {"file": str(output), "vertices": better.n_vertices, "faces": better.n_faces}
    if as_json:
        emit({**counts, "notes": [asdict(note) for note in notes]}, as_json)
        return
    emit(counts, as_json)
    for told in map(str, notes) if notes else ["nothing was wrong"]:
        click.echo(told)


def _with_new_faces(found: Repaired, largest_hole: int | None, n_faces: int | None) -> Repaired:
    """With holes closed and faces reduced, where that is asked for."""
    import numpy as np

    from geodesics.errors import Note
    from geodesics.repair.decimation import decimate
    from geodesics.repair.remeshing import fill_holes
    from geodesics.repair.repairing import inverse_index

    if largest_hole is not None:
        closed = fill_holes(found.mesh, largest_hole)
        added = closed.n_faces - len(found.face)
        notes = [*found.notes, *([Note("W217", "info", f"{added} faces closed holes", (), added)] if added else [])]
        found = found._replace(mesh=closed, face=np.append(found.face, np.full(added, -1)), notes=notes)
    if n_faces is not None:
        reduced = decimate(found.mesh, n_faces)
        vertex, face = found.vertex[reduced.vertex], found.face[reduced.face]
        back = inverse_index(vertex, len(found.new_vertex)), inverse_index(face, len(found.new_face))
        found = found._replace(mesh=reduced.mesh, vertex=vertex, face=face, new_vertex=back[0], new_face=back[1])
    return found
