"""What workers do: measure one shape, match one pair. Files in, files out; a failure is a value, not an exception."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from gmds.batch.collection import Shape
from gmds.batch.deadline import deadline
from gmds.batch.existing_maps import Expected, pair_record
from gmds.batch.records import Failure, PairRecord, ShapeRecord
from gmds.batch.store import Store


@dataclass(frozen=True, eq=False)
class ShapeJob:
    """A shape to be measured and stored; `mirrored`: its mirror image as well."""

    shape: Shape
    store: Store
    mirrored: bool = False


@dataclass(frozen=True, eq=False)
class PairJob:
    """Two stored shapes to be matched, with `options` of `match`, within `timeout` seconds; the map goes to `path`."""

    source: ShapeRecord
    target: ShapeRecord
    store: Store
    path: Path
    expected: Expected
    options: Mapping[str, Any]
    timeout: float | None = None


def measure_shape(job: ShapeJob) -> ShapeRecord:
    """Read, measure and store a shape, unless it is stored already."""
    started = time.process_time()
    try:
        record = job.store.keep(job.shape, job.mirrored)
    except Exception as error:
        return ShapeRecord(job.shape.name, failure=Failure.of(error))
    return replace(record, seconds=time.process_time() - started)


def match_pair(job: PairJob) -> PairRecord:
    """Match two stored shapes and write the map. What differs from run to run, its time, is not written with it."""
    from gmds.matching.pipeline import match

    started = time.process_time()
    record = PairRecord(job.source.name, job.target.name, "failed")
    try:
        with deadline(job.timeout, job.path) as progress:
            surfaces = job.store.surface(job.source), job.store.surface(job.target)
            answer = match(*surfaces, progress=progress, **job.options)
            meta = {key: value for key, value in answer.meta.items() if key != "seconds"}
            replace(answer, meta=meta).save(job.path)
        found = pair_record(job.path, job.source.name, job.target.name, job.expected)
    except Exception as error:
        return replace(record, failure=Failure.of(error), seconds=time.process_time() - started)
    if found is None:
        return replace(record, failure=Failure("E502", f"{job.path} does not hold what was written to it"))
    return replace(found, seconds=time.process_time() - started, kept=False)
