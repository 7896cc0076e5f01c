"""Worker processes forked from one that has imported and called what they need: each takes two seconds for it, spawned.

Only those of clusters that tests start in their own process; a command that is started as a process spawns its own.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from gmds.batch import workers


def use(patch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Let local clusters fork their workers, on Linux; what is returned ends the process that they come from."""
    if sys.platform != "linux":  # elsewhere forks are unsafe, or there are none
        return lambda: None
    from multiprocessing import forkserver

    started = workers.local_cluster

    def local_cluster(distributed: Any, count: int | None) -> Any:
        import dask

        dask.config.set({"distributed.worker.multiprocessing-method": "forkserver"})
        distributed.utils.get_mp_context().set_forkserver_preload(["distributed", "warm_worker"])
        with pytest.MonkeyPatch.context() as environment:
            environment.setenv("PYTHONPATH", str(Path(__file__).parent), prepend=os.pathsep)
            forkserver.ensure_running()
        return started(distributed, count)

    patch.setattr(workers, "local_cluster", local_cluster)
    return forkserver._forkserver._stop  # type: ignore[attr-defined]
