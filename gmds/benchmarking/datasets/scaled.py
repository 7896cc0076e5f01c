"""Locally scaled pairs, and parts: `pairs.json`, a list of pairs with files and groups; truth in .npz files."""

from __future__ import annotations

import functools
import json
from pathlib import Path

from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.benchmarking.pairs import Pair, Truth, UnknownDataset, listed, listing_text
from gmds.benchmarking.truth_files import points_at, read_missing_npz, read_truth_npz

ENTRY = ("name", "source", "target", "truth", "group")  # of a pair in pairs.json


def scaled(folder: Path, listing: Path | None = None) -> list[Pair] | None:
    """The pairs of a folder with `pairs.json`; None for another. A listing has the name of a pair a line."""
    file = folder / "pairs.json"
    if not file.is_file():
        return None
    try:
        rows = [{"group": "", **entry} for entry in json.loads(listing_text(file))]
        entries = {entry["name"]: {key: entry[key] for key in ENTRY} for entry in rows}
    except (json.JSONDecodeError, TypeError, KeyError, RecursionError) as error:
        raise UnknownDataset(f"{file} is not a list of pairs, each with {', '.join(ENTRY)} ({error!r})") from error
    for name, entry in entries.items():
        if not all(isinstance(value, str) for value in entry.values()):
            raise UnknownDataset(f"{file}, pair {name!r}: {', '.join(ENTRY)} must be text")
    names = [row[0] for row in listed(listing, 1)] if listing else list(entries)
    unknown = [name for name in names if name not in entries]
    if unknown:
        raise UnknownDataset(f"{listing} names {unknown[0]!r}, which pairs.json does not have")
    return [_pair(folder.parent, entries[name]) for name in names]


def _pair(root: Path, entry: dict[str, str]) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        from_, to, flipped = read_truth_npz(root / entry["truth"])
        return from_, SurfacePoints.at_vertices(target_mesh, to), points_at(target_mesh, flipped)

    missing = functools.partial(read_missing_npz, root / entry["truth"])
    return Pair(entry["name"], root / entry["source"], root / entry["target"], truth, entry["group"], missing)
