"""Specimens registered to one another, from where a first atlas has them: what the group knows and no template says.

Maps through a template carry its errors. Each specimen is registered again, directly, from some of the others
(`gmds.matching.settling`), which is cheap where the atlas is nearly right; what they all say is brought together by
`gmds.atlases.links`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geodesics.arrays import Bools, Floats, Integers
from geodesics.io import atomic_write
from gmds.atlases.fusion import Fused
from gmds.atlases.links import Link
from gmds.batch.records import ShapeRecord
from gmds.batch.store import Store
from gmds.files.npz import read_npz
from gmds.matching.settling import CommonPoints, settled_places
from gmds.provenance import versions

# Specimens besides the template, for them to be registered from each other: of three coarse animals growth is blurred
# by it (tests/gmds/atlases/test_atlas.py), and that of the ears of four with 300 vertices (examples/study); on FAUST
# there were five.
FEWEST = 4


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


def linked(job: Job, source: Fused, target: Fused) -> Link | None:
    """The link that a job made, its two specimens being where the job had them; None when it could not be made.

    It is trusted as far as the places from which it started.
    """
    places = kept(job)
    if places is None:
        return None
    valid, trust = source.valid & target.valid, np.minimum(source.trust, target.trust)
    return Link(job.common.here, places, job.common.faces, valid, trust)


def common_points(source: Fused, target: Fused, faces: Integers) -> CommonPoints:
    """The points that two specimens have in common, with the faces of which both have all corners."""
    there: Bools = source.valid & target.valid
    return CommonPoints(source.places, target.places, faces if there.all() else faces[there[faces].all(axis=1)])


def neighbours_of(names: Sequence[str], count: int, template: str) -> list[tuple[str, str]]:
    """Pairs (source, target): each specimen but the template from `count` others, evenly spread over the names.

    None where there would be fewer than `FEWEST` of them.
    """
    others = [name for name in names if name != template]
    count = min(count, len(others) - 1)
    if count < 1 or len(others) < FEWEST:
        return []
    steps = [1 + i * (len(others) - 1) // count for i in range(count)]
    return [(others[(i + step) % len(others)], name) for i, name in enumerate(others) for step in steps]
