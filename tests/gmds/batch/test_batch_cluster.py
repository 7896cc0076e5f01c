"""gmds batch on the cluster of a scheduler that runs by itself, as it would on several machines."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import batches
import pytest
from click.testing import CliRunner

import gmds
from geodesics import write_mesh
from gmds.batch import consecutive, local_client, match_collection
from gmds.cli import main

pytest.importorskip("distributed", reason="the extra `batch` is not installed")


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    """A scheduler and two workers, each a process of its own."""
    told = tmp_path / "scheduler.json"
    env = {**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])}
    dask = [sys.executable, "-m", "dask"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": env, "cwd": tmp_path}
    options = [["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(told)]]
    options += [["worker", "--scheduler-file", str(told), "--nthreads", "1", "--no-dashboard"]] * 2
    started = [subprocess.Popen([*dask, *given], **quiet) for given in options]  # type: ignore[call-overload]
    try:
        until = time.monotonic() + 60
        while not told.exists() and time.monotonic() < until:
            time.sleep(0.1)
        yield str(json.loads(told.read_text())["address"])
    finally:
        for process in reversed(started):
            process.terminate()
        for process in started:
            process.wait(30)


def test_a_batch_on_a_cluster_is_the_batch_on_this_machine(address: str, tmp_path: Path) -> None:
    meshes, here, there = (tmp_path / name for name in ("meshes", "here", "there"))
    meshes.mkdir()
    for name, mesh in batches.collection().items():
        write_mesh(mesh, meshes / f"{name}.ply")
    given = ["batch", str(meshes), "-o", str(there), "--pairs", "consecutive", "--scheduler", address, "--json"]
    result = CliRunner().invoke(main, given)
    assert result.exit_code == 0, result.output
    with local_client(1) as client:
        assert not match_collection(meshes, here, pairs=consecutive, client=client).failed
    assert batches.tree(there) == batches.tree(here)
