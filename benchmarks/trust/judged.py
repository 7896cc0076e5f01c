"""The maps that `benchmarks.trust.collect` wrote, read again, and how much each of their points counts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Bools, Floats


class JudgedMap(NamedTuple):
    """A map that was collected: signs (p, k), errors (p,) and whether points are `valid`, of points of the source.

    `undisputed` (p,), or 1: how likely its points are beside those of other maps (`gmds.matching.rivals`), and beside
    those to an image of the target that fits far better (`gmds.matching.other_images.with_candidate`).
    """

    name: str
    kind: str
    half: str
    status: str
    signs: Floats
    error: Floats
    valid: Bools
    positions: Floats
    margin: float
    undisputed: Floats | float = 1.0


def collected(folder: Path) -> tuple[list[str], list[JudgedMap]]:
    """The names of the signs, and every map in a folder that `benchmarks.trust.collect` filled."""
    names: list[str] = []
    maps = []
    for file in sorted(folder.glob("*.npz")):
        with np.load(file) as rows:
            names = list(map(str, rows["names"]))
            told = (str(rows[name]) for name in ("kind", "half", "status"))
            arrays = (rows[name] for name in ("signs", "error", "valid", "positions"))
            maps.append(JudgedMap(file.stem, *told, *arrays, float(rows["margin"]), rows["undisputed"]))
    return names, maps


def counts_of(maps: Sequence[JudgedMap]) -> Floats:
    """How much each valid point counts: maps of a kind alike, kinds as the root of how many maps they have."""
    kinds = [one.kind for one in maps]
    return np.concatenate(
        [np.full(one.valid.sum(), kinds.count(one.kind) ** -0.5 / max(one.valid.sum(), 1)) for one in maps]
    )
