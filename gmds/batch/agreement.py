"""Whether the maps in an output folder agree: they are read, taken around triangles, and what is found is written."""

from __future__ import annotations

import csv
import functools
import io
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Integers
from geodesics.io import atomic_write
from gmds.batch.cycles import CarriedMap, Consistency, Pair, consistency
from gmds.batch.records import PairRecord, ShapeRecord
from gmds.batch.store import Store

SAMPLES = 300  # of each shape, that go around
IN_MEMORY = 4096  # maps
SHAPES_IN_MEMORY = 256


def agreement(
    folder: Path,
    store: Store,
    shapes: Mapping[str, ShapeRecord],
    pairs: Iterable[PairRecord],
    progress: Callable[[float], None] | None = None,
) -> Consistency:
    """How well the maps of the pairs agree, from what is in the folder and in the store."""

    @functools.lru_cache(SHAPES_IN_MEMORY)
    def shape(name: str) -> tuple[Mesh, Integers]:
        return store.outside(shapes[name], SAMPLES)

    @functools.lru_cache(IN_MEMORY)
    def load(pair: Pair) -> CarriedMap:
        (source, samples), (target, _) = map(shape, pair)
        with np.load(folder / f"{pair[0]}__{pair[1]}.npz", allow_pickle=False) as archive:
            points = SurfacePoints(target, archive["face"], archive["barycentric"])
            return CarriedMap.of(points, archive["valid"], samples, source.vertices)

    return consistency([(pair.source, pair.target) for pair in pairs], load, progress=progress)


def write_cycles(path: Path, found: Consistency) -> None:
    """A row a cycle, worst first, atomically."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["cycle", "mean", "within_005", "within_010"])
    for cycle in found.cycles:
        writer.writerow([cycle, *(f"{x:.6g}" for x in (cycle.mean, cycle.within_005, cycle.within_010))])
    with atomic_write(path) as stream:
        stream.write(text.getvalue().encode("utf-8", "replace"))
