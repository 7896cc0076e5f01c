"""gmds asymmetry: how far the specimens of an atlas are from their mirror images."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note
from gmds.cli.paths import AtlasFile, OutputFolder, refuse_same_folder

if TYPE_CHECKING:
    from geodesics.arrays import Integers
    from gmds.atlases.registered import Atlas

PATH = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Measure left against right on the specimens of an atlas.")
@click.argument("atlas_file", metavar="ATLAS", type=AtlasFile())
@click.option("-o", "--output", default="asymmetry", show_default=True, type=OutputFolder(), help="Folder.")
@click.option("--sides", type=PATH, help="A table that pairs left and right specimens; without it each has both.")
@click.option("--individual", default="individual", show_default=True, help="Column that says which belong together.")
@click.option("--side", default="side", show_default=True, help="Column that says which is which.")
@json_option
def command(atlas_file: Path, output: Path, sides: Path | None, individual: str, side: str, as_json: bool) -> None:
    """Measure how far specimens of ATLAS (atlas.npz or its folder) are from symmetric: each point, and all together.

    \b
      gmds asymmetry atlas/atlas.npz -o asymmetry

    Object symmetry: the mean shape is matched with its mirror image, which tells where every point is on the other
    side. Matching symmetry, with --sides: specimens of one side were mirrored (`gmds atlas --mirror`), and those of one
    individual are compared.

    \b
    The output folder holds
      asymmetry.csv   a row a vertex: directional (the mean over specimens, outward, over the root of the area; positive
                      where this side is larger) and fluctuating asymmetry (the standard deviation), and each specimen
      specimens.csv   a row a specimen or individual: root mean square asymmetry, and its largest, over root area
      asymmetry.png   both, on the symmetric mean
      mean.ply        that mean
    """
    import numpy as np

    from gmds.atlases.asymmetry_output import write_asymmetry
    from gmds.atlases.registered import Atlas
    from gmds.atlases.sides import side_pairs
    from gmds.atlases.symmetry import partners
    from gmds.morphometrics.asymmetry import matching_asymmetry, object_asymmetry
    from gmds.morphometrics.specimen_tables import read_column

    refuse_same_folder(atlas_file.parent, output, "the atlas")
    atlas = Atlas.load(atlas_file)
    if sides is None:
        names = list(atlas.names)
        other_side, status = partners(atlas.mean)
        warn_if_poor(status.name)
        found = object_asymmetry(atlas.configurations, atlas.faces, other_side, atlas.valid)
    else:
        who, which = (read_column(sides, column, atlas.names) for column in (individual, side))
        names, one, other = side_pairs(np.asarray(who).astype(str), np.asarray(which).astype(str))
        note_sides(atlas, one, other, names)
        x, there = atlas.configurations, atlas.valid
        found = matching_asymmetry(x[one], x[other], atlas.faces, there[one] & there[other])
    write_asymmetry(found, names, output)
    kinds = ("among_specimens", "directional", "fluctuating")
    shares = dict(zip(kinds, (round(share, 4) for share in found.shares), strict=True))
    emit({"folder": str(output), "compared": len(names), "shares_of_variation": shares}, as_json)


def note_sides(atlas: Atlas, one: Integers, other: Integers, names: list[str]) -> None:
    """Say so where both specimens of an individual are of one side, and how many specimens have no partner."""
    alike = [name for name, i, j in zip(names, one, other, strict=True) if atlas.mirrored[i] == atlas.mirrored[j]]
    if alike:
        note(
            f"gmds: neither or both specimens of {alike[0]} were mirrored ({len(alike)} such individuals): what is "
            "told is not asymmetry; make the atlas with `gmds atlas --mirror`"
        )
    alone = len(atlas.names) - 2 * len(names)
    if alone:
        note(f"gmds: {alone} specimens have no partner, or more than one, and are left out")


def warn_if_poor(status: str) -> None:
    """Say so where the mean shape hardly fits its mirror image."""
    if status == "POOR":
        note("gmds: the map of the mean shape to its mirror image is POOR; the sides may not correspond")
