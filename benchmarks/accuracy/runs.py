"""Matchers over pair sets in worker processes, each row written as it comes: what is in the CSV is not done again.

A row belongs to a version of the code; rows of another version are done again.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import hashlib
import multiprocessing
import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from benchmarks.accuracy.halves import DEVELOPMENT, HALVES, half_of, pairs_of
from benchmarks.places import RESULTS, ROOT
from gmds.benchmarking.pairs import Pair
from gmds.benchmarking.run import FIGURES, BenchmarkRow, Matcher, benchmark
from gmds.files.table import read_table, write_table
from gmds.shapes import quadruped

CODE = ["geodesics", "gmds", ":!gmds/cli", ":!gmds/report"]
SMALL = 600  # vertices of the shape that workers warm up on: enough that its spectra are computed sparsely
ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "GMDS_THREADS"), "1"
)

Rows = dict[tuple[str, str], BenchmarkRow]  # (matcher, pair) -> row
COLUMNS = ("matcher", "version", *(column.name for column in fields(BenchmarkRow)))


@dataclass(frozen=True)
class Job:
    """Matchers by name, found in a worker by `find(name)` (a function of a module), on pairs of one set."""

    folder: str
    pairs: Sequence[Pair]
    matchers: Sequence[str]
    find: Callable[[str], Matcher]


def code_version() -> str:
    """The last commit that changed what the matcher does; with a digest of its files where they differ from it.

    Commits that only move or rename say so by a trailer `Maps-unchanged:` (how many maps `same_maps` found the same
    byte for byte), and are looked past: a table that was measured before them holds after them.
    """
    commit = _git("log", "-1", "--format=%h", "--invert-grep", "--grep=^Maps-unchanged:", "--", *CODE)
    if not _git("status", "--porcelain", "--", *CODE):
        return commit
    files = _git("ls-files", "--cached", "--others", "--exclude-standard", "--", *CODE).splitlines()
    digest = hashlib.sha256()
    for path in (ROOT / file for file in sorted(set(files))):
        digest.update(path.read_bytes() if path.is_file() else b"")
    return f"{commit}+{digest.hexdigest()[:6]}"


def _git(*arguments: str) -> str:
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=True).stdout.strip()


def run(job: Job, path: Path, version: str, workers: int) -> Rows:
    """The rows of a job, those in the CSV at `path` among them; reported on stderr, and written there, as they come."""
    os.environ.update(ONE_THREAD)  # read by the workers, which start afresh
    stored = read_rows(path, version)
    wanted = [(matcher, pair.name) for pair in job.pairs for matcher in job.matchers]
    todo = [key for key in wanted if key not in stored]
    if todo:
        with ProcessPoolExecutor(min(workers, len(todo)), multiprocessing.get_context("spawn")) as pool:
            futures = {pool.submit(judge, job.find, job.folder, *key): key for key in todo}
            try:
                for done, future in enumerate(as_completed(futures), start=1):
                    matcher, name = futures[future]
                    stored[matcher, name] = row = future.result()
                    write_rows(path, version, stored)
                    error = "-" if row.direct is None else f"{row.direct:.2f}"
                    print(f"{job.folder} {done}/{len(todo)} {matcher}: {name} {error} {row.status}", file=sys.stderr)
            finally:
                pool.shutdown(cancel_futures=True)
    return {key: stored[key] for key in wanted}


def judge(find: Callable[[str], Matcher], folder: str, matcher: str, name: str) -> BenchmarkRow:
    """One row, in a worker; a fault of the matcher is recorded in it, so that the other pairs are still run."""
    pair = _by_name(folder)[name]
    warm_up(find, matcher)
    try:
        return next(benchmark([pair], find(matcher)))
    except Exception as error:
        return BenchmarkRow(pair.name, pair.group, f"failed: {type(error).__name__}: {error}")


@functools.cache
def warm_up(find: Callable[[str], Matcher], matcher: str) -> None:
    """Match a small shape with itself once a process, so that no row pays for imports and compilation."""
    mesh = quadruped(n_vertices=SMALL)
    with contextlib.suppress(Exception):  # the real pairs will tell
        find(matcher)(mesh, mesh)


@functools.cache
def _by_name(folder: str) -> Mapping[str, Pair]:
    return {pair.name: pair for pair in pairs_of(folder)}


def read_rows(path: Path, version: str) -> Rows:
    """The rows of a version in a CSV; none where there is no such file, or one of another kind."""
    if not path.is_file():
        return {}
    lines = [line for line in read_table(path) if line.get("version") == version]
    return {(line["matcher"], line["pair"]): _row(line) for line in lines}


def _row(line: Mapping[str, str]) -> BenchmarkRow:
    figures = {name: float(line[name]) if line.get(name) else None for name in FIGURES}
    return BenchmarkRow(line["pair"], line["group"], line["status"], **figures)


def write_rows(path: Path, version: str, rows: Rows) -> None:
    """All rows, ordered by matcher and pair, written atomically."""
    cells = ((matcher, version, *asdict(row).values()) for (matcher, _), row in sorted(rows.items()))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_table(path, COLUMNS, cells, digits=6)


def chosen_pairs(name: str, half: str | None, every: int) -> list[Pair]:
    """The pairs of a set, of one half only, every so many."""
    pairs = pairs_of(name)
    wanted = {pair.name for pair in pairs} if half is None else set(half_of(name, half))
    return [pair for pair in pairs if pair.name in wanted][::every]


def arguments(description: str | None, sets: Iterable[str], every: int | None = 1) -> argparse.ArgumentParser:
    """The command-line options that all scripts share."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=_set_names, default=list(sets), help="names, separated by commas")
    parser.add_argument("--half", choices=HALVES, help="pairs of one half only (default: both)")
    parser.add_argument("--every", type=int, default=every, help="every N-th pair only")
    parser.add_argument("--workers", type=int, default=2, help="processes (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where CSV and tables go (default: results/)")
    return parser


def _set_names(text: str) -> list[str]:
    names = text.split(",")
    unknown = [name for name in names if name not in DEVELOPMENT]
    if unknown:
        raise argparse.ArgumentTypeError(f"{unknown[0]!r} is none of {', '.join(DEVELOPMENT)}")
    return names
