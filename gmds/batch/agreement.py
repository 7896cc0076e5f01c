"""Whether the maps in an output folder agree: they are read, taken around triangles, and what is found is written."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Integers
from gmds.batch.cycles import CarriedMap, Consistency, Pair, consistency
from gmds.batch.records import PairRecord, ShapeRecord
from gmds.batch.store import Store
from gmds.files.table import write_table

SAMPLES = 300  # of each shape, that go around: as many as `match` places
IN_MEMORY = 4096  # maps at a time: a bound of memory, 65 bytes a vertex each
SHAPES_IN_MEMORY = 256  # a bound likewise, 72 bytes a vertex each


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
    rows = ((str(cycle), cycle.mean, cycle.within_005, cycle.within_010) for cycle in found.cycles)
    write_table(path, ["cycle", "mean", "within_005", "within_010"], rows, digits=6)
