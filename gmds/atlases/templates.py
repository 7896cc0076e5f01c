"""Which specimens serve as templates: those to which the others are nearest, by bounds that need no map."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from geodesics.io import atomic_write
from gmds.batch.collection import Shape
from gmds.batch.lock import only_run
from gmds.batch.records import Failure
from gmds.batch.store import Store
from gmds.batch.workers import outcomes
from gmds.comparison.profiles import FUNCTIONS, least_distortion, profile_of_views
from gmds.files.npz import read_npz
from gmds.matching.large_surfaces import coarse
from gmds.surface.measured import EXPONENTS

Progress = Callable[[str, float], None]

# Shapes, evenly chosen, by the distances to which a medoid is found, so that time does not grow as the square of their
# number; set by hand.
ASKED = 40


@dataclass(frozen=True, eq=False)
class ProfileJob:
    """A shape that is to be measured and stored, and the folder that its profile goes to."""

    shape: Shape
    store: Store
    mirrored: bool
    folder: Path


def profiles(
    shapes: Sequence[Shape], maps: Path, folder: Path, mirrored: bool, client: Any, report: Progress
) -> tuple[dict[str, Floats], dict[str, Failure]]:
    """The distance profile of each shape, kept in `folder`; and why some have none.

    Workers measure shapes and keep them where `match_collection` finds them when it works in the folder `maps`;
    `mirrored`: their mirror images as well.
    """
    store = Store(maps / "shapes")
    for one in (folder, store.folder):
        one.mkdir(parents=True, exist_ok=True)
    found: dict[str, Floats] = {}
    failures: dict[str, Failure] = {}
    with only_run(maps):
        jobs = (ProfileJob(shape, store, mirrored, folder) for shape in shapes)
        for number, (job, said) in enumerate(outcomes(client, profile, jobs), start=1):
            if isinstance(said, Failure):
                failures[job.shape.name] = said
            else:
                found[job.shape.name] = said
            report(f"measured {job.shape.name}", number / len(shapes))
    return found, failures


def profile(job: ProfileJob) -> Floats:
    """Measure a shape, and describe it by its distances, unless that was done before; both are kept."""
    record = job.store.keep(job.shape, job.mirrored)
    path = job.folder / f"{record.key}.npz"
    found = _kept(path)
    if not len(found):
        surface = job.store.surface(record)
        found = profile_of_views([coarse(surface).curved(exponent).first(FUNCTIONS) for exponent in EXPONENTS])
        with atomic_write(path) as stream:
            np.savez(stream, profile=found)
    return found


def _kept(path: Path) -> Floats:
    try:
        return np.asarray(read_npz(path)["profile"], dtype=np.float64)
    except (ValueError, KeyError, OSError):
        return np.empty(0)


def medoids(known: Mapping[str, Floats], count: int) -> tuple[str, ...]:
    """The shape to which all others are nearest in sum, and `count` - 1 more, each of which makes most others nearer.

    By `least_distortion`; of equal ones the first by name.
    """
    names = sorted(known)
    asked = np.unique(np.linspace(0, len(names) - 1, min(ASKED, len(names))).round().astype(int))
    bounds = np.array([[least_distortion(known[one], known[names[j]]) for j in asked] for one in names])
    chosen: list[int] = []
    nearest = np.full(len(asked), np.inf)
    while len(chosen) < min(count, len(names)):
        sums = np.minimum(bounds, nearest).sum(axis=1)
        sums[chosen] = np.inf
        chosen.append(int(sums.argmin()))
        nearest = np.minimum(nearest, bounds[chosen[-1]])
    return tuple(names[i] for i in chosen)
