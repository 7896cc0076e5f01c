"""The pair sets of the benchmark, and which half of each hyper-parameters were chosen on.

    GMDS_DATA=... python -m benchmarks.accuracy.halves

writes benchmarks/pairs/<set>_{development,reporting}.txt, which `gmds benchmark --pairs` reads too. The ten published
`scaled` pairs are all for reporting: hyper-parameters were chosen on the scaled pairs that `development_pairs.py`
makes. In `shrec20` the partial scans are sources only, so nothing of a source is ever missing in its target;
`shrec20_reversed` is its partial test set the other way round, where something is.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from benchmarks.places import LISTS
from gmds.benchmarking.datasets import Pair, dataset_pairs

DEVELOPMENT: dict[str, Callable[[int], bool]] = {
    "scaled": lambda index: False,
    "faust_5k": lambda index: index % 2 == 0,
    "tosca_5k": lambda index: index % 5 in (0, 1),
    "tosca_cross_5k": lambda index: index % 5 in (0, 1),
    "shrec20": lambda index: index % 2 == 0,
    "shrec20_reversed": lambda index: index % 2 == 0,
}
HALVES = ("development", "reporting")
PARTIAL = "test-set0"


def set_folder(name: str) -> Path:
    """Where a set lies under GMDS_DATA."""
    return Path(os.environ["GMDS_DATA"]) / name.removesuffix("_reversed")


def pairs_of(name: str) -> list[Pair]:
    """All pairs of a set, in the published order."""
    return dataset_pairs(set_folder(name), LISTS / f"{name}.txt" if name.endswith("_reversed") else None)


def half_of(name: str, half: str) -> list[str]:
    """The names of the pairs in one half of a set, as the committed list says."""
    lines = [line.split() for line in (LISTS / f"{name}_{half}.txt").read_text(encoding="utf-8").splitlines()]
    return ["-".join(line) for line in lines]


def entry(name: str, pair: Pair) -> str:
    """The line of a listing that stands for a pair."""
    return pair.name if name == "scaled" else f"{pair.source.stem}\t{pair.target.stem}"


def lists() -> dict[str, list[str]]:
    """File name -> lines of every list."""
    partial = [pair for pair in pairs_of("shrec20") if pair.group == PARTIAL]
    found = {"shrec20_reversed.txt": [f"{pair.target.stem}\t{pair.source.stem}" for pair in partial]}
    for name, develops in DEVELOPMENT.items():
        reverse = name.endswith("_reversed")
        lines = found[f"{name}.txt"] if reverse else [entry(name, pair) for pair in pairs_of(name)]
        for half in HALVES:
            wanted = half == "development"
            found[f"{name}_{half}.txt"] = [line for i, line in enumerate(lines) if develops(i) == wanted]
    return found


def main() -> None:
    """Write the lists."""
    LISTS.mkdir(exist_ok=True)
    for file, lines in lists().items():
        (LISTS / file).write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")


if __name__ == "__main__":
    main()
