"""Running a matcher over a published benchmark, one row a pair, every mesh turned and resized at random first."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from geodesics.mesh import Mesh
from gmds.benchmarking.pairs import Pair
from gmds.correspondence import Correspondence
from gmds.evaluation import coverage, geodesic_error, protocol_subset, summary
from gmds.files.table import write_table

Matcher = Callable[..., Correspondence]

RANKED = 500  # truth points, evenly spread over the list, on which `distortion` and error are ranked


@dataclass(frozen=True)
class BenchmarkRow:
    """One pair: a status, the mean error x100 against the truth, the flipped truth and the better of the two, the
    percentage within 0.10 of the truth, the percentage of the target's area that is hit, CPU seconds of the matcher.

    `within_005`, `within_025`: percentages like `within_010`. `distortion_correlation`: Spearman rank correlation of
    the map's `distortion` with the true error; None where either is constant. `valid`: the percentage of the source
    vertices with a true counterpart that the map calls valid. `missing_found`: the percentage of those known to have
    none that it calls invalid; None where the data names none. `sym` is None where the data has no flipped truth; all
    figures are None when the pair failed.
    """

    pair: str
    group: str
    status: str
    direct: float | None = None
    sym: float | None = None
    best: float | None = None
    within_010: float | None = None
    coverage: float | None = None
    cpu_seconds: float | None = None
    within_005: float | None = None
    within_025: float | None = None
    distortion_correlation: float | None = None
    valid: float | None = None
    missing_found: float | None = None


FIGURES = tuple(column.name for column in fields(BenchmarkRow) if column.default is None)


def benchmark(pairs: Iterable[Pair], matcher: Matcher, *, seed: int = 0) -> Iterator[BenchmarkRow]:
    """A row for each pair, as soon as it is done; a pair that fails is reported in its row and the rest go on.

    How a pair is turned and resized depends on its name and the seed, not on the pairs it is run with.
    """
    for pair in pairs:
        try:
            yield judged(pair, matcher, np.random.default_rng([seed, *pair.name.encode()]))
        except (ValueError, OSError, ArithmeticError, np.linalg.LinAlgError) as error:
            yield BenchmarkRow(pair.name, pair.group, f"failed: {error}")


def judged(pair: Pair, matcher: Matcher, rng: np.random.Generator) -> BenchmarkRow:
    """Read, turn and resize, match, and judge one pair on the protocol's 125 truth points."""
    from geodesics import read_mesh

    source, target = (turned(read_mesh(path), rng) for path in (pair.source, pair.target))
    indices, truth, flipped = pair.truth(source, target)
    started = time.process_time()
    answer = matcher(source, target)
    seconds = time.process_time() - started
    chosen = protocol_subset(len(indices))
    spread = np.union1d(chosen, protocol_subset(len(indices), RANKED))
    errors = geodesic_error(answer, truth[spread], indices[spread])
    direct = summary(errors[np.isin(spread, chosen)])
    sym = None if flipped is None else summary(geodesic_error(answer, flipped[chosen], indices[chosen])).mean
    missing = np.array([], dtype=np.int64) if pair.missing is None else pair.missing()
    return BenchmarkRow(
        pair.name,
        pair.group,
        answer.status.name,
        direct=direct.mean,
        sym=sym,
        best=direct.mean if sym is None else min(direct.mean, sym),
        within_010=direct.within_010,
        coverage=100 * coverage(answer),
        cpu_seconds=seconds,
        within_005=direct.within_005,
        within_025=direct.within_025,
        distortion_correlation=rank_correlation(answer.distortion[indices[spread]], errors),
        valid=100 * float(answer.valid[indices].mean()),
        missing_found=100 * float((~answer.valid[missing]).mean()) if len(missing) else None,
    )


def rank_correlation(x: Floats, y: Floats) -> float | None:
    """Spearman's rank correlation; None where either side is constant."""
    from scipy.stats import rankdata

    ranks = rankdata(x), rankdata(y)
    return None if min(map(np.ptp, ranks)) == 0 else float(np.corrcoef(*ranks)[0, 1])


def turned(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """The mesh turned at random and resized by a factor between 0.1 and 10."""
    rotation = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    return Mesh(mesh.vertices @ rotation.T * 10 ** rng.uniform(-1, 1), mesh.faces)


def means(rows: Iterable[BenchmarkRow]) -> list[BenchmarkRow]:
    """One row per group (and one for all when there are several) with the mean of every figure."""
    rows = list(rows)
    groups = sorted({row.group for row in rows})
    sets = [(group, [row for row in rows if row.group == group]) for group in groups]
    return [_mean(group or "all", members) for group, members in [*sets, *([("all", rows)] if len(groups) > 1 else [])]]


def _mean(name: str, rows: list[BenchmarkRow]) -> BenchmarkRow:
    done = [row for row in rows if row.direct is not None]
    figures: dict[str, Any] = {}
    for column in FIGURES:
        values = [value for row in done if (value := getattr(row, column)) is not None]
        figures[column] = float(np.mean(values)) if values else None
    return BenchmarkRow("mean", name, f"{len(done)} of {len(rows)} pairs done", **figures)


def write_csv(path: str | os.PathLike[str], rows: Iterable[BenchmarkRow]) -> None:
    """The rows as a table, written atomically; a cell that a spreadsheet would run as a formula is quoted."""
    head = [column.name for column in fields(BenchmarkRow)]
    write_table(path, head, (list(asdict(row).values()) for row in rows), digits=6)
