"""Reads files in a child process, so that a crash, a hang or a flood of memory there is a finding and not the end."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

_CHILD = """
import contextlib, hashlib, io, json, resource, signal, sys
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
import numpy, trimesh
from geodesics import read_mesh

def outcome(path):
    printed = io.StringIO()
    signal.setitimer(signal.ITIMER_PROF, 20)  # of work: a machine may be busy with other things
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        try:
            mesh = read_mesh(path)
            result = {"vertices": mesh.vertices.tolist(), "faces": mesh.faces.tolist()}
            if mesh.n_vertices > 2000:
                result = {"vertices": len(mesh.vertices), "faces": len(mesh.faces)}
        except Exception as error:
            code = getattr(error, "code", None)
            kinds = [kind.__name__ for kind in type(error).__mro__]
            result = {"code": code, "kinds": kinds, "message": str(error)}
    signal.setitimer(signal.ITIMER_PROF, 0)
    result["printed"] = printed.getvalue()
    return result

for line in sys.stdin:
    job = json.loads(line)
    if "cut" in job:
        whole = open(job["path"], "rb").read()
        target = job["target"]
        for size in job["cut"]:
            with open(target, "wb") as file:
                file.write(whole[:size])
            print(json.dumps(outcome(target)))
    else:
        print(json.dumps(outcome(job["path"])))
"""


def read_in_child(jobs: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """One outcome per file: the arrays, or the error with its code; a dead child fails the test that asked."""
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", _CHILD],
        input="\n".join(map(json.dumps, jobs)),
        capture_output=True,
        text=True,
        timeout=900,
        cwd=Path(__file__).parents[2],
    )
    outcomes = [json.loads(line) for line in run.stdout.splitlines()]
    assert run.returncode == 0, f"died with {run.returncode} after {len(outcomes)} files: {run.stderr[-2000:]}"
    return outcomes
