"""Maps that are there already: whether they are whole, and of these meshes and parameters."""

from __future__ import annotations

import json
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gmds.batch.records import PairRecord


@dataclass(frozen=True)
class Expected:
    """What the meta data of a map has to say for it to be the one that is wanted: a part of it, nested dicts."""

    meta: Mapping[str, Any]

    def met_by(self, found: Any) -> bool:
        """Whether all of it is found."""
        return _within(self.meta, found)


def pair_record(path: Path, source: str, target: str, expected: Expected) -> PairRecord | None:
    """The record of the map in a file; None when it is not there, not whole, or not the one that is wanted."""
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            arrays = dict(archive)  # reads all of it, which checks the sums
        meta = json.loads(arrays["meta"].tobytes().decode("utf-8"))
        n = meta["source"]["vertices"]
        if not expected.met_by(meta) or any(len(arrays[name]) != n for name in ("face", "barycentric", "vertex")):
            return None
        return PairRecord(
            source,
            target,
            meta["status"],
            float(arrays["valid"].mean()),
            float(np.median(arrays["distortion"])),
            meta["evidence"]["stress"],
            meta["evidence"]["margin"],
            kept=True,
        )
    except (OSError, EOFError, ValueError, KeyError, TypeError, RuntimeError, zipfile.BadZipFile, zlib.error):
        return None


def _within(part: Any, whole: Any) -> bool:
    if isinstance(part, Mapping):
        return isinstance(whole, Mapping) and all(key in whole and _within(part[key], whole[key]) for key in part)
    return bool(part == whole)
