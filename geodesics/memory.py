"""Tables that would not fit into memory are refused before they are allocated."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import WouldExceedMemory

WORTH_ASKING = 100_000_000  # bytes; smaller tables are allocated unchecked, as no machine lacks them. A convention
SHARE = 0.9  # of the free memory that one table may take. A convention: the rest is for what is computed beside it


def table(rows: int, columns: int, what: str, instead: str) -> Floats:
    """An empty table (rows, columns) of float64. Raises `WouldExceedMemory` (E501) when it does not fit."""
    must_fit(rows * columns, f"{what}, {rows} x {columns} numbers,", instead)
    return np.empty((rows, columns))


def must_fit(numbers: int, what: str, instead: str) -> None:
    """Raise `WouldExceedMemory` (E501) when so many float64 do not fit."""
    needed = 8 * numbers
    if needed > WORTH_ASKING and needed > (free := SHARE * available()):
        raise WouldExceedMemory(f"{what} need {needed / 1e9:.1f} GB, and {free / 1e9:.1f} GB are free; {instead}")


def available() -> float:
    """Bytes that can be allocated now: what the system and the control group have left; inf where neither says."""
    return min(_of_the_system(), _of_the_group(Path("/sys/fs/cgroup")))


def _of_the_system() -> float:
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return next(1024.0 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration, ValueError):
        pass
    try:  # without /proc: half of the memory of the machine
        return 0.5 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return math.inf


def _of_the_group(folder: Path) -> float:
    try:
        limit, used = (int((folder / name).read_text(encoding="ascii")) for name in ("memory.max", "memory.current"))
    except (OSError, ValueError):  # no such group, or "max"
        return math.inf
    return max(0.0, float(limit - used))
