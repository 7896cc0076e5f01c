"""What `gmds transfer` does with values, by what they are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.looks import COLOURS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from gmds import Correspondence

KINDS = ("numbers", "labels", "weights", "vectors", "colours")
METHODS = {
    "numbers": "by interpolation",
    "labels": "as labels",
    "weights": "by interpolation, rows summing to 1",
    "vectors": "turned as the map turns the surface",
    "colours": COLOURS,
}


def carried_values(answer: Correspondence, given: NDArray[Any], kind: str, most: int | None) -> NDArray[Any]:
    """Values of the target on the source, as their kind has it."""
    if kind == "weights":
        from gmds.maps.values import carry_weights

        return carry_weights(answer.points, given.reshape(len(given), -1), most=most)
    if kind == "vectors":
        from gmds.maps.vectors import carry_vectors

        return carry_vectors(answer, given)
    return answer.transfer(given, labels=kind == "labels")


def refuse_labels(given: NDArray[Any], file: Path) -> None:
    """A wrong use, where what is to be weights of bones is one column of whole numbers beyond 1: names of parts."""
    if given.size == len(given) and (given == given.round()).all() and given.max(initial=0) > 1:
        raise click.UsageError(
            f"{file} holds one column, of whole numbers up to {given.max():g}; weights have a column for each bone, "
            "and of one bone are from 0 to 1; labels are carried by --kind labels"
        )


def as_colours(given: NDArray[Any], file: Path) -> NDArray[np.uint8]:
    """Columns of a file as colours; a wrong use where they are none."""
    import numpy as np

    if given.ndim != 2 or given.shape[1] not in (3, 4) or not ((given >= 0) & (given <= 255)).all():
        raise click.UsageError(f"{file}: colours are three or four columns of numbers from 0 to 255")
    return np.rint(given).astype(np.uint8)
