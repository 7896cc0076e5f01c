"""The fault table: every bad array, odd surface and broken file of the contract, put to this project and to its peers.

    python -m benchmarks.faults.faults                              # all libraries that are installed
    python -m benchmarks.faults.faults --libraries gmds,pymeshlab   # their rows anew, those of the others as they are

Every entry point of a library runs in child processes of its own (6 GB, 10 s of processor time a case); when one dies
the case is run again in a fresh one. Writes results/faults.csv (a row a case and entry point) and results/faults.md
after each library. `judge.py` says what counts as what; exit code 1 when this project fails a case. Which of
their faults crash and which answer with foreign memory may differ from run to run.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import re
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from file_cases import OBJ, OFF, PLY, STL, glb

import gmds
from benchmarks.faults.cases import ARRAYS, FILES, OWN_RULES, Case
from benchmarks.faults.judge import CLASSES, judge, passes
from benchmarks.faults.libraries import LIBRARIES
from benchmarks.faults.process import Child
from benchmarks.faults.tables import Row, page
from benchmarks.places import RESULTS
from geodesics.io import atomic_write
from gmds.files.table import read_table, write_table

OURS = "gmds"
MODULES = {"libigl": "igl"}
PACKAGES = {"pyFM": "pyfmaps", "robust_laplacian": "robust-laplacian"}
SOUND = {"off": OFF, "obj": OBJ, "ply": PLY, "stl": STL, "glb": glb()}


def run(library: str, folder: Path) -> Iterator[Row]:
    """All rows of one library."""
    for function in LIBRARIES[library]:
        entry = function.__name__
        child = Child(entry, folder / f"{entry}.txt")
        try:
            is_reader = entry.endswith(("_read", "_check"))
            offered = _offered(child, folder) if is_reader and library != OURS else None
            cases = list((FILES if is_reader else ARRAYS).values())
            if offered is not None:
                cases = [case for case in cases if case.name not in OWN_RULES and _ending(case) in offered]
            rows = [_row(library, case, child, folder) for case in cases]
            yield from rows if library == OURS else _once_more(rows, cases, child, folder)
        finally:
            child.close()


def _once_more(rows: list[Row], cases: list[Case], child: Child, folder: Path) -> list[Row]:
    """What went wrong without a word is run again in a fresh process, the last first, and the kinder class counts.

    Answers from memory that was never written depend on what was there before.
    """
    child.close()
    kinder = dict(enumerate(rows))
    for i in reversed(range(len(rows))):
        if rows[i].outcome.endswith("silently"):
            again = _row(rows[i].library, cases[i], child, folder)
            kinder[i] = min(rows[i], again, key=lambda row: CLASSES.index(row.outcome))
    return list(kinder.values())


def _ending(case: Case) -> str:
    return case.name.rsplit(".", 1)[-1]


def _row(library: str, case: Case, child: Child, folder: Path) -> Row:
    result, seconds = _run(case, child, folder)
    kept = passes(case, result) if library == OURS else None
    said = result.get("message") or result.get("printed") or (f"exit {result['crash']}" if "crash" in result else "")
    told = re.sub(r"(?<![\w.])/(?:[\w.@+-]+/)+", "", " ".join(str(said).split()))[:120]  # without folders
    expected = case.code or "answer"
    outcome = judge(case, result)
    return Row(library, _version(library), child.entry, case.row, case.name, expected, outcome, kept, seconds, told)


def _run(case: Case, child: Child, folder: Path) -> tuple[dict[str, Any], float]:
    """What came of a case, and after how many seconds."""
    job = {"case": case.name}
    if case.content or case.make is None:
        path = folder / case.name
        path.write_bytes(case.content)
        job = {"path": str(path)}
    start = time.monotonic()
    result = child.ask(job)
    return result, round(result.get("seconds", time.monotonic() - start), 3)


def _offered(child: Child, folder: Path) -> set[str]:
    """The endings of files that a reader reads when they are sound."""
    found = set()
    for ending, content in SOUND.items():
        case = Case("F12", f"sound.{ending}", None, content=content if isinstance(content, bytes) else content.encode())
        if judge(case, _run(case, child, folder)[0]) == "right":
            found.add(ending)
    return found


def _version(library: str) -> str:
    return gmds.__version__ if library == OURS else importlib.metadata.version(PACKAGES.get(library, library))


def installed(libraries: Iterable[str]) -> list[str]:
    """Those that can be imported."""
    return [name for name in libraries if importlib.util.find_spec(MODULES.get(name, name)) is not None]


def read_rows(path: Path) -> list[Row]:
    """The rows of an earlier run; none where there is no such file, or one with other columns."""
    if not path.is_file():
        return []
    kept = {"True": True, "False": False, "": None}
    lines = [line for line in read_table(path) if tuple(line) == Row._fields]
    return [
        Row(**{**line, "kept": kept[line["kept"]], "seconds": float(line["seconds"])})  # type: ignore[arg-type]
        for line in lines
    ]


def write_rows(folder: Path, rows: list[Row]) -> None:
    """Table and page, libraries in the order in which they are named."""
    rows.sort(key=lambda row: list(LIBRARIES).index(row.library))
    write_table(folder / "faults.csv", Row._fields, rows)
    with atomic_write(folder / "faults.md") as stream:
        stream.write(page(rows).encode("utf-8"))


def main() -> int:
    """Run, write, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--libraries", default=",".join(LIBRARIES), help="names, separated by commas")
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    rows = read_rows(options.output / "faults.csv")
    with tempfile.TemporaryDirectory() as folder:
        for library in installed(options.libraries.split(",")):
            found = list(run(library, Path(folder)))
            rows = [row for row in rows if row.library != library] + found
            write_rows(options.output, rows)
            print(f"{library}: {len(found)} runs", file=sys.stderr)
    failed = [row for row in rows if row.kept is False]
    for row in failed:
        print(f"FAILED {row.entry} {row.case}: {row.expected} expected, {row.outcome}: {row.said}")
    print(f"{sum(row.kept is True for row in rows)} of {sum(row.kept is not None for row in rows)} kept")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
