"""gmds view: a map in a browser, to look at and to work on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.directions import upwards
from gmds.cli.group import Command
from gmds.cli.landmark_options import landmarks_of, space_option
from gmds.cli.output import note
from gmds.cli.view_options import up_option

if TYPE_CHECKING:
    from geodesics import Mesh
    from geodesics.arrays import Floats
    from gmds.correspondence import Correspondence
    from gmds.maps.made_with import NamedPair

FILE = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Look at a map in a browser and correct it.")
@click.argument("map_file", metavar="MAP", type=FILE)
@click.option("--source", required=True, type=FILE, help="Mesh the map starts on.")
@click.option("--target", required=True, type=FILE, help="Mesh the map ends on.")
@click.option("--landmarks", type=FILE, multiple=True, help="Landmarks to begin with: of SOURCE, then of TARGET.")
@space_option
@click.option("--truth", type=FILE, help="Where source vertices should go, as for `gmds evaluate`: shows errors.")
@up_option
@click.option("--port", default=0, type=click.IntRange(0, 65535), help="Port to listen on; a free one unless given.")
@click.option("--no-browser", is_flag=True, help="Print the link, open nothing.")
def command(map_file: Path, source: Path, target: Path, no_browser: bool, **options: Any) -> None:
    """Serve the map in MAP as a page to work in, on this machine alone, until Ctrl-C.

    \b
      gmds view map.npz --source dog.ply --target wolf.off
      gmds view map.npz --source dog.ply --target wolf.off --landmarks dog.csv --landmarks wolf.csv
      gmds view map.npz --source dog.ply --target wolf.off --truth truth.npz

    The page shows the map and its candidates, as that of `gmds match --report` does. Landmarks are placed on both
    surfaces, named, moved and deleted; what is wrong is painted over; "Match again" finds another map with what was
    placed, and shows it beside the one before. Landmarks are saved as .mrk.json or .csv, a map as map.npz.

    The page is served on 127.0.0.1; the link holds a token, without which nothing is answered. What was placed is lost
    with Ctrl-C unless it was saved.
    """
    from geodesics import read_mesh
    from gmds import Correspondence
    from gmds.viewer.server import PageServer
    from gmds.viewer.workplace import Workplace

    meshes = read_mesh(source), read_mesh(target)
    answer = Correspondence.load(map_file, *meshes)
    given = _landmarks(options["landmarks"], options["space"], meshes, (source, target))
    names = source.name, target.name
    title = f"{map_file.name}: {source.name} → {target.name}"
    up, errors = upwards(options["up"], source.name), _errors(answer, options["truth"])
    place = Workplace(answer, names, title=title, up=up, landmarks=given, errors=errors, space=options["space"])
    with PageServer(place, options["port"]) as server:
        click.echo(server.link)
        note("open this link in a browser of this machine; Ctrl-C ends it")
        if not no_browser:
            click.launch(server.link)
        server.serve_until_interrupted()
        note("ended")


def _errors(answer: Correspondence, truth: Path | None) -> Floats | None:
    """Of the map and its candidates, at the points that `gmds evaluate` judges on."""
    from gmds.benchmarking.truth_files import read_truth
    from gmds.evaluation import errors_of_maps, protocol_subset

    found = None if truth is None else read_truth(truth, answer.source, answer.target)
    if found is None:
        return None
    vertices, true = found
    chosen = protocol_subset(len(vertices))
    return errors_of_maps(answer, true[chosen], vertices[chosen])


def _landmarks(
    paths: tuple[Path, ...], space: Any, meshes: tuple[Mesh, Mesh], files: tuple[Path, Path]
) -> tuple[NamedPair, ...] | None:
    """The landmarks of one file or two, by name; those of one surface alone wait for their other half."""
    from gmds.landmarks.checking import place_on

    if len(paths) > 2:
        raise click.UsageError("--landmarks: give a file for SOURCE, and perhaps one for TARGET")
    if not paths:
        return None
    found: dict[str, list[Any]] = {}
    for side, (path, mesh, file) in enumerate(zip(paths, meshes, files, strict=False)):
        marks = landmarks_of(path, space, mesh, file)
        there = marks.defined
        names = [name for name, one in zip(marks.distinct_names, there, strict=True) if one]
        placed = place_on(marks.at[there], mesh, ("source", "target")[side], names).positions
        for name in marks.distinct_names:
            found.setdefault(name, [None, None])
        for name, position in zip(names, placed, strict=True):
            found[name][side] = position
    return tuple((name, one, other) for name, (one, other) in found.items())
