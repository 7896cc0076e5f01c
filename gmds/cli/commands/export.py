"""gmds export: a map for other programs."""

from __future__ import annotations

from pathlib import Path

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option
from gmds.cli.paths import OutputFile

FILE = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Write a map as .csv or for MATLAB.")
@click.argument("map_file", metavar="MAP", type=FILE)
@click.option("--source", required=True, type=FILE, help="Mesh the map starts on.")
@click.option("--target", required=True, type=FILE, help="Mesh the map ends on.")
@click.option("-o", "--output", required=True, type=OutputFile(), help="A file that ends in .csv or .mat.")
@json_option
def command(map_file: Path, source: Path, target: Path, output: Path, as_json: bool) -> None:
    """Write the map in MAP for other programs.

    \b
      gmds export map.npz --source dog.ply --target wolf.off -o map.csv
      gmds export map.npz --source dog.ply --target wolf.off -o map.mat

    \b
    .csv  a row for every source vertex, indices from 0: source_vertex, target_vertex (the nearest), face,
          weight_0 weight_1 weight_2 (where on that face), x y z, valid, distortion, confidence,
          growth (log of the change of length around the vertex)
    .mat  for MATLAB, indices from 1: vertex, face, barycentric, position, valid, distortion, confidence, growth,
          status, n_source, n_target
    """
    from geodesics import read_mesh
    from gmds import Correspondence
    from gmds.maps.export import check_export, export_map

    check_export(output)
    answer = Correspondence.load(map_file, read_mesh(source), read_mesh(target))
    export_map(answer, output)
    emit({"written": str(output), "rows": len(answer.points), "status": answer.status.name}, as_json)
