"""Which specimens serve as templates: those to which the others are nearest, by bounds that need no map."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import combinations
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.io import atomic_write
from gmds.batch.collection import Shape
from gmds.batch.records import Failure
from gmds.comparison.profiles import distance_profile, least_distortion
from gmds.files.npz import read_npz
from gmds.maps.npz_format import fingerprint

Progress = Callable[[str, float], None]


def profiles(
    shapes: Mapping[str, Shape], store: Path, report: Progress
) -> tuple[dict[str, Floats], dict[str, Failure]]:
    """The distance profile of each shape, kept in the folder `store`; and why some have none."""
    store.mkdir(parents=True, exist_ok=True)
    found: dict[str, Floats] = {}
    failures: dict[str, Failure] = {}
    for number, (name, shape) in enumerate(shapes.items()):
        report(f"measuring {name}", number / len(shapes))
        try:
            mesh = shape.mesh()
            kept = store / f"{fingerprint(mesh)['sha256'][:32]}.npy"
            found[name] = _kept(kept)
            if not len(found[name]):
                found[name] = distance_profile(mesh)
                with atomic_write(kept) as stream:
                    np.savez(stream, profile=found[name])
        except Exception as error:  # whatever is wrong with one mesh, the others go on
            failures[name] = Failure.of(error)
            found.pop(name, None)
    return found, failures


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
    bounds = np.zeros((len(names), len(names)))
    for i, j in combinations(range(len(names)), 2):
        bounds[i, j] = bounds[j, i] = least_distortion(known[names[i]], known[names[j]])
    chosen: list[int] = []
    nearest = np.full(len(names), np.inf)
    while len(chosen) < min(count, len(names)):
        sums = np.minimum(bounds, nearest).sum(axis=1)
        sums[chosen] = np.inf
        chosen.append(int(sums.argmin()))
        nearest = np.minimum(nearest, bounds[chosen[-1]])
    return tuple(names[i] for i in chosen)
