"""gmds evaluate: a map against the truth."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note
from gmds.cli.view_options import view_options, write_views

if TYPE_CHECKING:
    from geodesics import SurfacePoints
    from geodesics.arrays import Floats, Integers
    from gmds.correspondence import Correspondence

    Truth = tuple[Integers, SurfacePoints]

FILE = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Judge a map against the truth.")
@click.argument("map_file", metavar="MAP", type=FILE)
@click.option("--source", required=True, type=FILE, help="Mesh the map starts on.")
@click.option("--target", required=True, type=FILE, help="Mesh the map ends on.")
@click.option("--truth", required=True, type=FILE, help="Where source vertices should go; see above.")
@click.option("--symmetric-truth", type=FILE, help="The same for the left-right flipped map.")
@click.option("--source-truth", type=FILE, help="The source's own .vts or .mat file.")
@click.option("--points", default=125, show_default=True, type=click.IntRange(min=1), help="Truth points to judge on.")
@view_options
@json_option
def command(
    map_file: Path,
    source: Path,
    target: Path,
    truth: Path,
    symmetric_truth: Path | None,
    source_truth: Path | None,
    points: int,
    as_json: bool,
    **shown: Any,
) -> None:
    """Judge the map in MAP: geodesic distance from the truth, over the square root of the target's area.

    \b
      gmds evaluate map.npz --source dog.ply --target wolf.off --truth truth.npz

    Truth files: a .npz with arrays src and gt (source vertices, target vertices, both from 0), gt_sym if known, and for
    parts missing (source vertices without a counterpart), which adds how well the map tells them apart (overlap);
    another map.npz; a .vts file (one target vertex a line, from 1) with the source's own .vts as --source-truth, or
    with one line per source vertex; SHREC'20 .mat landmarks of both.

    \b
    What is printed
      direct, sym  errors by either truth: how many points, mean and median (times 100), and the percentages of errors
                   of at most 0.05, 0.1 and 0.25
      best         the lesser mean of the two, as for shapes whose left and right cannot be told apart
      coverage     percentage of the target's area that some vertex of the source is sent to
      valid        percentage of the vertices of the source that have a counterpart
      overlap      for parts: how well the map tells what has one, in percent
      curve        the shares of points with errors of at most 0, 0.01, ... 0.25
    """
    from dataclasses import asdict

    from geodesics import read_mesh
    from gmds import Correspondence
    from gmds.benchmarking.overlap import overlap_scores
    from gmds.benchmarking.truth_files import read_missing_npz, read_truth
    from gmds.evaluation import coverage

    meshes = read_mesh(source), read_mesh(target)
    answer = Correspondence.load(map_file, *meshes)
    wanted = {"direct": read_truth(truth, *meshes, source_path=source_truth)}
    if symmetric_truth is not None:
        wanted["sym"] = read_truth(symmetric_truth, *meshes, source_path=source_truth)
    elif truth.suffix.lower() == ".npz":
        wanted["sym"] = read_truth(truth, *meshes, flipped=True)
    result, curve, known = _judged(answer, wanted, points, candidates=shown["report"] is not None)
    result["best"] = min(entry["mean"] for entry in result.values())
    result["coverage"] = 100 * coverage(answer)
    result["valid"] = 100 * float(answer.valid.mean())
    missing = read_missing_npz(truth) if truth.suffix.lower() == ".npz" else None
    if missing is not None and wanted["direct"] is not None:
        scores = asdict(overlap_scores(answer.valid, wanted["direct"][0], missing))
        result["overlap"] = {name: None if share is None else 100 * share for name, share in scores.items()}
    result["curve"] = curve
    emit(result, as_json)
    title = f"{map_file.name}: {source.name} → {target.name}"
    write_views(answer, **shown, errors=known, title=title, names=(source.name, target.name))


def _judged(
    answer: Correspondence, wanted: dict[str, Truth | None], points: int, *, candidates: bool
) -> tuple[dict[str, Any], list[float], Floats]:
    """Figures by each truth; by the direct one also the curve, and errors (k, n): of the map, and of its candidates."""
    from dataclasses import asdict

    import numpy as np

    from gmds.evaluation import error_curve, errors_of_maps, geodesic_error, protocol_subset, summary

    result: dict[str, Any] = {}
    curve: list[float] = []
    known = np.full((1, len(answer.valid)), np.nan)
    for name, found in wanted.items():
        if found is None:
            continue
        indices, true = found
        chosen = protocol_subset(len(indices), points)
        if name == "direct" and len(chosen) < len(indices):
            note(f"judged at {len(chosen)} of {len(indices)} points; --points {len(indices)} judges at all")
        errors = geodesic_error(answer, true[chosen], indices[chosen])
        result[name] = asdict(summary(errors))
        if name == "direct":
            curve = error_curve(errors).tolist()
            known[0, indices[chosen]] = errors
            if candidates:
                known = errors_of_maps(answer, true[chosen], indices[chosen])
    return result, curve, known
