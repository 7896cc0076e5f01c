"""Fuzzing of every reader: sound files, damaged at random, must give a right answer or a typed error, and nothing else.

    python -m benchmarks.fuzzing.fuzz --executions 100000 --seed 0

Each reader is run in child processes of 2 GB, warnings being errors and 5 s of processor time the most for a file. A
failure prints the reader, the seed and the number of the file; `--only READER --first N --executions 1` repeats it.
Writes results/fuzz.md.
"""

from __future__ import annotations

import argparse
import json
import resource
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.fuzzing.targets import TARGETS, Target, lay_beside
from benchmarks.markdown import table
from benchmarks.places import RESULTS

FIGURES = ("answered", "refused", "seconds", "slowest", "megabytes")
CHUNK = 20_000  # files a child process; set by hand
SECONDS, MEMORY = 5, 2 << 30  # that a file of a few hundred bytes may cost, processor time and bytes: bounds
PIECES = [b"-1", b"1e999", b"nan", b"inf", b"1e400", b"9" * 9, b"9" * 20, b"2147483648", b"4294967297", b"1_0", b"0x1",
          b",", b"\0", b"\xff", b"#", b"\n", b"\r", b" ", b"\t", b"{", b"[", b'"', b"=", b"\xef\xbb\xbf",
          b"null", b"true", b"[]", b"{}", b'""', b"0", b"-7.5", b'"a": 1, ', b"[matching]\n",
          b"\xff\xff\xff\xff", b"\x00\x00\x00\x80", b"\x00\x00\xc0\x7f", b"PK\x03\x04",
          b"3 0 1 2\n", b"element face 9\n"]  # fmt: skip
CODES = ("E1", "E2", "E3", "E6")


def damaged(sound: list[bytes], rng: np.random.Generator) -> bytes:
    """One of the sound files after one to four damages."""
    content = bytearray(sound[rng.integers(len(sound))])
    for _ in range(min(rng.geometric(0.5), 4)):
        at, size = int(rng.integers(len(content) + 1)), int(rng.integers(1, 17))
        match int(rng.integers(8)):
            case 0:
                content[at : at + 1] = bytes([int(rng.integers(256))])
            case 1:
                del content[at : at + size]
            case 2:
                content[at:at] = content[int(rng.integers(len(content) + 1)) :][: 4 * size]
            case 3:
                del content[at:]
            case 4:
                other = sound[rng.integers(len(sound))]
                content[at : at + size] = other[int(rng.integers(len(other))) :][:size]
            case 5:
                content[at:at] = rng.bytes(int(rng.integers(1, 5)))
            case _:
                content[at : at + int(rng.integers(0, 5))] = PIECES[rng.integers(len(PIECES))]
    return bytes(content)


def outcome(target: Target, path: Path) -> str:
    """ "answered" or "refused"; raises whatever else happens."""
    try:
        answer = target.read(path)
    except (ValueError, OSError) as error:
        code = getattr(error, "code", "")
        if isinstance(code, str) and code.startswith(CODES):
            return "refused"
        raise
    if not target.holds(answer):
        raise AssertionError(f"a wrong answer: {answer!r:.200}")
    return "answered"


def run(name: str, seed: int, files: range, folder: Path) -> dict[str, Any]:
    """Counts of what came of these files."""
    target = TARGETS[name]
    sound, path = target.sound(), folder / target.name
    lay_beside(target, folder)
    found: dict[str, Any] = {"answered": 0, "refused": 0, "failures": [], "slowest": 0.0}
    began = time.process_time()
    warnings.simplefilter("error")
    for number in files:
        path.write_bytes(target.packed(damaged(sound, np.random.default_rng([seed, number]))))
        start = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        try:
            found[outcome(target, path)] += 1
        except Exception:
            found["failures"].append((number, traceback.format_exc(limit=-3)))
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
        found["slowest"] = max(found["slowest"], time.process_time() - start)
    found["seconds"] = time.process_time() - began
    found["megabytes"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return found


def in_child(name: str, seed: int, files: range) -> dict[str, Any]:
    """As `run`, in a process of its own; one that dies is a failure of all its files."""
    command = [sys.executable, "-m", "benchmarks.fuzzing.fuzz", "--child", "--only", name, "--seed", str(seed)]
    command += ["--first", str(files.start), "--executions", str(len(files))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
        return found
    died = f"the process died with {done.returncode}: {done.stderr[-500:]}"
    return dict.fromkeys(FIGURES, 0) | {"failures": [(files.start, died)]}


def fuzzed(name: str, seed: int, files: range) -> dict[str, Any]:
    """Counts of what came of all files of a reader, in child processes; the first failures are printed."""
    parts = [in_child(name, seed, files[i : i + CHUNK]) for i in range(0, len(files), CHUNK)]
    found: dict[str, Any] = {key: sum(part[key] for part in parts) for key in ("answered", "refused", "seconds")}
    found |= {key: max(part[key] for part in parts) for key in ("slowest", "megabytes")}
    found["failures"] = [failure for part in parts for failure in part["failures"]]
    for number, told in found["failures"][:3]:
        print(f"{name}, seed {seed}, file {number}:\n{told}")
    return found


def page(seed: int, executions: int, found: Mapping[str, dict[str, Any]]) -> str:
    """The table."""
    total, seconds = executions * len(found), sum(one["seconds"] for one in found.values())
    failures = sum(len(one["failures"]) for one in found.values())
    lines = ["# Fuzzing", ""]
    lines += [
        f"`python -m benchmarks.fuzzing.fuzz --executions {executions} --seed {seed}`: sound files, damaged at random"
    ]
    lines += [
        "(contents of archives before they are packed). An answer must hold what it promises, an error must be one"
    ]
    lines += ["with a code, warnings count as failures, and so do 5 s of processor time or 2 GB for a file.", ""]
    lines += [
        f"{total:,} executions, {failures} failures, {total / max(seconds, 1e-9):,.0f} a second of processor time.",
        "",
    ]
    head = ["reader", "executions", "answered", "refused with a code", "failures", "a second", "slowest, s", "peak, MB"]
    rows = []
    for name, one in found.items():
        rate = f"{executions / max(one['seconds'], 1e-9):,.0f}"
        counts = [one["answered"], one["refused"], len(one["failures"])]
        rows.append([name, executions, *counts, rate, f"{one['slowest']:.2f}", f"{one['megabytes']:.0f}"])
    return "\n".join([*lines, *table(head, rows)])


def main() -> int:
    """Run, write, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--executions", type=int, default=20_000, help="files for each reader (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", choices=list(TARGETS), action="append")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    files = range(options.first, options.first + options.executions)
    names = options.only or list(TARGETS)
    if options.child:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        with tempfile.TemporaryDirectory() as folder:
            print(json.dumps(run(names[0], options.seed, files, Path(folder))))
        return 0
    found: dict[str, dict[str, Any]] = {}
    for name in names:
        found[name] = fuzzed(name, options.seed, files)
        text = page(options.seed, len(files), found)
        (options.output / "fuzz.md").write_text(text, encoding="utf-8")
        print(text.splitlines()[-1 if text.splitlines()[-1] else -2], flush=True)
    return 1 if any(one["failures"] for one in found.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
