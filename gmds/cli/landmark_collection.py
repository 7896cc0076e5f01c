"""Landmarks of a template on a folder of specimens, as `gmds landmarks` does it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from gmds.cli.directions import upwards
from gmds.cli.group import UNFINISHED
from gmds.cli.landmark_options import landmarks_of
from gmds.cli.output import emit, note, progress_bar
from gmds.cli.paths import tell_inner_folders


def landmark_collection(folder: Path, template: Path, landmarks: Path, output: Path, **options: Any) -> None:
    """Carry the landmarks, write tables and pictures, tell what needs a look; exit code 3 where a specimen failed."""
    from geodesics import read_mesh
    from gmds.batch import local_client, quiet
    from gmds.specimens.carried import landmark_folder
    from gmds.specimens.curves import curve_triples, with_slid_curves
    from gmds.specimens.drawing import figure_class, write_pictures
    from gmds.specimens.tables import write_tables

    figure_class()  # before hours of work
    template = _specimen(folder, template)
    marks = landmarks_of(landmarks, options["space"], read_mesh(template), template, options["specimen"])
    if options["slide"] is not None and not curve_triples(marks.lists):
        raise click.UsageError(f"--slide is for points of curves, and {landmarks} holds no curve")
    asked = {"orientation": options["orientation"], "rng": options["seed"]}
    tell_inner_folders(folder, output)
    _tell_new_names(folder)
    quiet()
    output.mkdir(parents=True, exist_ok=True)
    with progress_bar("landmarks", remaining=True) as shown:
        told = shown if sys.stderr.isatty() else _lines()
        client = local_client(options["workers"])
        found = landmark_folder(folder, template, marks, output / "maps", client=client, progress=told, **asked)
    if options["slide"] is not None:
        found = with_slid_curves(found, options["slide"])
    to_look_at = write_tables(output, found)
    write_pictures(output, found, upwards(options["up"], template.name))
    for name, why in to_look_at:
        note(f"needs a look: {name}: {why}")
    result = {
        "folder": str(output),
        "specimens": len(found.specimens) - 1,
        "landmarks": len(marks),
        "doubtful": int(sum((one.doubtful & found.marks.defined).sum() for one in found.specimens[1:])),
        "to_look_at": sorted({name for name, _ in to_look_at}),
        "left_out": sorted(found.failures),
    }
    emit(result, options["as_json"])
    if found.failures:
        raise click.exceptions.Exit(UNFINISHED)


def _specimen(folder: Path, template: Path) -> Path:
    """The file of the template, which may be called as specimens of the folder are in tables, or by its file there."""
    from gmds.batch.collection import names
    from gmds.files.folders import mesh_files

    if template.exists():
        return template
    paths = mesh_files(folder)
    called = {path.name: path for path in paths} | dict(zip(names(paths), paths, strict=True))
    return called.get(str(template), template)


def _tell_new_names(folder: Path) -> None:
    """What meshes are called in tables and pictures whose own names cannot stand in the name of a map."""
    from gmds.batch.collection import names
    from gmds.files.folders import mesh_files

    paths = mesh_files(folder)
    new = [(path.name, name) for path, name in zip(paths, names(paths), strict=True) if not path.name.startswith(name)]
    if new:
        note(f"called otherwise in the tables: {', '.join(f'{name} for {old!r}' for old, name in new)}")


def _lines() -> Callable[[str, float], None]:
    """Progress as a line for every thing that is done, where stderr is no terminal."""
    last = [""]
    note("the template is matched with every specimen, unless its map is there; each that is done has a line")

    def tell(stage: str, fraction: float) -> None:
        if stage != last[0]:
            last[0] = stage
            note(f"{stage} ({100 * fraction:.0f} %)")

    return tell
