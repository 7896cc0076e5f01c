"""The confidence of plain maps, fitted on development pairs and judged on the others.

    GMDS_DATA=... python -m benchmarks.accuracy.plain --half reporting --signs REPORTING
    GMDS_DATA=... python -m benchmarks.accuracy.plain --half development --cells LeastSquares --signs DEVELOPMENT
    GMDS_DATA=... python -m benchmarks.accuracy.development_pairs OUT
    GMDS_DATA=OUT python -m benchmarks.accuracy.plain --sets scaled --cells LeastSquares --signs DEVELOPMENT
    python -m benchmarks.trust.plain_signs DEVELOPMENT
    GMDS_DATA=... python -m benchmarks.trust.plain DEVELOPMENT REPORTING --scaled OUT [--write]

Nothing is registered, so that the signs mean something else than those of `benchmarks.trust.fit`: folds and strain are
those of the map itself. Writes results/trust_plain.md, and with --write the weights into
gmds/matching/plain_weights.py.
"""

from __future__ import annotations

import argparse
import functools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.accuracy.halves import pairs_of
from benchmarks.markdown import table
from benchmarks.places import RESULTS, ROOT
from benchmarks.trust.fit import HEAD
from benchmarks.trust.judged import JudgedMap, counts_of
from benchmarks.trust.model import Model, calibration_error, fitted
from benchmarks.trust.page import RIGHT, STATUSES, WRONG
from benchmarks.trust.plain_signs import JUDGED, key_of
from geodesics import GeodesicDistance, Mesh, embedded, read_mesh
from geodesics.arrays import Integers
from gmds.benchmarking.datasets import dataset_pairs
from gmds.benchmarking.pairs import Pair
from gmds.maps.confidence import RADIUS
from gmds.matching.rating import status_of

SETS = ("faust_5k", "tosca_5k", "tosca_cross_5k", "scaled", "shrec20")
WEIGHTS_FILE = ROOT / "gmds" / "matching" / "plain_weights.py"
# Few, as there are few pairs: what is local, and what the whole map costs. Chosen by the error of kinds left out.
CHOSEN = ("spectral", "stress", "folds", "strain", "folded", "rival", "whole_energy", "simplified_misfit")


def maps_of(folder: Path, pairs: Sequence[tuple[str, Pair]], half: str, names: Sequence[str]) -> list[JudgedMap]:
    """The maps that were kept in a folder, of pairs with their kinds, with their errors."""
    found, done = [], set()
    for kind, pair in pairs:
        source, target = read(pair.source), read(pair.target)
        files = sorted(folder.glob(f"{key_of(source, target)}_*.npz"))
        if not files or files[0] in done:  # a pair that is listed twice
            continue
        done.add(files[0])
        vertices, truth, _ = pair.truth(source, target)
        with np.load(files[0]) as first:
            shared, place, at = thinned(*np.intersect1d(first["rows"], vertices, return_indices=True))
        fields = GeodesicDistance(embedded(target)).field(truth[at]) / np.sqrt(target.area)
        for file in files:
            with np.load(file) as kept:
                there = list(map(str, kept["names"]))
                signs = kept["signs"][place][:, [there.index(name) for name in names]].astype(np.float64)
                corners = target.faces[kept["face"][place]]
                rows = np.arange(len(shared))[:, None]
                error = (fields[rows, corners] * kept["barycentric"][place]).sum(axis=1)
                name = f"{pair.name} {kept['cell']}"
                valid = np.ones(len(shared), dtype=bool)
                where = source.vertices[shared]
                found.append(JudgedMap(name, kind, half, "", signs, error, valid, where, float(kept["margin"])))
    return found


def thinned(*rows: Integers) -> list[Integers]:
    """About `JUDGED` of the rows, all over; all of them where there are fewer."""
    return [one[:: max(1, len(one) // JUDGED)] for one in rows]


@functools.lru_cache(150)
def read(path: Path) -> Mesh:
    """The mesh of a file, read once."""
    return read_mesh(path)


def built_in(folder: Path) -> list[JudgedMap]:
    """The maps of built-in shapes that `benchmarks.trust.plain_signs` wrote, all for development."""
    found = []
    for file in sorted(folder.glob("built-in_*.npz")):
        with np.load(file) as kept:
            there, error = list(map(str, kept["names"])), kept["error"]
            signs = kept["signs"][:, [there.index(name) for name in CHOSEN]].astype(np.float64)
            where, valid = np.zeros((len(error), 3)), np.ones(len(error), dtype=bool)
            found.append(
                JudgedMap(file.stem, "built-in", "development", "", signs, error, valid, where, float(kept["margin"]))
            )
    return found


def fit(maps: Sequence[JudgedMap]) -> Model:
    """The model of these maps."""
    error = np.concatenate([one.error for one in maps])
    return fitted(np.concatenate([one.signs for one in maps]), error <= RADIUS, counts_of(maps))


def told(one: JudgedMap, model: Model) -> str:
    """The status of a map by a model."""
    return status_of(float(model.confidence(one.signs).mean()), one.margin, badly_kept=False).name


def lines_of(title: str, maps: Sequence[JudgedMap], models: Sequence[Model]) -> list[str]:
    """Calibration and status of maps, each by its model."""
    confidence = np.concatenate([model.confidence(one.signs) for one, model in zip(maps, models, strict=True)])
    error = np.concatenate([one.error for one in maps])
    gap = calibration_error(confidence, error <= RADIUS, counts_of(maps))
    means = np.array([100 * one.error.mean() for one in maps])
    words = np.array([told(one, model) for one, model in zip(maps, models, strict=True)])
    kinds = {"right": means < RIGHT, "between": (means >= RIGHT) & (means <= WRONG), "wrong": means > WRONG}
    rows = [
        [name, int(some.sum()), *(int((words[some] == one).sum()) for one in STATUSES)] for name, some in kinds.items()
    ]
    odd = [
        f"{one.name}: {word}, {mean:.1f}"
        for one, word, mean in zip(maps, words, means, strict=True)
        if (word == "GOOD" and mean > WRONG) or (word == "POOR" and mean < RIGHT)
    ]
    said = f"Not as they should be: {'; '.join(odd)}." if odd else "All as they should be."
    head = (f"maps (right below {RIGHT:g}, wrong above {WRONG:g})", "how many", *STATUSES)
    return [f"## {title}", "", f"Calibration error {gap:.3f}.", "", *table(head, rows), said, ""]


def main() -> None:
    """Fit, judge, and write."""
    parser = argparse.ArgumentParser(description="The confidence of plain maps, fitted and judged.")
    parser.add_argument("development", type=Path)
    parser.add_argument("reporting", type=Path)
    parser.add_argument("--scaled", type=Path, help="where development_pairs wrote")
    parser.add_argument("--write", action="store_true", help="write gmds/matching/plain_weights.py")
    asked = parser.parse_args()
    published = [(name, pair) for name in SETS for pair in pairs_of(name)]
    made = [] if asked.scaled is None else [("scaled", pair) for pair in dataset_pairs(asked.scaled / "scaled")]
    ours = maps_of(asked.development, [*published, *made], "development", CHOSEN)
    ours += built_in(asked.development)
    theirs = maps_of(asked.reporting, published, "reporting", CHOSEN)
    model, kinds = fit(ours), sorted({one.kind for one in ours})
    without = {kind: fit([one for one in ours if one.kind != kind]) for kind in kinds}
    lines = [
        "# How sure a plain map is of itself",
        "",
        f"`python -m benchmarks.trust.plain`: there is how. Fitted to {len(ours)} maps of development pairs of "
        f"{', '.join(kinds)}. Reporting maps of other classes and species, which are wrong more often: plain.md.",
        "",
        *lines_of("Reporting pairs", theirs, [model] * len(theirs)),
        *lines_of("Development pairs, each kind by a model without it", ours, [without[one.kind] for one in ours]),
    ]
    if asked.write:
        (RESULTS / "trust_plain.md").write_text("\n".join(lines), encoding="utf-8")
        WEIGHTS_FILE.write_text(source_of(model), encoding="utf-8")
    print("\n".join(lines))


def source_of(model: Model) -> str:
    """The Python file that has the weights."""
    head = HEAD.split("from typing")[0].replace("benchmarks.trust.fit", "benchmarks.trust.plain")
    head = head.replace("confidence (see `gmds.matching.rating`)", "confidence of plain maps (see `rating`)")
    rows = [
        f'    "{name}": Weight({one.weight:.4g}, {one.low:.4g}, {one.high:.4g}),'
        for name, one in zip(CHOSEN, model.weights, strict=True)
    ]
    words = "from gmds.matching.weights import Weight\n\n# In the order of `CHOSEN`."
    return "\n".join([f"{head}{words}", f"PLAIN_CONSTANT = {model.constant:.4g}", "PLAIN_WEIGHTS = {", *rows, "}", ""])


if __name__ == "__main__":
    main()
