"""gmds benchmark: a published benchmark folder, one row a pair."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gmds.cli.group import UNFINISHED
from gmds.cli.matching_options import matching_arguments, matching_options
from gmds.cli.output import json_option, note, progress_bar
from gmds.cli.paths import OutputFile
from gmds.cli.settings import ConfiguredCommand


@click.command("benchmark", cls=ConfiguredCommand, short_help="Judge matching on a benchmark folder.")
@click.argument("dataset_dir", type=click.Path(path_type=Path))
@click.option("--pairs", type=click.Path(path_type=Path), help="The pairs to run, instead of the published ones.")
@click.option("--every", default=1, show_default=True, type=click.IntRange(min=1), help="Run every N-th pair only.")
@click.option("-o", "--output", type=OutputFile(), help="Write the rows as CSV.")
@matching_options
@json_option
def command(
    dataset_dir: Path, pairs: Path | None, every: int, output: Path | None, as_json: bool, **options: Any
) -> None:
    """Match every pair of a benchmark folder and judge it against the truth.

    \b
      gmds benchmark dataset -o rows.csv
      gmds benchmark dataset --every 10 --json

    Every mesh is turned and resized at random first. A row says: mean error x100 (geodesic distance over the square
    root of the target's area) against the true correspondence (direct), the left-right flipped one (sym) and the better
    of the two; percentage within 0.10; percentage of the target that is hit; CPU seconds; status. CSV and JSON also
    have the percentages within 0.05 and 0.25, the rank correlation of the map's distortion with the true error, the
    percentage of points with a counterpart that are called valid, and of those without one that are not; and, where the
    truth says what is missing, intersection over union, precision and recall of what is called valid.

    Known folders: remeshed FAUST and TOSCA (.vts truth), locally scaled pairs and parts (pairs.json), SHREC'20 (.mat).
    """
    import functools
    import json
    from dataclasses import asdict

    from gmds import match
    from gmds.benchmarking.datasets import dataset_pairs
    from gmds.benchmarking.run import BenchmarkRow, benchmark, means, write_csv

    matcher = functools.partial(match, **matching_arguments(options))
    chosen = dataset_pairs(dataset_dir, pairs)[::every]
    rows: list[BenchmarkRow] = []
    if not as_json:
        click.echo(_line("pair", "direct", "sym", "best", "<0.10", "cover", "CPU s", "status"))
    with progress_bar("benchmark") as progress:
        for row in benchmark(chosen, matcher, seed=options["seed"]):
            rows.append(row)
            progress(row.pair, len(rows) / len(chosen))
            if not as_json:
                click.echo(_row(row))
            if output is not None:  # after every pair, so that an interrupted run keeps what it has
                write_csv(output, rows)
    averages = means(rows)
    if as_json:
        content = {"rows": [asdict(row) for row in rows], "means": [asdict(row) for row in averages]}
        click.echo(json.dumps(content, indent=2, allow_nan=False))
    else:
        for row in averages:
            click.echo(_row(row))
    if output is not None:
        write_csv(output, [*rows, *averages])
    failed = sum(row.direct is None for row in rows)
    if failed:
        note(f"gmds: {failed} of {len(rows)} pairs failed")
        raise click.exceptions.Exit(UNFINISHED)


def _row(row: object) -> str:
    figures = [getattr(row, name) for name in ("direct", "sym", "best", "within_010", "coverage", "cpu_seconds")]
    name = f"{row.pair} ({row.group})" if row.group else row.pair  # type: ignore[attr-defined]
    return _line(name, *("-" if f is None else f"{f:.2f}" for f in figures), row.status)  # type: ignore[attr-defined]


def _line(name: str, *cells: str) -> str:
    return f"{name:<36} " + " ".join(f"{cell:>7}" for cell in cells[:-1]) + f"  {cells[-1]}"
