"""gmds repair: a better mesh, and which old vertices and faces it is made of."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option

FILE = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Write a better version of a mesh.")
@click.argument("mesh", type=FILE)
@click.option("-o", "--output", required=True, type=FILE, help="Where the new mesh goes; the ending says the format.")
@click.option("--maps", type=FILE, help="Write a .npz with the old index of every new vertex and face.")
@click.option("--weld", is_flag=True, help="Join vertices at exactly equal positions.")
@click.option("--fill-holes", type=int, metavar="EDGES", help="Close holes of at most so many edges (extra: repair).")
@click.option("--decimate", type=int, metavar="FACES", help="Reduce to about so many faces.")
@click.option(
    "--remesh", type=int, metavar="VERTICES", help="Triangulate anew, about so many vertices (extra: repair)."
)
@json_option
def command(mesh: Path, output: Path, maps: Path | None, as_json: bool, **steps: Any) -> None:
    """Write a better version of MESH: no repeated or degenerate faces, none turned against its neighbours.

    \b
      gmds repair dog.ply -o better.ply --maps maps.npz
      gmds repair scan.ply -o small.ply --decimate 5000

    Positions do not change and what stays keeps its order, unless one of the other steps is asked for; these follow
    in the order in which they are listed here. New faces and vertices have the old index -1; a remeshed surface has
    nothing but new ones, so it goes without --maps.
    """
    from dataclasses import asdict

    import numpy as np

    from geodesics import read_mesh, write_mesh
    from geodesics.io import atomic_write
    from geodesics.repair import decimate, fill_holes, remesh, repair

    if maps is not None and steps["remesh"] is not None:
        raise click.UsageError("--remesh makes every vertex new, so there are no --maps to write")
    result = repair(read_mesh(mesh), weld=steps["weld"])
    better, vertex, face, notes = result
    if steps["fill_holes"] is not None:
        better = fill_holes(better, steps["fill_holes"])
        face = np.concatenate([face, np.full(better.n_faces - len(face), -1)])
    if steps["decimate"] is not None:
        reduced = decimate(better, steps["decimate"])
        better, vertex, face = reduced.mesh, vertex[reduced.vertex], face[reduced.face]
    if steps["remesh"] is not None:
        better = remesh(better, steps["remesh"])
    write_mesh(better, output)
    if maps is not None:
        with atomic_write(maps) as stream:
            np.savez_compressed(stream, vertex=vertex, face=face)
    counts = {"file": str(output), "vertices": better.n_vertices, "faces": better.n_faces}
    emit({**counts, "notes": [asdict(note) if as_json else str(note) for note in notes]}, as_json)
