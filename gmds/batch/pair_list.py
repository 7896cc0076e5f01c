"""A list of pairs of files, or of files: plain text that people write."""

from __future__ import annotations

import csv
from pathlib import Path

from gmds.errors import BadPairList
from gmds.files.folders import is_mesh_file
from gmds.files.text import read_text

LARGEST = 1 << 28  # bytes: a bound, millions of pairs
HEADER = ("source", "target")


def read_list(path: Path) -> tuple[list[Path], list[tuple[Path, Path]] | None]:
    """The files named in a list, each once, and the pairs of them, or None where every line names a single file.

    A line is `A,B` as CSV, or one file; paths are relative to the list. Empty lines, lines that start with `#` and a
    first line `source,target` do not count. Raises `BadPairList` (E214) naming the line, `OSError`.
    """
    if path.exists() and not path.is_file():
        raise BadPairList(f"{path} is neither a folder nor a file")
    if is_mesh_file(path):
        raise BadPairList(f"{path} is one mesh; name a folder of meshes, or a list of their files")
    try:
        lines = read_text(path, BadPairList, LARGEST).splitlines()
    except UnicodeDecodeError as error:
        raise BadPairList(f"{path} is not UTF-8 text ({error})") from error
    rows: list[tuple[Path, ...]] = []
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        cells = tuple(cell.strip() for cell in next(csv.reader([line])))
        if not rows and tuple(cell.casefold() for cell in cells) == HEADER:
            continue
        if not all(cells) or len(cells) > 2 or "\0" in line:
            raise BadPairList(f"{path}, line {number}: expected A,B or one file, found {line[:80]!r}")
        rows.append(tuple(path.parent / cell for cell in cells))
        if len(rows[-1]) != len(rows[0]):
            raise BadPairList(f"{path}, line {number}: {len(rows[-1])} files, where the first line has {len(rows[0])}")
    if not rows:
        raise BadPairList(f"{path} names no file")
    files = list(dict.fromkeys(file for row in rows for file in row))
    return files, [(row[0], row[1]) for row in rows] if len(rows[0]) == 2 else None
