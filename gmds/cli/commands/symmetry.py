"""gmds symmetry: the maps of a mesh to itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note, progress_bar
from gmds.cli.paths import EndingIn
from gmds.cli.view_options import view_options, write_views

FILE = click.Path(path_type=Path)
MAP = EndingIn(".npz", "")


@click.command(cls=Command, short_help="Find the symmetries of a mesh, whatever its pose.")
@click.argument("mesh", type=FILE)
@click.option("-o", "--output", default="map.npz", show_default=True, type=MAP, help="Where the best map goes.")
@view_options
@click.option(
    "--vertices", type=click.IntRange(min=100), default=5000, show_default=True, help="Work on a copy with no more."
)
@json_option
def command(mesh: Path, output: Path, vertices: int, as_json: bool, **shown: Any) -> None:
    """Find the maps of MESH to itself, other than the identity, and write them.

    \b
      gmds symmetry dog.ply -o mirror.npz --picture mirror.png

    \b
    A limb or an ear may differ in size from its partner. All symmetries found are listed, the best first:
      reversing    whether left and right are exchanged (a reflection), or not (a rotation)
      stress       how much distances change, over the mean distance
      orientation  near 1 where orientation is kept, near -1 where it is reversed
      energy       of deforming the surface so
      twice        how far points are from home after the map is done twice, in root areas

    The best map goes to the output file, the second to map-2.npz if that is map.npz, and so on. A surface without
    symmetry gets the map that comes closest, with status POOR, or none. Maps are .npz that numpy alone can read.
    """
    import time

    from geodesics import read_mesh
    from gmds import self_symmetry

    surface = read_mesh(mesh)
    started = time.process_time()
    with progress_bar("symmetry") as progress:
        found = self_symmetry(surface, n_vertices=vertices, progress=progress)
    seconds = time.process_time() - started
    paths = [output if i == 0 else output.with_stem(f"{output.stem}-{i + 1}") for i in range(len(found))]
    for one, path in zip(found, paths, strict=True):
        one.save(path)
    told = [symmetry_summary(one, path) for one, path in zip(found, paths, strict=True)]
    if as_json:
        emit({"symmetries": told, "cpu_seconds": seconds}, as_json)
    for i, figures in enumerate([] if as_json else told):
        emit({"symmetry": f"{i + 1} of {len(told)}", **figures}, as_json)
    if not found:
        note("no symmetry found; nothing was written")
        return
    write_views(found[0], **shown, title=f"A symmetry of {mesh.name}", names=(mesh.name, f"{mesh.name}, mapped"))


def symmetry_summary(one: Any, path: Path) -> dict[str, Any]:
    """What can be said of a symmetry without knowing the truth."""
    return {"map": str(path), "status": one.status.name, **one.meta["symmetry"]}
