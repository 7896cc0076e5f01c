"""How a batch starts: workers that die on the way, and a folder that several runs share."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import gmds
from gmds.batch import starting
from gmds.batch.lock import cleared
from gmds.errors import WorkersNotStarted


@pytest.mark.skipif(sys.platform == "win32", reason="there nothing is removed that is being written")
def test_what_another_run_is_writing_to_a_shared_folder_is_left_alone(tmp_path: Path) -> None:
    shapes, mine = tmp_path / "first" / "shapes", tmp_path / "second" / "shapes"
    shapes.mkdir(parents=True)
    mine.parent.mkdir()
    mine.symlink_to(shapes, target_is_directory=True)
    code = (
        "import sys, time; from pathlib import Path; from gmds.batch.lock import cleared\n"
        "with cleared(Path(sys.argv[1])): print('in', flush=True); time.sleep(60)"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])}
    with subprocess.Popen([sys.executable, "-c", code, shapes], stdout=subprocess.PIPE, env=environment) as child:
        assert child.stdout is not None and child.stdout.readline().strip() == b"in"
        half = shapes / ".gmds-0123456789abcdef.tmp"
        half.write_bytes(b"half of a file")
        with cleared(mine), cleared(shapes):
            assert half.exists()
        child.kill()
    with cleared(mine):
        assert list(shapes.iterdir()) == []


def test_workers_that_die_as_they_start_are_started_again_and_then_named(monkeypatch: pytest.MonkeyPatch) -> None:
    died = []

    class Cluster:
        def __init__(self, **_: object) -> None:
            died.append(1)
            if len(died) < deaths:
                raise RuntimeError("Nanny failed to start.")

    monkeypatch.setattr(starting, "STARTS", 2)
    distributed = type("Distributed", (), {"LocalCluster": Cluster})
    deaths = 2
    assert isinstance(starting.local_cluster(distributed, 1), Cluster)
    died, deaths = [], 9
    with pytest.raises(WorkersNotStarted, match=r"E506: no worker could be started, 2 times .*__main__"):
        starting.local_cluster(distributed, 1)
    assert len(died) == 2


def test_a_script_without_a_main_guard_gets_one_error_with_a_code(tmp_path: Path) -> None:
    pytest.importorskip("distributed", reason="the extra `batch` is not installed")
    script = tmp_path / "script.py"
    script.write_text(
        "import gmds\nfrom gmds.batch import starting\nstarting.STARTS = 1\n"
        "shape = gmds.shapes.quadruped(n_vertices=200)\n"
        "gmds.match_collection({'a': shape, 'b': shape}, 'out', client=gmds.batch.local_client(1))\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, script],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 1 and done.stderr.count("Traceback") == 1
    assert done.stderr.splitlines()[-1].startswith("gmds.errors.WorkersNotStarted: E506: ")
