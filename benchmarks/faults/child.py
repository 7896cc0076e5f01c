"""Child process of `faults.py`: runs cases through one entry point; a line of JSON for each outcome.

What a library prints goes to the file named last on the command line, whatever layer it is written in.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from benchmarks.faults.cases import ARRAYS
from benchmarks.faults.libraries import LIBRARIES

MEMORY = 6 << 30  # bytes of address space: a bound


def main() -> None:
    """`child.py ENTRY_POINT PRINTED`, one case a line on stdin."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    tell = os.fdopen(os.dup(1), "w", buffering=1)
    printed = os.open(sys.argv[2], os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(printed, 1)
    os.dup2(printed, 2)
    entries = {entry.__name__: entry for group in LIBRARIES.values() for entry in group}
    entry = entries[sys.argv[1]]
    for line in sys.stdin:
        job = json.loads(line)
        os.ftruncate(printed, 0)
        os.lseek(printed, 0, os.SEEK_SET)
        tell.write("begin\n")
        tell.write(json.dumps(outcome(entry, job)) + "\n")


def outcome(entry: Callable[..., Any], job: dict[str, str]) -> dict[str, Any]:
    """The answer as lists, or the error."""
    if "path" in job:
        given: tuple[Any, ...] = (Path(job["path"]),)
    else:
        case = ARRAYS[job["case"]]
        given = (case.vertices, case.faces, case.source)
    start = time.perf_counter()
    try:
        answer = entry(*given)
        result: dict[str, Any] = plain(answer)
    except Exception as error:
        result = {"error": type(error).__name__, "message": str(error)[:2000], "code": getattr(error, "code", None)}
    sys.stdout.flush()
    sys.stderr.flush()
    return {**result, "seconds": time.perf_counter() - start}


def plain(answer: Any) -> dict[str, Any]:
    """An answer that JSON can carry."""
    if answer is None:
        return {"nothing": True}
    if sp.issparse(answer):
        matrix = answer.tocoo()
        return {"matrix": [matrix.row.tolist(), matrix.col.tolist(), numbers(matrix.data)], "shape": matrix.shape}
    if isinstance(answer, tuple):
        vertices, faces = (np.asarray(part) for part in answer)
        if max(vertices.size, faces.size) > 100_000:
            return {"vertices": [], "faces": []}  # of no case
        return {"vertices": numbers(vertices), "faces": numbers(faces)}
    return {"values": numbers(np.asarray(answer).ravel())}


def numbers(array: Any) -> Any:
    """An array as lists of floats; NaN where it holds anything else."""
    array = np.asarray(array)
    if array.dtype.kind not in "biuf":
        return np.full(array.shape, np.nan).tolist()
    return array.astype(float).tolist()


if __name__ == "__main__":
    main()
