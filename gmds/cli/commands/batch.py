"""gmds batch: many pairs, each shape measured once, resumed where it stopped."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import UNFINISHED
from gmds.cli.matching_options import matching_arguments, matching_options
from gmds.cli.output import emit, json_option, note, progress_bar
from gmds.cli.paths import OutputFolder, tell_inner_folders
from gmds.cli.settings import ConfiguredCommand

if TYPE_CHECKING:
    from gmds.batch import Batch
    from gmds.batch.cycles import Consistency

PATH = click.Path(path_type=Path)
MOST_FAILURES = 20  # failures that are named on stderr, what a screen takes; the rest are in the summary
MOST_CYCLES = 5  # cycles, and pairs to blame; set by hand
SHARES = ("within_005", "within_010")


@click.command("batch", cls=ConfiguredCommand, short_help="Match many pairs, side by side.")
@click.argument("list_or_dir", type=PATH)
@click.option("-o", "--output", default="batch", show_default=True, type=OutputFolder(), help="Folder.")
@click.option(
    "--pairs", metavar="all|consecutive|template=NAME", help="Which shapes of a folder to match.  [default: all]"
)
@click.option(
    "--both-ways/--one-way", default=False, show_default=True, help="Match every pair in both directions, or in one."
)
@click.option("--timeout", type=click.FloatRange(min=0, min_open=True), help="Seconds that a pair may take.")
@click.option("--workers", type=click.IntRange(min=1), help="Processes on this machine.  [default: one a processor]")
@click.option("--scheduler", metavar="ADDRESS", help="Work on the cluster of this dask scheduler instead.")
@matching_options
@json_option
def command(list_or_dir: Path, output: Path, as_json: bool, **options: Any) -> None:
    """Match the pairs in a list, or those of all shapes in a folder, and write all maps to the output folder.

    \b
      gmds batch meshes -o maps
      gmds batch pairs.txt -o maps --timeout 600

    A list is a text file with `A,B` a line, paths relative to it, or with one file a line. A folder stands for the
    meshes in it; each is matched with every later one, with the next (consecutive), or one with all (template=NAME).

    \b
    The output folder holds
      pairs/A__B.npz  maps, as `gmds match` writes them, but for the time it took
      summary.csv     a row for every pair: source, target, status; valid (share of the vertices of the source that
                      have a counterpart), distortion (the median), stress, margin (how much likelier the map is than
                      any other), blame (how far points go astray around triangles of shapes with this map in them),
                      code and reason of a failure
      cycles.csv      how far from home points come that go A > B > C > A, worst first
      manifest.jsonl  what happened when: a line of JSON for every run, shape and pair
      shapes/         what was measured of each shape, once for all its pairs

    What is there and whole is not done again, so the same command goes on with a batch that was interrupted; with
    other settings all pairs are done again, and their maps replaced. A mesh
    that is broken, a worker that dies, a pair that takes too long is told and the rest goes on; the exit code is then
    3. Only one run at a time works in a folder; to have more machines work on it, start a dask scheduler and workers
    that see the same folders, and give its address.
    """
    from gmds.batch import local_client, match_collection, quiet, remote_client

    address = options["scheduler"]
    if address is not None and options["workers"] is not None:
        raise click.UsageError("--workers is for this machine; with --scheduler its workers are used")
    tell_inner_folders(list_or_dir, output)
    choice = _choice(options["pairs"], options["both_ways"])
    quiet()
    client = remote_client(address) if address else local_client(options["workers"])
    wanted = {**matching_arguments(options), "timeout": options["timeout"], "client": client}
    with progress_bar("batch", remaining=True) as progress:
        done = match_collection(list_or_dir, output, pairs=choice, progress=progress, **wanted)
    for line in _failures(done):
        note(f"gmds: {line}")
    emit(_told(done), as_json)
    if done.failed:
        raise click.exceptions.Exit(UNFINISHED)


def _choice(pairs: str | None, both: bool) -> Any:
    """The function that names on the command line stand for; None where the list or the default is to decide."""
    from gmds.batch import all_pairs, both_ways, consecutive, with_template

    if pairs is None:
        return both_ways(all_pairs) if both else None
    known = {"all": all_pairs, "consecutive": consecutive}
    kind, _, name = pairs.partition("=")
    if not (kind == "template" and name) and pairs not in known:
        raise click.UsageError(f"--pairs is all, consecutive or template=NAME, not {pairs!r}")
    choice = known[pairs] if pairs in known else with_template(name)
    return both_ways(choice) if both else choice


def _failures(done: Batch) -> list[str]:
    """A line for every broken shape, and for pairs that failed for another reason."""
    broken = [shape for shape in done.shapes.values() if shape.failure is not None]
    lines = [
        f"left out {shape.name}: {shape.failure.code}: {shape.failure.reason}" for shape in broken if shape.failure
    ]
    names = {shape.name for shape in broken}
    pairs = [pair for pair in done.failed if pair.failure is not None and not names & {pair.source, pair.target}]
    lines += [f"failed {pair.name}: {pair.failure.code}: {pair.failure.reason}" for pair in pairs if pair.failure]
    if len(lines) <= MOST_FAILURES:
        return lines
    return [*lines[:MOST_FAILURES], f"and {len(lines) - MOST_FAILURES} more; see summary.csv"]


def _told(done: Batch) -> dict[str, Any]:
    statuses = [pair.status for pair in done.pairs]
    return {
        "folder": str(done.output),
        "shapes": len(done.shapes),
        "broken_shapes": [shape.name for shape in done.shapes.values() if shape.failure is not None],
        "pairs": len(done.pairs),
        "done_before": sum(pair.kept for pair in done.pairs),
        "failed": len(done.failed),
        "status": {status: statuses.count(status) for status in dict.fromkeys(statuses)},
        "cycles": _agreement(done.consistency),
    }


def _agreement(found: Consistency) -> dict[str, Any] | None:
    """How well the maps agree around triangles of shapes; None where there is no triangle."""
    if found.mean is None:
        return None
    figures = {name: sum(getattr(c, name) for c in found.cycles) / len(found.cycles) for name in SHARES}
    return {
        "count": len(found.cycles),
        "mean": found.mean,
        **figures,
        "worst": {str(cycle): cycle.mean for cycle in found.cycles[:MOST_CYCLES]},
        "most_blamed": {f"{a}__{b}": blame for (a, b), blame in list(found.blame.items())[:MOST_CYCLES]},
    }
