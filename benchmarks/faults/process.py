"""Runs the cases of `faults.py` in child processes, one an entry point, with a limit on time."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.places import ROOT

CPU_SECONDS, WALL_SECONDS, LOOK = 10.0, 180.0, 0.5  # bounds of a case, and seconds between two looks at it
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "GMDS_THREADS"), "1")


@dataclass
class Child:
    """A process that runs cases through one entry point, started when it is needed and replaced when it ends."""

    entry: str
    printed: Path
    process: subprocess.Popen[bytes] | None = None
    lines: queue.SimpleQueue[bytes] = field(default_factory=queue.SimpleQueue)

    def ask(self, job: Mapping[str, str]) -> dict[str, Any]:
        """What came of a case; one that ends the process is run again in a fresh one, as others may be to blame."""
        result = self._ask(job)
        return self._ask(job) if "crash" in result else result

    def _ask(self, job: Mapping[str, str]) -> dict[str, Any]:
        fresh = self.process is None or self.process.poll() is not None
        if fresh:
            command = [sys.executable, "-m", "benchmarks.faults.child", self.entry, str(self.printed)]
            self.process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={**os.environ, **ONE_THREAD}, cwd=ROOT
            )
            self.lines = queue.SimpleQueue()
            threading.Thread(target=_forward, args=(self.process.stdout, self.lines), daemon=True).start()
        assert self.process is not None and self.process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # it ended since: no line will come
            self.process.stdin.write(json.dumps(job).encode() + b"\n")
            self.process.stdin.flush()
        result = self._answer()
        if fresh and result.get("crash") and not result["began"]:
            raise RuntimeError(f"{self.entry} ended with {result['crash']} before it was asked anything")
        if self.printed.exists():
            result.setdefault("printed", self.printed.read_text(errors="replace")[:500])
        return result

    def _answer(self) -> dict[str, Any]:
        """Lines until the answer; the clock runs from "begin", when everything is imported."""
        process = self.process
        assert process is not None
        waited, cpu, began = 0.0, 0.0, False
        while True:
            try:
                line = self.lines.get(timeout=LOOK)
            except queue.Empty:
                waited += LOOK  # and not by the clock, which goes on while all of this is suspended
                if waited > WALL_SECONDS or _cpu(process.pid) - cpu > CPU_SECONDS:
                    self.close()
                    return {"hang": True}
                continue
            if not line:
                return {"crash": process.wait(), "began": began}
            if line.strip() != b"begin":
                answer: dict[str, Any] = json.loads(line)
                return answer
            waited, cpu, began = 0.0, _cpu(process.pid), True

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
