"""Specimens registered to one another, from where a first atlas has them: what the group knows and no template says.

Maps through a template carry its errors. Each specimen is registered again, directly, from some of the others
(`gmds.matching.settling`), which is cheap where the atlas is nearly right; what they all say of it is brought together.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats
from geodesics.io import atomic_write
from gmds.atlases.fusion import Fused, Said, fused
from gmds.batch.records import ShapeRecord
from gmds.batch.store import Store
from gmds.batch.workers import outcomes
from gmds.files.npz import read_npz
from gmds.matching.settling import CommonPoints, settled_places
from gmds.provenance import versions

Progress = Callable[[str, float], None]

# Neighbours that have a say. Four were measured on FAUST (`benchmarks/results/atlas.md`); one or two, in collections of
# a few small meshes, made an atlas no better.
FEWEST = 3


@dataclass(frozen=True, eq=False)
class Job:
    """One specimen to be registered to another; the places found go to `path`, under a `key` of all they depend on."""

    source: ShapeRecord
    target: ShapeRecord
    store: Store
    common: CommonPoints
    path: Path

    @property
    def key(self) -> str:
        """A digest of both surfaces, of where the common points are on them, and of the version of all this."""
        digest = hashlib.sha256(f"{self.source.key} {self.target.key} {sorted(versions().items())}".encode())
        for array in (self.common.here, self.common.there, self.common.faces):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()


def settle(job: Job) -> None:
    """Register and write, unless that was done before."""
    if kept(job) is None:
        places = settled_places(job.store.surface(job.source), job.store.surface(job.target), job.common)
        with atomic_write(job.path) as stream:
            np.savez(stream, places=places, key=np.array(job.key, dtype=np.str_))


def kept(job: Job) -> Floats | None:
    """What was written before (n, 3); None when it is not there, not whole, or of other surfaces or places."""
    try:
        read = read_npz(job.path)
        places = np.asarray(read["places"], dtype=np.float64)
        return places if str(read["key"]) == job.key and places.shape == job.common.there.shape else None
    except (ValueError, KeyError, OSError):
        return None


def neighbours_of(names: Sequence[str], count: int, template: str) -> list[tuple[str, str]]:
    """Pairs (source, target): each specimen but the template from `count` others, evenly spread over the names.

    None where there would be fewer than `FEWEST` for each.
    """
    others = [name for name in names if name != template]
    count = min(count, len(others) - 1)
    if count < FEWEST:
        return []
    steps = np.linspace(1, len(others) - 1, count).round().astype(int).tolist()
    return [(others[(i + step) % len(others)], name) for i, name in enumerate(others) for step in steps]


def with_neighbours(
    rows: Mapping[str, Fused], jobs: Iterable[Job], mesh: Callable[[str], Mesh], client: Any, report: Progress
) -> dict[str, Fused]:
    """What is said of each specimen, together with what its neighbours say; the others stay as they are.

    Which points there are, is what the maps of the templates say. A pair that cannot be registered has no say.
    """
    jobs = list(jobs)
    for number, _ in enumerate(outcomes(client, settle, jobs), start=1):
        report(f"{number} of {len(jobs)} specimens registered to others", number / len(jobs))
    said: dict[str, list[Said]] = {}
    for job in jobs:
        source, target, places = rows[job.source.name], rows[job.target.name], kept(job)
        if places is not None:
            account = Said(places, source.valid & target.valid, source.trust)
            said.setdefault(job.target.name, [target.said]).append(account)
    found = {name: fused(one, mesh(name))._replace(valid=rows[name].valid) for name, one in said.items()}
    return {name: found.get(name, row) for name, row in rows.items()}
