"""Tasks on dask.distributed: workers that may die, and no more tasks in the air than there are threads to do them."""

from __future__ import annotations

import contextlib
import itertools
import logging
import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from geodesics.errors import MissingExtra
from geodesics.extras import how_to_install
from gmds.batch.records import WORKER_DIED, Failure
from gmds.batch.starting import end_if_starting, local_cluster

Job = TypeVar("Job")
Result = TypeVar("Result")

# all four set by hand; no map depends on them
TRIES = 3  # workers that may die of a task before it is given up
LOST_AFTER = 30  # seconds that a worker may take to come back, after which it is replaced
COUNT_EVERY = 1.0  # seconds between two counts of the threads
LOOK_EVERY = 5.0  # seconds between two looks at the workers while nothing is done
# Dask looks at stacks of workers 100 times a second, and at event loops 50 times: a sixth of the CPU time of work in
# Python, and half of that of waiting.
UNWATCHED = {"distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "500 ms"}
INSTALL = f"a batch needs dask.distributed; install it with: {how_to_install('batch')}"


@contextlib.contextmanager
def local_client(workers: int | None = None) -> Iterator[Any]:
    """A client of a cluster on this machine: one process and thread for each processor, or as many as `workers`.

    Together they may take the memory there is; one that takes more than its share is ended and replaced.
    Raises `MissingExtra` (E602), `WorkersNotStarted` (E506).
    """
    end_if_starting()
    distributed = _distributed()
    import dask

    settings = {
        "distributed.scheduler.allowed-failures": TRIES - 1,
        "distributed.deploy.lost-worker-timeout": f"{LOST_AFTER} s",
        **UNWATCHED,
    }
    with contextlib.ExitStack() as stack:
        stack.enter_context(dask.config.set(settings))
        cluster = local_cluster(distributed, workers)
        client = stack.enter_context(distributed.Client(stack.enter_context(cluster)))
        try:
            client.register_worker_callbacks(_ignore_interrupts)
            yield client
        except BaseException:
            for nanny in cluster.workers.values():
                _end(nanny)
            raise


@contextlib.contextmanager
def remote_client(address: str) -> Iterator[Any]:
    """A client of the scheduler at an address. Raises `MissingExtra` (E602), `OSError` when nobody answers there."""
    with _distributed().Client(address, timeout=20) as client:
        yield client


def quiet() -> None:
    """Keeps the log of dask to itself, in a process that reports failures itself and may be interrupted."""
    _distributed()  # its import sets levels
    for name in ("distributed", "asyncio"):  # the latter tells of connections that are cut when all is ended
        logging.getLogger(name).setLevel(logging.CRITICAL)


def outcomes(
    client: Any, function: Callable[[Job], Result], jobs: Iterable[Job]
) -> Iterator[tuple[Job, Result | Failure]]:
    """Each job with its result as soon as it is there; a job whose workers die gets a `Failure`, and the rest go on.

    Jobs are taken as workers become free, so there may be any number of them. When the caller stops, so do they.
    """
    waiting, running = iter(jobs), dict[Any, Job]()
    threads, asked = 0, time.monotonic() - 2 * COUNT_EVERY
    try:
        while True:
            if time.monotonic() > asked + COUNT_EVERY:
                threads, asked = max(1, sum(client.nthreads().values())), time.monotonic()
            for job in itertools.islice(waiting, max(0, threads - len(running))):
                running[client.submit(function, job, pure=False)] = job
            if not running:
                return
            for future in _finished(client, list(running)):
                yield running.pop(future), _result(future)
    finally:
        client.cancel(list(running), force=True)


def _finished(client: Any, futures: list[Any]) -> Iterable[Any]:
    """Those of the futures that are done, if any is within `LOOK_EVERY` seconds; else lost workers are replaced."""
    from distributed import wait

    try:
        done: Iterable[Any] = wait(futures, timeout=LOOK_EVERY, return_when="FIRST_COMPLETED").done
    except TimeoutError:
        if isinstance(client.cluster, _distributed().LocalCluster):  # forgets a worker that was killed as it started
            client.cluster.scale(len(client.cluster.worker_spec))
        return ()
    return [future for future in futures if future in done]


def _ignore_interrupts() -> None:
    """Ctrl-C in a terminal reaches all processes; the first one instructs the workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _end(nanny: Any) -> None:
    """End a worker process in the middle of its work, and let no other take its place."""
    nanny.close_gracefully()
    if nanny.pid is not None:
        with contextlib.suppress(OSError):
            os.kill(nanny.pid, getattr(signal, "SIGKILL", signal.SIGTERM))


def _result(future: Any) -> Any:
    from distributed import KilledWorker

    try:
        return future.result()
    except KilledWorker:
        return Failure(WORKER_DIED, f"{TRIES} workers died of it: killed from outside, or for want of memory")
    except Exception as error:
        return Failure.of(error)


def _distributed() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise MissingExtra(INSTALL) from error
    return distributed
