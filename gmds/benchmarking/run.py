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
from gmds.benchmarking.overlap import overlap_figures
from gmds.benchmarking.pairs import Pair
from gmds.correspondence import Correspondence
from gmds.evaluation import coverage, geodesic_error, protocol_subset, summary
from gmds.files.table import write_table

Matcher = Callable[..., Correspondence]

RANKED = 500  # true points on which `distortion` and error are ranked; set by hand: each costs a march, and a rank
# correlation of 500 pairs has a standard error below 0.05


@dataclass(frozen=True)
class BenchmarkRow:
    """What came of one pair; all figures are None when it failed.

    Attributes
    ----------
    pair, group, status : str
        Its name, what averages are taken over, and the status of the map or why there is none.
    direct, sym, best : float
        Mean error x100 against the truth, against the truth with left and right exchanged (None where the data has
        none), and the better of the two.
    within_005, within_010, within_025 : float
        Percentages of points within 0.05, 0.10 and 0.25 of the truth.
    coverage : float
        The percentage of the target's area that is hit.
    cpu_seconds : float
        Of the matcher.
    distortion_correlation : float
        Spearman's rank correlation of the map's `distortion` with the true error; None where either is constant.
    valid : float
        The percentage of the source vertices with a true counterpart that the map calls valid.
    missing_found : float
        The percentage of those known to have none that it calls invalid; None where the data names none.
    overlap_iou, valid_precision, valid_recall : float
        Percentages, of vertices with a known answer: of those called valid or with a counterpart, how many are both; of
        those called valid, how many have one; of those that have one, how many are called valid. None where the data
        does not say what is missing.
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
    overlap_iou: float | None = None
    valid_precision: float | None = None
    valid_recall: float | None = None


FIGURES = tuple(column.name for column in fields(BenchmarkRow) if column.default is None)


def benchmark(pairs: Iterable[Pair], matcher: Matcher, *, seed: int = 0) -> Iterator[BenchmarkRow]:
    """Judge a matcher on many pairs, each mesh turned and resized at random first.

    Parameters
    ----------
    pairs : iterable of Pair
        As `dataset_pairs` gives them.
    matcher : function
        Of two meshes: a `Correspondence`, as `gmds.match` returns it.
    seed : int
        With the name of a pair it decides how its meshes are turned and resized, whatever the other pairs are.

    Yields
    ------
    BenchmarkRow
        For each pair, as soon as it is done. A pair that fails is told in its row, and the rest go on.

    See Also
    --------
    means : The rows of averages.
    write_csv : The table.
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
    missing = None if pair.missing is None else pair.missing()
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
        **overlap_figures(answer.valid, indices, missing),
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
    """The mean of every figure.

    Parameters
    ----------
    rows : iterable of BenchmarkRow
        Pairs that failed count in the status only.

    Returns
    -------
    list of BenchmarkRow
        One for each group, and one for all when there are several.
    """
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
    """Write rows as a table.

    Parameters
    ----------
    path : path
        The file is the old one or the new one, never half of one.
    rows : iterable of BenchmarkRow
        Text in them that a spreadsheet would run as a formula is quoted.

    Raises
    ------
    OSError
        When the file cannot be written.
    """
    head = [column.name for column in fields(BenchmarkRow)]
    write_table(path, head, (list(asdict(row).values()) for row in rows), digits=6)
