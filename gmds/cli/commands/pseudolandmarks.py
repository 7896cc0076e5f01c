"""gmds pseudolandmarks: points evenly spread over all specimens of an atlas."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gmds.cli.commands.asymmetry import warn_if_poor
from gmds.cli.group import Command
from gmds.cli.output import emit, json_option
from gmds.cli.paths import AtlasFile, EndingIn

if TYPE_CHECKING:
    from gmds.morphometrics.sliding import Criterion


@click.command(cls=Command, short_help="Spread points evenly over all specimens of an atlas.")
@click.argument("atlas_file", metavar="ATLAS", type=AtlasFile())
@click.option("-o", "--output", required=True, type=EndingIn(".csv", ".tps"), help=".csv, .wide.csv or .tps.")
@click.option("--count", default=100, show_default=True, type=click.IntRange(min=4), help="How many points.")
@click.option("--symmetric", is_flag=True, help="In pairs of left and right, and on the midline.")
@click.option("--slide", type=click.Choice(["bending", "procrustes"]), help="Slide them on every specimen.")
@json_option
def command(
    atlas_file: Path, output: Path, count: int, symmetric: bool, slide: Criterion | None, as_json: bool
) -> None:
    """Spread points evenly over the mean shape of ATLAS (atlas.npz or its folder), and write them for every specimen.

    \b
      gmds pseudolandmarks atlas/atlas.npz --count 20 -o points.csv
      gmds pseudolandmarks atlas/atlas.npz --count 20 -o points.wide.csv
      gmds pseudolandmarks atlas/atlas.npz --count 20 -o points.tps
      gmds pseudolandmarks atlas/atlas.npz --count 20 --slide bending -o slid.csv

    \b
    .csv       a row a point: specimen, name, x, y, z
    .wide.csv  a row a specimen, columns P1.x, P1.y, P1.z, P2.x, ...; geomorph: arrayspecs(read.csv(f)[, -1], p, 3)
    .tps       a block a specimen; geomorph: readland.tps(f, specID = "ID")

    Each point is as far from all others as can be. With --symmetric the mean shape is matched with its mirror image,
    and points come in pairs L1, R1, ..., and M1, M2, ... on the midline (one more than --count where the last is a
    pair). What a specimen lacks is NA.

    With --slide they are semilandmarks of the surface: on each specimen they slide over it until the bending energy, or
    the Procrustes distance, to the mean is least, from where the atlas has them.
    """
    from geodesics import SurfacePoints
    from gmds.atlases.registered import Atlas
    from gmds.morphometrics.pseudolandmarks import even_points, paired_points
    from gmds.morphometrics.sliding import slide_all
    from gmds.morphometrics.specimen_tables import write_points

    atlas = Atlas.load(atlas_file)
    mean = atlas.mean
    if symmetric:
        from gmds.atlases.symmetry import partners

        other, status = partners(mean)
        warn_if_poor(status.name)
        points, names = paired_points(mean, other, count)
    else:
        points = SurfacePoints.at_vertices(mean, even_points(mean, count))
        names = [f"P{i + 1}" for i in range(len(points))]
    places, valid = atlas.at(points)
    if slide is not None:
        places = slide_all(places, patches=range(len(names)), meshes=atlas.registered, by=slide)
    write_points(output, atlas.names, names, places, valid)
    emit({"written": str(output), "specimens": len(atlas.names), "points": len(names)}, as_json)
