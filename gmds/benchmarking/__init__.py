"""Published benchmarks: folders, truth files, one row a pair."""

from __future__ import annotations

from geodesics.moved_paths import names_moved
from gmds.benchmarking.datasets import dataset_pairs
from gmds.benchmarking.pairs import Pair
from gmds.benchmarking.run import BenchmarkRow, benchmark, means, write_csv
from gmds.moved_paths import MOVED

__all__ = ["BenchmarkRow", "Pair", "benchmark", "dataset_pairs", "means", "write_csv"]


__getattr__ = names_moved(__name__, MOVED[__name__])
