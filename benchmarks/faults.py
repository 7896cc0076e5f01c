"""The fault table: every bad array, odd surface and broken file of the contract, put to this project and to its peers.

    python benchmarks/faults.py                      # all libraries that are installed
    python benchmarks/faults.py --libraries gmds     # this project alone

Every entry point of a library runs in child processes of its own (6 GB, 10 s of processor time a case); when one dies
the case is run again in a fresh one. Writes results/faults.csv (a row a case and entry point) and results/faults.md.
`fault_judge.py` says what counts as what; exit code 1 when this project fails a case.
"""

from __future__ import annotations

import argparse
import csv
import importlib.util
import io
import json
import os
import queue
import re
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fault_cases import ARRAYS, FILES, OWN_RULES, Case
from fault_judge import judge, passes
from fault_libraries import LIBRARIES
from fault_tables import Row, page
from file_cases import OBJ, OFF, PLY, STL, glb

from geodesics.io import atomic_write

HERE = Path(__file__).resolve().parent
MODULES = {"gmds": "gmds", "libigl": "igl"}
CPU_SECONDS, WALL_SECONDS = 10.0, 180.0
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "GMDS_THREADS"), "1")
SOUND = {"off": OFF, "obj": OBJ, "ply": PLY, "stl": STL, "glb": glb()}


@dataclass
class Child:
    """A process that runs cases through one entry point, started when it is needed and replaced when it ends."""

    entry: str
    printed: Path
    process: subprocess.Popen[bytes] | None = None
    lines: queue.SimpleQueue[bytes] = field(default_factory=queue.SimpleQueue)

    def ask(self, job: Mapping[str, str]) -> dict[str, Any]:
        """What came of a case."""
        if self.process is None or self.process.poll() is not None:
            command = [sys.executable, str(HERE / "fault_child.py"), self.entry, str(self.printed)]
            self.process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={**os.environ, **ONE_THREAD}
            )
            self.lines = queue.SimpleQueue()
            threading.Thread(target=_forward, args=(self.process.stdout, self.lines), daemon=True).start()
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(job).encode() + b"\n")
        self.process.stdin.flush()
        result = self._answer()
        if self.printed.exists():
            result.setdefault("printed", self.printed.read_text(errors="replace")[:500])
        return result

    def _answer(self) -> dict[str, Any]:
        """Lines until the answer; the clock runs from "begin", when everything is imported."""
        process = self.process
        assert process is not None
        started, cpu = time.monotonic(), 0.0
        while True:
            try:
                line = self.lines.get(timeout=0.5)
            except queue.Empty:
                if time.monotonic() - started > WALL_SECONDS or _cpu(process.pid) - cpu > CPU_SECONDS:
                    self.close()
                    return {"hang": True}
                continue
            if not line:
                return {"crash": process.wait()}
            if line.strip() != b"begin":
                answer: dict[str, Any] = json.loads(line)
                return answer
            started, cpu = time.monotonic(), _cpu(process.pid)

    def close(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None


def _forward(stream: Any, lines: queue.SimpleQueue[bytes]) -> None:
    """Lines of a process as they come, and an empty one when it has ended."""
    for line in stream:
        lines.put(line)
    lines.put(b"")


def _cpu(pid: int) -> float:
    """Seconds of processor time that a process has had."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run(library: str, folder: Path) -> Iterator[Row]:
    """All rows of one library."""
    for function in LIBRARIES[library]:
        entry = function.__name__
        child = Child(entry, folder / f"{entry}.txt")
        try:
            is_reader = entry.endswith(("_read", "_check"))
            offered = _offered(child, folder) if is_reader and library != "gmds" else None
            for case in (FILES if is_reader else ARRAYS).values():
                if offered is not None and (case.name in OWN_RULES or case.name.rsplit(".", 1)[-1] not in offered):
                    continue
                yield _row(library, entry, case, child, folder)
        finally:
            child.close()


def _row(library: str, entry: str, case: Case, child: Child, folder: Path) -> Row:
    job = {"case": case.name}
    if case.content or case.make is None:
        path = folder / case.name
        path.write_bytes(case.content)
        job = {"path": str(path)}
    start = time.monotonic()
    result = child.ask(job)
    if "crash" in result:  # an earlier case may have done the harm
        result = child.ask(job)
    seconds = result.get("seconds", time.monotonic() - start)
    kept = passes(case, result) if library == "gmds" else None
    said = result.get("message") or result.get("printed") or (f"exit {result['crash']}" if "crash" in result else "")
    told = re.sub(r"(?<![\w.])/(?:[\w.@+-]+/)+", "", " ".join(str(said).split()))[:120]  # without folders
    return Row(library, entry, case.row, case.name, case.code or "answer", judge(case, result), kept, seconds, told)


def _offered(child: Child, folder: Path) -> set[str]:
    """The endings of files that a reader reads when they are sound."""
    found = set()
    for ending, content in SOUND.items():
        case = Case("F12", f"sound.{ending}", None, content=content if isinstance(content, bytes) else content.encode())
        if _row("", "", case, child, folder).outcome == "right":
            found.add(ending)
    return found


def installed(libraries: Iterable[str]) -> list[str]:
    """Those that can be imported."""
    return [name for name in libraries if importlib.util.find_spec(MODULES.get(name, name)) is not None]


def write(path: Path, fill: Callable[[io.StringIO], Any]) -> None:
    """A text file, atomically."""
    text = io.StringIO(newline="")
    fill(text)
    with atomic_write(path) as stream:
        stream.write(text.getvalue().encode("utf-8"))


def main() -> int:
    """Run, write, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--libraries", default=",".join(LIBRARIES), help="names, separated by commas")
    parser.add_argument("--output", type=Path, default=HERE / "results")
    options = parser.parse_args()
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as folder:
        for library in installed(options.libraries.split(",")):
            rows += run(library, Path(folder))
            print(f"{library}: {sum(row.library == library for row in rows)} runs", file=sys.stderr)
    rows.sort(key=lambda row: row.library != "gmds")

    def table(stream: io.StringIO) -> None:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(Row._fields)
        writer.writerows(row._replace(seconds=round(row.seconds, 3)) for row in rows)  # type: ignore[arg-type]

    write(options.output / "faults.csv", table)
    write(options.output / "faults.md", lambda stream: stream.write(page(rows)))
    failed = [row for row in rows if row.kept is False]
    for row in failed:
        print(f"FAILED {row.entry} {row.case}: {row.expected} expected, {row.outcome}: {row.said}")
    print(f"{sum(row.kept is True for row in rows)} of {sum(row.kept is not None for row in rows)} kept")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
