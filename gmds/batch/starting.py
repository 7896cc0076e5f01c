"""Starting the worker processes of this machine, which may die or be killed before they are there."""

from __future__ import annotations

import contextlib
import logging
import multiprocessing
import signal
import sys
from collections.abc import Iterator
from multiprocessing import resource_tracker
from typing import Any

from gmds.errors import WorkersNotStarted

STARTS = 3  # of all workers together, before the batch is given up; set by hand
GUARD = 'if __name__ == "__main__":'


def local_cluster(distributed: Any, workers: int | None) -> Any:
    """A cluster on this machine, of one thread a worker, whose workers were all seen alive.

    When one dies as it starts, all are started anew. Raises `WorkersNotStarted` (E506) when that has happened `STARTS`
    times.
    """
    for start in range(1, STARTS + 1):
        try:
            with interrupts_held_back():
                return distributed.LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    env={"GMDS_THREADS": "1"},  # there is a worker for every processor
                    processes=True,
                    dashboard_address="127.0.0.1:0",  # any port: others may run on this machine
                    silence_logs=logging.CRITICAL,
                )
        except (RuntimeError, OSError) as error:
            if start == STARTS:
                raise WorkersNotStarted(
                    f"no worker could be started, {STARTS} times ({error}): they were killed from outside or for want "
                    f"of memory, or a script starts a batch outside `{GUARD}`, which each of them runs again; "
                    "start fewer of them (--workers 1), or put the batch of a script below that line"
                ) from None


@contextlib.contextmanager
def interrupts_held_back() -> Iterator[None]:
    """Ctrl-C in a terminal reaches all processes: those that start meanwhile never see it, this one sees it after."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # or it is started with the first worker, and lets interrupts through after
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def end_if_starting() -> None:
    """End this process if it is a worker that is still starting and runs, to that end, the script that asked for it.

    Whatever it said nobody would understand: its parent tells what is the matter.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(1)
