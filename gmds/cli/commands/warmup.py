"""gmds warmup: compile everything now."""

from __future__ import annotations

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note, progress_bar


@click.command(cls=Command, short_help="Compile everything now, once on a machine.")
@json_option
def command(as_json: bool) -> None:
    """Compile all kernels by matching two tiny built-in shapes, so that the first real match does not wait for it.

    \b
      gmds warmup

    What is compiled is kept on disk and serves all later processes; a second `gmds warmup` finds it there and compiles
    nothing. Do this when an image for a cluster is built, or before timing anything.
    """
    from dataclasses import asdict

    from gmds.installation.warmup import warm_up

    with progress_bar("warmup") as progress:
        warmth = warm_up(progress)
    emit(asdict(warmth), as_json)
    if warmth.folder is None:
        note("compiled kernels cannot be kept here; set NUMBA_CACHE_DIR to a folder that can be written")
