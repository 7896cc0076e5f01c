"""gmds model: what varies in an atlas."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option
from gmds.cli.paths import AtlasFile, OutputFolder, refuse_same_folder

if TYPE_CHECKING:
    from gmds.morphometrics.shape_model import ShapeModel


@click.command(cls=Command, short_help="Find what varies in an atlas: a shape model.")
@click.argument("atlas_file", metavar="ATLAS", type=AtlasFile())
@click.option("-o", "--output", default="model", show_default=True, type=OutputFolder(), help="Folder.")
@click.option("--components", type=click.IntRange(min=1), help="How many are kept.  [default: all]")
@click.option("--keep-size", is_flag=True, help="Leave specimens as large as they are.")
@click.option("--shown", default=3, show_default=True, type=click.IntRange(min=1), help="Components that are drawn.")
@json_option
def command(atlas_file: Path, output: Path, components: int | None, keep_size: bool, shown: int, as_json: bool) -> None:
    """Find the mean shape and the principal components of the specimens in ATLAS (atlas.npz or its folder).

    \b
      gmds atlas meshes -o atlas --workers 1
      gmds model atlas/atlas.npz -o model

    Specimens are superimposed by generalised Procrustes analysis (place, rotation and, without --keep-size, size).

    \b
    The output folder holds
      model.npz           mean, components, explained variances, scores, centroid sizes, for numpy and ShapeModel.load
      mean.ply            the mean shape; mode1-minus.ply, mode1-plus.ply, ...: 2 standard deviations either way
      mean.vtp, ...       the same for ParaView
      scores.csv          a row for every specimen: centroid size, scores
      components.csv      variance of each component, its share, that of a broken stick, and compactness, generalisation
                          (leaving one out) and specificity of a model with so many
      modes.png           the components, coloured by how far points move outward or inward
      model.html          a page with sliders for the components; specimens are points of a plot, and pictures
    """
    from gmds.atlases.model_output import write_model
    from gmds.atlases.registered import Atlas
    from gmds.cli.specimen_notes import tell_of_copies, tell_of_units
    from gmds.morphometrics.shape_model import ShapeModel

    refuse_same_folder(atlas_file.parent, output, "the atlas")
    atlas = Atlas.load(atlas_file)
    model = ShapeModel.from_atlas(atlas, components, scale=not keep_size)
    tell_of_copies(atlas)
    if keep_size:
        tell_of_units(atlas, "Then the first component is that")
    write_model(model, output, shown)
    emit(_told(model, output), as_json)


def _told(model: ShapeModel, output: Path) -> dict[str, Any]:
    from gmds.morphometrics.quality import broken_stick

    above = model.explained_variance_ratio_ > broken_stick(model)
    return {
        "folder": str(output),
        "specimens": len(model.scores_),
        "components": model.n_components_,
        "explained": [round(float(share), 4) for share in model.explained_variance_ratio_[:5]],
        "above_broken_stick": int(above.cumprod().sum()),
    }
