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

import numpy as np

from benchmarks.places import RESULTS, ROOT
from benchmarks.trust.judged import JudgedMap, collected, counts_of
from benchmarks.trust.model import Model, fitted, shift
from benchmarks.trust.page import page
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


def main() -> None:
    """Fit, judge, and write."""
    parser = argparse.ArgumentParser(description="The model of confidence, fitted and judged.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="write gmds/matching/weights.py")
    asked = parser.parse_args()
    names, maps = collected(asked.folder)
    model = fit([one for one in maps if one.half == "development"])
    without = {kind: fit([one for one in maps if one.kind != kind]) for kind in {one.kind for one in maps}}
    apart = {one.name: one.undisputed * without[one.kind].confidence(one.signs) for one in maps}
    lines = page(maps, {one.name: one.undisputed * model.confidence(one.signs) for one in maps}, apart)
    if asked.write:
        (RESULTS / "trust.md").write_text("\n".join(lines), encoding="utf-8")
        WEIGHTS_FILE.write_text(source_of(names, model), encoding="utf-8")
    print("\n".join(lines))
    print("LOG_ODDS =", tuple(round(value, 2) for value in log_odds(maps, model)))


def fit(maps: Sequence[JudgedMap]) -> Model:
    """The model of these maps; what is not valid has no confidence and teaches nothing."""
    signs = np.concatenate([one.signs[one.valid] for one in maps])
    error = np.concatenate([one.error[one.valid] for one in maps])
    return fitted(signs, error <= RADIUS, counts_of(maps))


def log_odds(maps: Sequence[JudgedMap], model: Model) -> list[float]:
    """What odds change by at `RADII`, on the development half."""
    chosen = [one for one in maps if one.half == "development"]
    confidence = np.concatenate([(one.undisputed * model.confidence(one.signs))[one.valid] for one in chosen])
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
