"""gmds match: one pair of meshes, one map."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gmds.cli.landmark_options import given_landmarks, space_option, tolerance_option
from gmds.cli.matching_options import matching_arguments, matching_options
from gmds.cli.output import emit, json_option, known, note, progress_bar, valid_count
from gmds.cli.paths import EndingIn
from gmds.cli.settings import ConfiguredCommand
from gmds.cli.view_options import view_options, write_views

FILE = click.Path(path_type=Path)
MAP = EndingIn(".npz", "")


@click.command("match", cls=ConfiguredCommand, short_help="Match two meshes and write the map.")
@click.argument("source", type=FILE)
@click.argument("target", type=FILE)
@click.option("-o", "--output", default="map.npz", show_default=True, type=MAP, help="Where the map goes.")
@view_options
@click.option("--landmarks", type=FILE, multiple=True, help="Known points; given once or twice, see above.")
@space_option
@tolerance_option
@matching_options
@json_option
def command(source: Path, target: Path, output: Path, as_json: bool, **options: Any) -> None:
    """Find for every vertex of SOURCE the point of TARGET that corresponds to it, and write the map.

    \b
      gmds match dog.ply wolf.off -o map.npz --report map.html --picture map.png
      gmds match dog.ply wolf.off --landmarks dog.csv --landmarks wolf.csv
      gmds match half-dog.ply wolf.off --parts source -o half.npz

    Meshes are OFF, OBJ, PLY, STL, GLB, glTF, VTK, VTP, GIFTI, FreeSurfer or TOSCA .vert/.tri files, packed by gzip or
    not. The map is a .npz that numpy alone can read.

    Landmarks are one file for both surfaces, with two vertex numbers (from 0), six coordinates, or twice a face and
    three weights a line, and perhaps a tolerance behind them; or a map, for those it was made with; or, with the option
    given twice, a file for SOURCE then one for TARGET (.csv, .mrk.json, .fcsv, .tps, .pts, ...; `gmds landmarks --help`
    lists them), whose points belong together by name when both have names, else by order.

    A mesh with a boundary may be a part of what the other one is: a scan from one side, half a skull. Unless landmarks,
    a metric or a distance are given, that is looked into, and the shares of both that correspond are told (overlap);
    --parts says it beforehand, or spares the time (neither).
    """
    import time

    from geodesics import read_mesh
    from gmds import match

    meshes = read_mesh(source), read_mesh(target)
    known = given_landmarks(options["landmarks"], options["space"], options["tolerance"], meshes, (source, target))
    started = time.process_time()
    with progress_bar("match") as progress:
        answer = match(*meshes, landmarks=known, progress=progress, **matching_arguments(options))
    seconds = time.process_time() - started
    for line in answer.meta.get("notes", ()):
        note(f"gmds: {line}")
    answer.save(output)
    emit({"map": str(output), "cpu_seconds": seconds, **map_summary(answer, as_json)}, as_json)
    shown = {name: options[name] for name in ("report", "picture", "show", "up")}
    write_views(answer, **shown, title=f"{source.name} → {target.name}", names=(source.name, target.name))


def map_summary(answer: Any, as_json: bool) -> dict[str, Any]:
    """What can be said of a map without knowing the truth; numbers for JSON, words for people."""
    import numpy as np

    ours, theirs = map(float, answer.overlap)
    told = f"{ours:.1%} of the source, {theirs:.1%} of the target"
    overlap = {"source": ours, "target": theirs} if as_json else told

    candidates = [{"stress": float(c.stress), "orientation": float(c.orientation)} for c in answer.candidates]
    return {
        "status": answer.status.name,
        "meaning": answer.status.value,
        **valid_count(answer, as_json),
        "overlap": overlap,
        "median_distortion": float(np.median(answer.distortion)),
        "mean_confidence": known([answer.confidence[answer.valid].mean() if answer.valid.any() else 0.0])[0],
        **({"doubtful": [one.as_data() for one in answer.doubtful]} if as_json else {}),
        "candidates": candidates,
    }
