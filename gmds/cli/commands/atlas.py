"""gmds atlas: one triangulation for all meshes of a folder, and their mean shape."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import UNFINISHED, Command
from gmds.cli.output import emit, json_option, note, progress_bar
from gmds.cli.paths import OutputFolder, refuse_same_folder, tell_inner_folders

if TYPE_CHECKING:
    from gmds.atlases.registered import Atlas

PATH = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Bring a folder of meshes to one triangulation.")
@click.argument("folder", type=PATH)
@click.option("-o", "--output", default="atlas", show_default=True, type=OutputFolder(), help="Folder.")
@click.option("--template", metavar="NAME", help="The first template.  [default: the specimen most like all others]")
@click.option(
    "--templates",
    default=1,
    show_default=True,
    type=click.IntRange(min=1),
    help="How many templates have a vote.",
)
@click.option(
    "--rounds",
    default=1,
    show_default=True,
    type=click.IntRange(min=1),
    help="From the second, the mean is the template.",
)
@click.option(
    "--neighbours",
    type=click.IntRange(min=0),
    help="From how many others each is registered too.  [default: 1 with one template, else 0]",
)
@click.option(
    "--mirror", metavar="NAME|auto", multiple=True, help="A specimen of the other side; or find out which are."
)
@click.option("--timeout", type=click.FloatRange(min=0, min_open=True), help="Seconds that a pair may take.")
@click.option("--workers", type=click.IntRange(min=1), help="Processes on this machine.  [default: one a processor]")
@click.option("--scheduler", metavar="ADDRESS", help="Work on the cluster of this dask scheduler instead.")
@json_option
def command(folder: Path, output: Path, as_json: bool, **options: Any) -> None:
    """Bring all meshes of FOLDER to one triangulation, so that vertex i is the same point of all, with a mean shape.

    \b
      gmds atlas meshes -o atlas --workers 1
      gmds atlas meshes -o voted --templates 2 --workers 1

    The specimen to which all others are nearest is the template and is matched to each; then each is registered from
    another one as well. With --templates each of several is matched to all. All these maps are taken both ways until
    they agree: the middle of what they say is taken, and how far they disagree is the spread, an error bar. With
    --rounds the mean shape is matched to all in turn.

    \b
    The output folder holds
      registered/NAME.ply  the specimens, all with the same list of faces
      mean.ply             the mean shape, nobody's specimen
      atlas.npz            all of it for numpy: names, faces, positions (k, n, 3), valid (k, n), mean, spread
      summary.csv          a row for every specimen: status, share that is valid, gap (mean distance of its vertices
                           from the registered surface, over the root of its area), spread, centroid size, Procrustes
                           distance from the mean; or the code and the reason of a failure
      variation.csv        how much each vertex varies, and in how many specimens it is
      atlas.png            the mean shape coloured by that, and three specimens
      maps/                the maps, as `gmds batch` writes them

    What is there is not done again, so the same command goes on where it was interrupted. A mesh that cannot be used is
    named and left out; the exit code is then 3. `gmds model` says what varies in an atlas.
    """
    from gmds.atlases.build import atlas
    from gmds.atlases.output import write_atlas
    from gmds.batch import local_client, quiet, remote_client
    from gmds.cli.specimen_notes import tell_of_copies, tell_of_doubt, tell_of_units

    refuse_same_folder(folder, output, "the meshes")
    tell_inner_folders(folder, output)
    address, workers = options.pop("scheduler"), options.pop("workers")
    if address is not None and workers is not None:
        raise click.UsageError("--workers is for this machine; with --scheduler its workers are used")
    mirror = "auto" if "auto" in options["mirror"] else options["mirror"]
    quiet()
    client = remote_client(address) if address else local_client(workers)
    with progress_bar("atlas", remaining=True) as progress:
        made = atlas(folder, output, **{**options, "mirror": mirror}, client=client, progress=progress)
    write_atlas(made, output)
    for name, why in made.failures.items():
        note(f"gmds: left out {name}: {why.code}: {why.reason}")
    tell_of_units(made, "Shape and growth do not mind")
    tell_of_copies(made)
    tell_of_doubt(made)
    emit(_told(made, output), as_json)
    if made.failures:
        raise click.exceptions.Exit(UNFINISHED)


def _told(made: Atlas, output: Path) -> dict[str, Any]:
    import numpy as np

    laid = made.superposition
    distances = dict(zip(made.names, map(float, laid.distances), strict=True))
    farthest = sorted(distances.items(), key=lambda item: -item[1])[:3]
    return {
        "folder": str(output),
        "specimens": len(made.names),
        "vertices": made.positions.shape[1],
        "template": ", ".join(made.templates),
        "mirrored": [name for name, is_so in zip(made.names, made.mirrored, strict=True) if is_so],
        "mean_rests_after": f"{laid.rounds} rounds of superposition, moved by {laid.change:.1e}",
        "mean_moved_in_later_rounds": list(made.changes),
        "mean_gap": float(np.nanmean(made.gap)) if np.isfinite(made.gap).any() else None,
        "farthest_from_mean": dict(farthest),
        "left_out": list(made.failures),
    }
