"""What happened, a line of JSON each, and the summary of how things stand."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from gmds.batch.records import PairRecord
from gmds.files.table import write_table


class Manifest:
    """A file that every run appends to: `run`, `shape`, `pair` and `end` events with times, tries and failures.

    Each line is JSON on its own; a line that was cut short by the end of a process harms no other.
    """

    def __init__(self, path: Path) -> None:
        self._file = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        self._line = "\n" if _is_cut_short(path) else ""

    def tell(self, event: str, content: Mapping[str, Any]) -> None:
        """Add an event, with the time."""
        text = json.dumps({"event": event, "time": time.strftime("%Y-%m-%dT%H:%M:%S%z"), **content}, allow_nan=False)
        os.write(self._file, f"{self._line}{text}\n".encode())
        self._line = ""

    def close(self) -> None:
        """No more events."""
        os.close(self._file)


def _is_cut_short(path: Path) -> bool:
    with path.open("rb") as stream:
        if stream.seek(0, os.SEEK_END) == 0:
            return False
        stream.seek(-1, os.SEEK_END)
        return stream.read(1) != b"\n"


def event(record: Any) -> dict[str, Any]:
    """The fields of a record that are known, as the manifest has them."""
    return {key: value for key, value in asdict(record).items() if value is not None and value != ""}


def write_summary(path: Path, records: Iterable[PairRecord]) -> None:
    """One row a pair, atomically; no row says anything that an undisturbed run would say differently."""
    head = list(PairRecord("", "").cells())
    write_table(path, head, (list(record.cells().values()) for record in records), digits=6)
