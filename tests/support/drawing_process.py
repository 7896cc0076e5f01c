"""One process that draws all pictures of a run: pyvista takes a second and a half to be imported, and a tenth to draw.

`gmds` starts a process for each picture; the tests of that, in `tests/gmds/pictures/test_pictures.py`, use `ALONE`.
"""

from __future__ import annotations

import select
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from gmds.pictures import offscreen

ALONE = offscreen._run
DRAWS = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
import offscreen_worker
for line in sys.stdin:
    folder, count = line.rstrip("\\n").rsplit(" ", 1)
    try:
        offscreen_worker.main(Path(folder), int(count))
    except Exception as error:
        print(repr(error), flush=True)
    else:
        print(line, end="", flush=True)
"""


def use(patch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Let the process draw whatever gmds would start one for, on Linux; what is returned ends it."""
    if sys.platform != "linux":  # elsewhere nobody waits for a pipe with a limit of time
        return lambda: None
    running: list[subprocess.Popen[str]] = []
    worker = offscreen.WORKER

    def run(command: list[str]) -> None:
        *_, script, folder, count = command
        if script != str(worker) or not _drawn(running, worker.parent, f"{folder} {count}\n"):
            ALONE(command)  # which says why, where nothing can be drawn

    def end() -> None:
        for process in running:
            process.communicate()

    patch.setattr(offscreen, "_run", run)
    return end


def _drawn(running: list[subprocess.Popen[str]], scripts: Path, asked: str) -> bool:
    """Whether the process, which is started by the first picture, drew what was asked for."""
    if not running:
        command, pipe = [sys.executable, "-P", "-c", DRAWS, str(scripts)], subprocess.PIPE
        running.append(subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, text=True))
    (process,) = running
    if process.poll() is not None:
        return False
    assert process.stdin is not None and process.stdout is not None
    process.stdin.write(asked)
    process.stdin.flush()
    if select.select([process.stdout], [], [], offscreen.PATIENCE)[0] and process.stdout.readline() == asked:
        return True
    process.kill()
    return False
