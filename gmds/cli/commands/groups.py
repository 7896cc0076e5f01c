"""gmds groups: whether the specimens of an atlas differ between groups, or with a covariate."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note, seed_option
from gmds.cli.paths import AtlasFile, OutputFolder, refuse_same_folder

PATH = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Test whether specimens differ between groups or with a covariate.")
@click.argument("atlas_file", metavar="ATLAS", type=AtlasFile())
@click.option("--table", type=PATH, help="A .csv with a row a specimen; its titles name groups and covariates.")
@click.option("--column", default="group", show_default=True, help="Which column; `size` is the centroid size.")
@click.option("-o", "--output", default="groups", show_default=True, type=OutputFolder(), help="Folder.")
@click.option("--permutations", default=999, show_default=True, type=click.IntRange(min=1), help="Of the test.")
@seed_option
@json_option
def command(
    atlas_file: Path, table: Path | None, column: str, output: Path, permutations: int, seed: int, as_json: bool
) -> None:
    """Test whether shape and growth in ATLAS (atlas.npz or its folder) differ between groups, or go with a covariate.

    \b
      gmds groups atlas/atlas.npz --column size --permutations 99 -o allometry

    A column of words makes groups, one of numbers is a covariate. Shape: Procrustes ANOVA of the superimposed
    specimens. Growth: how much lengths around each vertex differ from those of the mean, beside the whole, as a
    logarithm, whatever the pose; its regression on the logarithm of the centroid size (`--column size`) is allometry.

    \b
    The output folder holds
      test.csv    shape and growth: share of the variation that is explained, F, p by permutation (Procrustes ANOVA);
                  Hotelling's T squared of so many principal components, its p by permutation
      points.csv  a row a vertex: slope of growth (for two groups, how much longer it is in the second, as a
                  logarithm), its 95 % limits and p by Student's t, and q, the rate of false discoveries;
                  p is no less than permuting so few specimens could give, so of few no place is found
      growth.csv  growth itself: a row a vertex, a column a specimen; nothing where a specimen has no such point
      points.png  the slope, and where q is below 0.05, on the mean shape
    """
    import numpy as np

    from gmds.atlases.groups_output import write_growth, write_tests
    from gmds.atlases.registered import Atlas
    from gmds.cli.specimen_notes import tell_of_copies, tell_of_units
    from gmds.morphometrics.group_tests import design, point_tests, shape_test
    from gmds.morphometrics.hotelling import hotelling_test
    from gmds.morphometrics.sample_sizes import told_of_sizes
    from gmds.morphometrics.specimen_tables import read_column

    refuse_same_folder(atlas_file.parent, output, "the atlas")
    if table is None and column != "size":
        raise click.UsageError("--column names a column of --table; or give --column size")
    atlas = Atlas.load(atlas_file)
    laid = atlas.superposition
    values: Any = np.log(laid.sizes) if table is None else read_column(table, column, atlas.names)
    columns, sizes = design(values), told_of_sizes(values, atlas.names)
    tell_of_copies(atlas)
    if table is None:
        tell_of_units(atlas, "Then its size says nothing beside that of others")
    for sentence in sizes:
        note(f"gmds: {sentence}")
    growth = atlas.growth
    whole = np.isfinite(growth).all(axis=0)
    wanted = {"permutations": permutations, "rng": seed}
    told = {"shape": laid.aligned, "growth": growth[:, whole]}
    tests = {name: (shape_test(x, columns, **wanted), hotelling_test(x, columns, **wanted)) for name, x in told.items()}
    points = point_tests(growth, columns[:, 0]) if columns.shape[1] == 1 else None
    found = {
        name: {"r_squared": one.r_squared, "f": one.f, "p": one.p, "t_squared": t.t_squared, "p_t_squared": t.p}
        for name, (one, t) in tests.items()
    }
    groups = None if np.asarray(values).dtype.kind == "f" else sorted(set(np.asarray(values).tolist()))
    write_tests(tests, points, atlas.mean, output, _slope(column, groups))
    write_growth(growth, atlas.names, output)
    known = 0 if points is None else int((points.q < 0.05).sum())
    emit(
        {"folder": str(output), "specimens": len(atlas.names), "groups": groups, **found, "points_found": known},
        as_json,
    )


def _slope(column: str, groups: Sequence[str] | None) -> str:
    """What the slope of a point is: of log lengths beside the whole, from group to group or by a covariate."""
    if groups:
        return f"log of the change of length, from {groups[0]} to {groups[-1]}"
    unit = "the log of the size" if column == "size" else column
    return f"log of the change of length, per unit of {unit}"
