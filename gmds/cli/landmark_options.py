"""Landmarks on the command line: one file of pairs, or a file for each surface."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.output import note

if TYPE_CHECKING:
    from geodesics import Mesh
    from gmds.landmarks.files import Landmarks

space_option = click.option(
    "--space",
    type=click.Choice(["LPS", "RAS"]),
    default="LPS",
    show_default=True,
    help="Frame of the meshes; landmarks of 3D Slicer in the other one are turned into it.",
)


tolerance_option = click.option(
    "--tolerance",
    type=click.FloatRange(min=0),
    metavar="T",
    help="Landmarks are right to within T square roots of the area, and pull; without it they hold exactly.",
)


specimen_option = click.option(
    "--specimen", metavar="NAME", help="Whose landmarks, of a file that holds those of several specimens."
)


def landmarks_of(path: Path, space: Any, mesh: Mesh, mesh_file: Path, specimen: str | None = None) -> Landmarks:
    """The landmarks of a mesh in a file; of several specimens the one that is named, or that belongs to the mesh."""
    from gmds.landmarks.files import read_specimens
    from gmds.landmarks.files.specimens import belonging_to, only

    specimens = read_specimens(path, space)
    if specimen is None and len(specimens) > 1 and (found := belonging_to(specimens, mesh, mesh_file)):
        specimen, why = found
        note(f"{path.name} holds {len(specimens)} specimens; taken is {specimen!r}, as {why}")
    return only(specimens, path, specimen)


def check_on(landmarks: Landmarks, mesh: Mesh, which: str) -> None:
    """Refuse landmarks that are not on the mesh, by name where they have one: before anything is computed."""
    from gmds.landmarks.checking import place_on

    there = landmarks.defined
    names = [name for name, one in zip(landmarks.distinct_names, there, strict=True) if one]
    place_on(landmarks[there], mesh, which, names)


def given_landmarks(
    paths: Sequence[Path], space: Any, tolerance: float | None, meshes: Sequence[Mesh], files: Sequence[Path]
) -> Any:
    """What `match` takes, from no file, one of pairs, or one for each surface; points on one only are named on stderr.

    With a tolerance they are soft, but for those whose file says otherwise. Raises `click.UsageError` for more than two
    files.
    """
    from gmds.landmarks.soft import SoftLandmarks

    found = _given(paths, space, meshes, files)
    if tolerance is None or found is None or isinstance(found, SoftLandmarks):
        return found
    return SoftLandmarks(found, tolerance)


def _given(paths: Sequence[Path], space: Any, meshes: Sequence[Mesh], files: Sequence[Path]) -> Any:
    if len(paths) > 2:
        raise click.UsageError("--landmarks: give one file of pairs, or one for the source and one for the target")
    if not paths:
        return None
    if len(paths) == 1:
        from gmds.landmarks.pair_files import read_landmarks as read_pairs

        return read_pairs(paths[0])
    from gmds.landmarks.files import paired

    sides = zip(paths, meshes, files, strict=True)
    both = [landmarks_of(path, space, mesh, mesh_file) for path, mesh, mesh_file in sides]
    source, target, alone = paired(*both)
    for one, mesh, which in zip((source, target), meshes, ("source", "target"), strict=True):
        check_on(one, mesh, which)
    if alone:
        shown = ", ".join(alone[:8]) + (", ..." if len(alone) > 8 else "")
        note(f"{len(alone)} landmarks are on one surface only and are not used: {shown}")
    return (source, target) if source.named and target.named else (source.at, target.at)
