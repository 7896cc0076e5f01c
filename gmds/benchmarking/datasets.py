"""Published benchmark folders, each in its publisher's own format, as pairs with truth.

Nothing is copied or downloaded: a folder is given by its path, and recognised by what is in it.
"""

from __future__ import annotations

import functools
import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from geodesics.arrays import Integers
from geodesics.errors import FormatError
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.benchmarking.truth_files import (
    BadTruth,
    missing_landmarks,
    points_at,
    read_truth_npz,
    read_vts,
    shared_landmarks,
)
from gmds.files.text import read_text

Truth = tuple[Integers, SurfacePoints, SurfacePoints | None]
TruthReader = Callable[[Mesh, Mesh], Truth]


LARGEST = 1 << 26  # bytes of a listing
ENTRY = ("name", "source", "target", "truth", "group")  # of a pair in pairs.json


class UnknownDataset(FormatError):
    """A folder that is none of the known benchmarks, or lists pairs that are not there."""

    code = "E230"


@dataclass(frozen=True)
class Pair:
    """Two mesh files and their truth.

    `truth(source, target)` gives source vertices (p,), p points of the target, and p flipped points, or None for these.
    `missing()` gives source vertices (q,) that have no counterpart in the target, where the data says so.
    """

    name: str
    source: Path
    target: Path
    truth: TruthReader
    group: str = ""
    missing: Callable[[], Integers] | None = None


def dataset_pairs(folder: Path, listing: Path | None = None) -> list[Pair]:
    """The pairs of a benchmark folder, in the published order, or those named in the file `listing`.

    Known: `corres/*.vts` with `test_pairs.txt` (remeshed FAUST and TOSCA), `pairs.json` (locally scaled pairs),
    `models` + `gts` + `test-sets` (SHREC'20). A listing has two shape names a line; for `pairs.json`, one pair name.
    Raises `UnknownDataset`.
    """
    folder = Path(folder)
    if (folder / "corres").is_dir():
        return [_vts_pair(folder, *names) for names in _listed(listing or folder / "test_pairs.txt", 2)]
    if (folder / "pairs.json").is_file():
        return _scaled_pairs(folder, listing)
    if (folder / "gts").is_dir() and (folder / "models").is_dir():
        listings = [listing] if listing else sorted((folder / "test-sets").glob("*.txt"))
        return [_shrec_pair(folder, file.stem, *names) for file in listings for names in _listed(file, 2)]
    raise UnknownDataset(f"{folder} has neither corres/, pairs.json nor gts/ + models/: not a known benchmark folder")


def _listed(file: Path, columns: int) -> list[Sequence[str]]:
    """The names on each line of a listing, separated by blanks or commas."""
    rows = [re.split(r"[\s,;]+", line.strip()) for line in _text(file).splitlines()]
    rows = [row for row in rows if row != [""] and not row[0].startswith("#")]
    for number, row in enumerate(rows, start=1):
        if len(row) != columns:
            raise UnknownDataset(f"{file}, entry {number}: {' '.join(row)!r} should be {columns} names")
    return list(rows)


def _text(file: Path) -> str:
    try:
        return read_text(file, UnknownDataset, LARGEST)
    except UnicodeDecodeError as error:
        raise UnknownDataset(f"{file} is not UTF-8 text ({error})") from error


def _vts_pair(folder: Path, source: str, target: str) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        paths = [folder / "corres" / f"{name}.vts" for name in (source, target, f"{target}.sym")]
        from_, to = read_vts(paths[0]), read_vts(paths[1])
        flipped = read_vts(paths[2]) if paths[2].exists() else None
        if len(from_) != len(to) or (flipped is not None and len(flipped) != len(to)):
            raise BadTruth(
                f"{paths[0]} and {paths[1]} (or its .sym) differ in length: they must share canonical points"
            )
        return from_, SurfacePoints.at_vertices(target_mesh, to), points_at(target_mesh, flipped)

    return Pair(f"{source}-{target}", folder / f"{source}.off", folder / f"{target}.off", truth)


def _scaled_pairs(folder: Path, listing: Path | None) -> list[Pair]:
    file = folder / "pairs.json"
    try:
        listed = [{"group": "", **entry} for entry in json.loads(_text(file))]
        entries = {entry["name"]: {key: entry[key] for key in ENTRY} for entry in listed}
    except (json.JSONDecodeError, TypeError, KeyError, RecursionError) as error:
        raise UnknownDataset(f"{file} is not a list of pairs, each with {', '.join(ENTRY)} ({error!r})") from error
    for name, entry in entries.items():
        if not all(isinstance(value, str) for value in entry.values()):
            raise UnknownDataset(f"{file}, pair {name!r}: {', '.join(ENTRY)} must be text")
    names = [row[0] for row in _listed(listing, 1)] if listing else list(entries)
    unknown = [name for name in names if name not in entries]
    if unknown:
        raise UnknownDataset(f"{listing} names {unknown[0]!r}, which pairs.json does not have")
    return [_scaled_pair(folder.parent, entries[name]) for name in names]


def _scaled_pair(root: Path, entry: dict[str, str]) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        from_, to, flipped = read_truth_npz(root / entry["truth"])
        return from_, SurfacePoints.at_vertices(target_mesh, to), points_at(target_mesh, flipped)

    return Pair(entry["name"], root / entry["source"], root / entry["target"], truth, entry["group"])


def _shrec_pair(folder: Path, group: str, source: str, target: str) -> Pair:
    here, there = (folder / "gts" / f"{name}.mat" for name in (source, target))

    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        return *shared_landmarks(here, there, target_mesh), None

    source_file, target_file = (folder / "models" / f"{name}.obj" for name in (source, target))
    missing = functools.partial(missing_landmarks, here, there)
    return Pair(f"{source}-{target}", source_file, target_file, truth, group, missing)
