"""Landmarks on the command line: one file of pairs, or a file for each surface."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from gmds.cli.output import note

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


def given_landmarks(paths: Sequence[Path], space: Any, tolerance: float | None = None) -> Any:
    """What `match` takes, from no file, one of pairs, or one for each surface; points on one only are named on stderr.

    With a tolerance they are soft, but for those whose file says otherwise. Raises `click.UsageError` for more than two
    files.
    """
    from gmds.landmarks.soft import SoftLandmarks

    found = _given(paths, space)
    if tolerance is None or found is None or isinstance(found, SoftLandmarks):
        return found
    return SoftLandmarks(found, tolerance)


def _given(paths: Sequence[Path], space: Any) -> Any:
    if len(paths) > 2:
        raise click.UsageError("--landmarks: give one file of pairs, or one for the source and one for the target")
    if not paths:
        return None
    if len(paths) == 1:
        from gmds.landmarks.pair_files import read_landmarks as read_pairs

        return read_pairs(paths[0])
    from gmds.landmarks.files import paired, read_landmarks

    source, target, alone = paired(read_landmarks(paths[0], space), read_landmarks(paths[1], space))
    if alone:
        shown = ", ".join(alone[:8]) + (", ..." if len(alone) > 8 else "")
        note(f"{len(alone)} landmarks are on one surface only and are not used: {shown}")
    return source.at, target.at
