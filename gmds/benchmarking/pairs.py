"""Two mesh files with their truth, and the listings that name them."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from geodesics.arrays import Integers
from geodesics.errors import FormatError
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.files.text import read_text

Truth = tuple[Integers, SurfacePoints, SurfacePoints | None]
TruthReader = Callable[[Mesh, Mesh], Truth]

LARGEST = 1 << 26  # bytes of a listing: a bound, far above the pairs of any benchmark


class UnknownDataset(FormatError):
    """A folder that is none of the known benchmarks, or lists pairs that are not there."""

    code = "E230"


@dataclass(frozen=True)
class Pair:
    """Two mesh files and their truth.

    Parameters
    ----------
    name : str
        As rows of tables have it.
    source, target : Path
        The mesh files.
    truth : function
        Of both meshes, once they are read: source vertices (p,), their p true points on the target, and p points
        with left and right exchanged, or None for these. Raises `BadTruth` (E231).
    group : str, optional
        What averages are taken over.
    missing : function, optional
        Without arguments: source vertices (q,) that are known to have no counterpart on the target, perhaps none; None
        where the data does not say.
    """

    name: str
    source: Path
    target: Path
    truth: TruthReader
    group: str = ""
    missing: Callable[[], Integers | None] | None = None


def listed(file: Path, columns: int) -> list[Sequence[str]]:
    """The names on each line of a listing, separated by blanks or commas."""
    rows = [re.split(r"[\s,;]+", line.strip()) for line in listing_text(file).splitlines()]
    rows = [row for row in rows if row != [""] and not row[0].startswith("#")]
    for number, row in enumerate(rows, start=1):
        if len(row) != columns:
            raise UnknownDataset(f"{file}, entry {number}: {' '.join(row)!r} should be {columns} names")
    return list(rows)


def listing_text(file: Path) -> str:
    """The content of a listing. Raises `UnknownDataset`, or `OSError` for what is no file."""
    try:
        return read_text(file, UnknownDataset, LARGEST)
    except UnicodeDecodeError as error:
        raise UnknownDataset(f"{file} is not UTF-8 text ({error})") from error
