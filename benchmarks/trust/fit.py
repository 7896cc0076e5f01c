"""The model of confidence fitted to the development half of the maps that were collected, and judged on the rest.

    GMDS_DATA=... python -m benchmarks.trust.collect FOLDER
    python -m benchmarks.trust.fit FOLDER [--write]

Reports results/trust.md: calibration and the area under the ROC on the reporting half, and on each kind when the model
is fitted without all of that kind; the status of right and wrong maps; wrong regions that are named. With --write the
weights go into gmds/matching/weights.py.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.places import RESULTS, ROOT
from benchmarks.trust.model import Model, fitted, shift
from benchmarks.trust.page import page
from geodesics.arrays import Bools, Floats
from gmds.maps.confidence import RADII, RADIUS

WEIGHTS_FILE = ROOT / "gmds" / "matching" / "weights.py"
HEAD = '''"""The model of confidence (see `gmds.matching.rating`), as `python -m benchmarks.trust.fit` wrote it."""

from __future__ import annotations

from typing import NamedTuple


class Weight(NamedTuple):
    """Of one sign: what it counts, and the range it is held in."""

    weight: float
    low: float
    high: float


'''


class JudgedMap(NamedTuple):
    """A map that was collected: signs (p, k), errors (p,) and whether points are `valid`, of points of the source."""

    name: str
    kind: str
    half: str
    status: str
    signs: Floats
    error: Floats
    valid: Bools
    positions: Floats
    margin: float


def main() -> None:
    """Fit, judge, and write."""
    parser = argparse.ArgumentParser(description="The model of confidence, fitted and judged.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="write gmds/matching/weights.py")
    asked = parser.parse_args()
    names, maps = collected(asked.folder)
    model = fit([one for one in maps if one.half == "development"])
    without = {kind: fit([one for one in maps if one.kind != kind]) for kind in {one.kind for one in maps}}
    apart = {one.name: without[one.kind].confidence(one.signs) for one in maps}
    lines = page(maps, {one.name: model.confidence(one.signs) for one in maps}, apart)
    if asked.write:
        (RESULTS / "trust.md").write_text("\n".join(lines), encoding="utf-8")
        WEIGHTS_FILE.write_text(source_of(names, model), encoding="utf-8")
    print("\n".join(lines))
    print("LOG_ODDS =", tuple(round(value, 2) for value in log_odds(maps, model)))


def collected(folder: Path) -> tuple[list[str], list[JudgedMap]]:
    """The names of the signs, and every map in a folder that `benchmarks.trust.collect` filled."""
    names: list[str] = []
    maps = []
    for file in sorted(folder.glob("*.npz")):
        with np.load(file) as rows:
            names = list(map(str, rows["names"]))
            told = (str(rows[name]) for name in ("kind", "half", "status"))
            arrays = (rows[name] for name in ("signs", "error", "valid", "positions"))
            maps.append(JudgedMap(file.stem, *told, *arrays, float(rows["margin"])))
    return names, maps


def counts_of(maps: Sequence[JudgedMap]) -> Floats:
    """How much each valid point counts: maps of a kind alike, kinds as the root of how many maps they have."""
    kinds = [one.kind for one in maps]
    return np.concatenate(
        [np.full(one.valid.sum(), kinds.count(one.kind) ** -0.5 / max(one.valid.sum(), 1)) for one in maps]
    )


def fit(maps: Sequence[JudgedMap]) -> Model:
    """The model of these maps; what is not valid has no confidence and teaches nothing."""
    signs = np.concatenate([one.signs[one.valid] for one in maps])
    error = np.concatenate([one.error[one.valid] for one in maps])
    return fitted(signs, error <= RADIUS, counts_of(maps))


def log_odds(maps: Sequence[JudgedMap], model: Model) -> list[float]:
    """What odds change by at `RADII`, on the development half."""
    chosen = [one for one in maps if one.half == "development"]
    confidence = np.concatenate([model.confidence(one.signs[one.valid]) for one in chosen])
    error = np.concatenate([one.error[one.valid] for one in chosen])
    return [shift(confidence, error <= radius, counts_of(chosen)) for radius in RADII]


def source_of(names: Sequence[str], model: Model) -> str:
    """The Python file that has the weights."""
    rows = [
        f'    "{name}": Weight({one.weight:.4g}, {one.low:.4g}, {one.high:.4g}),'
        for name, one in zip(names, model.weights, strict=True)
    ]
    return "\n".join(
        [f"{HEAD}# In the order of the signs.\nCONSTANT = {model.constant:.4g}", "WEIGHTS = {", *rows, "}", ""]
    )


if __name__ == "__main__":
    main()
