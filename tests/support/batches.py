"""What the tests of batches share: a small collection, a cluster, and the files of an output folder."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

from generated_shapes import bumpy_sphere

from geodesics import Mesh

SAME = ("pairs/*.npz", "shapes/*.npz", "summary.csv", "cycles.csv")  # whatever happened on the way


def collection() -> dict[str, Mesh]:
    """Four shapes of 42 vertices: a match takes a second."""
    return {f"s{i}": bumpy_sphere(1, seed=i) for i in range(4)}


def tree(folder: Path) -> dict[str, bytes]:
    """The files that do not tell when and how they were made."""
    found = sorted(path for pattern in SAME for path in folder.glob(pattern))
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


def worker_pids(client: object) -> Iterator[int]:
    """The processes of a cluster on this machine."""
    for nanny in client.cluster.workers.values():  # type: ignore[attr-defined]
        if nanny.pid is not None:
            yield nanny.pid


def deadly(mesh: Mesh) -> None:
    """A distance that ends the process that measures it."""
    os.kill(os.getpid(), signal.SIGKILL)
