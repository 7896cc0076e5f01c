"""What a command says of the specimens of an atlas before what it found: copies, other units."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gmds.cli.output import note

if TYPE_CHECKING:
    from gmds.atlases.registered import Atlas


def tell_of_copies(atlas: Atlas) -> None:
    """Say which specimens are one shape."""
    from gmds.specimens.twins import same_shapes

    for same in same_shapes(atlas.names, atlas.superposition.aligned):
        *others, last = same
        note(f"gmds: {', '.join(others)} and {last} are the same shape, which counts {len(same)} times below")


def tell_of_doubt(atlas: Atlas) -> None:
    """Say on which specimens maps disagree, and what to do about it."""
    from gmds.atlases.error_bars import FAR, doubtful

    more = "let others have a vote (--templates 3)" if len(atlas.templates) == 1 else "look at their maps"
    for name, share in doubtful(atlas.names, atlas.spread, atlas.valid).items():
        note(f"gmds: maps disagree on {name}: {share:.0%} of its points may be off by {FAR} root areas; {more}")


def tell_of_units(atlas: Atlas, so_what: str) -> None:
    """Say which specimens are as large or small as in other units, and what that does."""
    from gmds.specimens.units import in_other_units

    for name, times in in_other_units(atlas.names, atlas.superposition.sizes).items():
        note(f"gmds: {name} is {times:.3g} times as large as the median: in other units? {so_what}")
