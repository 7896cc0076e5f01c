"""What benchmarks/results/trust.md says of the model of confidence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from benchmarks.markdown import table
from benchmarks.trust.judged import JudgedMap, counts_of
from benchmarks.trust.model import calibration_error, ranked, reliability
from geodesics.arrays import Bools, Floats, Integers
from gmds.maps.confidence import RADIUS
from gmds.maps.doubt import DOUBT
from gmds.matching.rating import status_of

FAR = 0.1  # error in root areas of points that the ROC is of
RIGHT, WRONG = 4.0, 10.0  # mean errors x100: maps below are right, maps above are wrong
STATUSES = ("GOOD", "AMBIGUOUS", "POOR")
WRONG_THERE, LEAST_REGION = 0.2, 0.02  # error of the points of a region that counts as wrong, and its share of them
FEWEST, NEIGHBOURS = 3, 7  # points of a region; points that a point hangs together with

Confidences = Mapping[str, Floats]


def page(maps: Sequence[JudgedMap], fitted: Confidences, apart: Confidences) -> list[str]:
    """All of it: `fitted` on the development half, and for each map fitted to all maps but those of its kind."""
    reporting = [one for one in maps if one.half == "reporting"]
    return [
        "# How sure a map is of itself",
        "",
        "`python -m benchmarks.trust.collect FOLDER; python -m benchmarks.trust.fit FOLDER --write`; the scripts say",
        "how. The model was fitted to half of the maps of each kind; figures are of the others, and, *left out whole*,",
        "of all maps of a kind by a model that was fitted without that kind.",
        "",
        *_by_kind(reporting, fitted, maps, apart),
        "## Reliability",
        "",
        *table(
            ("mean confidence", "share within 0.05", "of all points", "left out whole: confidence", "share", "of all"),
            _two(reporting, fitted, maps, apart),
        ),
        *_statuses(maps, apart),
        *_regions(maps, apart),
    ]


def _by_kind(
    reporting: Sequence[JudgedMap], fitted: Confidences, maps: Sequence[JudgedMap], apart: Confidences
) -> list[str]:
    head = ("kind", "maps", "mean error x100", "within 0.05", "mean confidence", "calibration error", "ROC area")
    rows = []
    for kind in [None, *sorted({one.kind for one in maps})]:
        row: list[object] = [kind or "**all**"]
        for chosen, confidences in ((reporting, fitted), (maps, apart)):
            some = [one for one in chosen if kind in (None, one.kind)]
            row += _figures(some, confidences) if some else [0, "", "", "", "", ""]
        rows.append(row)
    return table((*head, *(f"left out whole: {name}" for name in head[1:])), rows)


def _figures(maps: Sequence[JudgedMap], confidences: Confidences) -> list[object]:
    p, error, counts = pooled(maps, confidences)
    near = error <= RADIUS
    area = ranked(p, error > FAR)
    return [
        len(maps),
        f"{100 * np.average(error, weights=counts):.1f}",
        f"{np.average(near, weights=counts):.2f}",
        f"{np.average(p, weights=counts):.2f}",
        f"{calibration_error(p, near, counts):.3f}",
        "-" if np.isnan(area) else f"{area:.2f}",
    ]


def pooled(maps: Sequence[JudgedMap], confidences: Confidences) -> tuple[Floats, Floats, Floats]:
    """Confidence, error, and how much it counts, of the valid points of all maps; see `counts_of`."""
    p = np.concatenate([confidences[one.name][one.valid] for one in maps])
    return p, np.concatenate([one.error[one.valid] for one in maps]), counts_of(maps)


def _two(
    reporting: Sequence[JudgedMap], fitted: Confidences, maps: Sequence[JudgedMap], apart: Confidences
) -> list[list[str]]:
    found = []
    for chosen, confidences in ((reporting, fitted), (maps, apart)):
        p, error, counts = pooled(chosen, confidences)
        found.append([[f"{value:.2f}" for value in row] for row in reliability(p, error <= RADIUS, counts)])
    return [[*a, *b] for a, b in zip(*found, strict=False)]


def _statuses(maps: Sequence[JudgedMap], apart: Confidences) -> list[str]:
    """What right and wrong maps are called, by models that never saw their kind."""
    error = np.array([100 * one.error[one.valid].mean() if one.valid.any() else np.inf for one in maps])
    told = np.array([_status(one, apart[one.name]) for one in maps])
    kinds: dict[str, Bools] = {
        f"right (mean error below {RIGHT:g})": error < RIGHT,
        "between": (error >= RIGHT) & (error <= WRONG),
        f"wrong (above {WRONG:g})": error > WRONG,
    }
    rows = [
        [name, int(some.sum()), *(int((told[some] == one).sum()) for one in STATUSES)] for name, some in kinds.items()
    ]
    odd = [
        f"{one.name}: {status}, mean error {value:.1f}"
        for one, status, value in zip(maps, told, error, strict=True)
        if (status == "GOOD" and value > WRONG) or (status != "GOOD" and value < RIGHT)
    ]
    return [
        "## Status, of kinds that were left out whole",
        "",
        *table(("maps", "how many", *STATUSES), rows),
        f"Not as they should be: {'; '.join(odd)}.",
        "",
    ]


def _status(one: JudgedMap, confidence: Floats) -> str:
    """As `rating.status_of` has it; what was POOR looked wrong."""
    expected = float(confidence[one.valid].mean()) if one.valid.any() else 0.0
    return status_of(expected, one.margin, badly_kept=one.status == "POOR").name


def _regions(maps: Sequence[JudgedMap], apart: Confidences) -> list[str]:
    """How many of the regions that are wrong are doubtful, and how much of right maps is."""
    named = [bool((apart[one.name][rows] < DOUBT).mean() >= 0.5) for one in maps for rows in _wrong_regions(one)]
    right = [
        float((apart[one.name][one.valid] < DOUBT).mean())
        for one in maps
        if one.valid.any() and 100 * one.error[one.valid].mean() < RIGHT
    ]
    return [
        "## Doubtful regions, of kinds that were left out whole",
        "",
        f"Of {len(named)} regions of more than {LEAST_REGION:.0%} of the points with an error above {WRONG_THERE}, "
        f"{sum(named)} are doubtful for the most part (confidence below {DOUBT}). "
        f"Of right maps {np.mean(right):.1%} of the points are, in the mean.",
        "",
    ]


def _wrong_regions(one: JudgedMap) -> list[Integers]:
    """Connected points that are far off, as many as count."""
    n, wrong = len(one.error), one.valid & (one.error > WRONG_THERE)
    near = cKDTree(one.positions).query(one.positions, k=min(NEIGHBOURS, n))[1]
    a, b = np.repeat(np.arange(n), near.shape[1]), near.ravel()
    kept = wrong[a] & wrong[b]
    graph = coo_matrix((np.ones(kept.sum()), (a[kept], b[kept])), shape=(n, n))
    labels = connected_components(graph, directed=False)[1]
    counts = np.bincount(labels, wrong)
    return [
        np.flatnonzero((labels == label) & wrong) for label in np.flatnonzero(counts >= max(LEAST_REGION * n, FEWEST))
    ]
