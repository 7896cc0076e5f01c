"""All pairs of many built-in shapes, once left alone and once with workers killed at random: are the files the same?

    python -m benchmarks.accuracy.collection --shapes 60 -o benchmarks/results/collection.csv

Animals and people in all poses, parts of other sizes, each triangulated anew. The second run has a thread that ends a
worker process with SIGKILL every now and then; a pair whose worker was killed three times is given up, told as failed,
and made by a third run that resumes. Prints what the runs took and whether maps, stored surfaces, summary and cycles
are the same byte for byte, and adds a line to the CSV. Folders are kept in --work, so a run that is stopped goes on.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from geodesics import Mesh
from gmds import __version__
from gmds.batch import Batch, local_client, match_collection
from gmds.files.table import table_text
from gmds.shapes import humanoid, humanoid_poses, quadruped, quadruped_poses

SAME = ("pairs/*.npz", "shapes/*.npz", "summary.csv", "cycles.csv")


def shapes(count: int, n_vertices: int) -> dict[str, Mesh]:
    """Shapes by name: all poses in turn, heads and legs of sizes that change from round to round."""
    makers = [(quadruped, pose) for pose in quadruped_poses] + [(humanoid, pose) for pose in humanoid_poses]
    rng, found = random.Random(0), {}
    for i in range(count):
        make, pose = makers[i % len(makers)]
        sizes = {"head_scale": rng.uniform(0.7, 1.6), "leg_scale": rng.uniform(0.8, 1.3)} if i >= len(makers) else {}
        found[f"{make.__name__}-{pose}-{i:02d}"] = make(pose, n_vertices=n_vertices, seed=i, **sizes)
    return found


@contextlib.contextmanager
def killing(client: Any, every: float, seed: int) -> Iterator[list[int]]:
    """A thread that kills a worker process of the cluster about `every` so many seconds; yields those it killed."""
    rng, over, killed = random.Random(seed), threading.Event(), []

    def kill() -> None:
        while not over.wait(rng.expovariate(1 / every)):
            alive = [nanny.pid for nanny in client.cluster.workers.values() if nanny.pid]
            with contextlib.suppress(ProcessLookupError, IndexError):
                os.kill(pid := rng.choice(alive), signal.SIGKILL)
                killed.append(pid)

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    try:
        yield killed
    finally:
        over.set()
        thread.join()


def files(folder: Path) -> dict[str, bytes]:
    """What has to be the same, whatever happened on the way."""
    return {str(p.relative_to(folder)): p.read_bytes() for pattern in SAME for p in sorted(folder.glob(pattern))}


def told(title: str, done: Batch, seconds: float) -> None:
    statuses = [pair.status for pair in done.pairs]
    print(
        f"{title}: {len(done.pairs)} pairs of {len(done.shapes)} shapes in {seconds:.0f} s, "
        f"CPU {sum(s.seconds for s in done.shapes.values()):.0f} s for shapes and "
        f"{sum(p.seconds for p in done.pairs):.0f} s for pairs, {len(done.failed)} failed, "
        + ", ".join(f"{name} {statuses.count(name)}" for name in dict.fromkeys(statuses)),
        flush=True,
    )


def parsed() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shapes", type=int, default=60)
    parser.add_argument("--vertices", type=int, default=50, help="of each shape; the least there can be")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kill-every", type=float, default=20.0, help="mean seconds between two kills")
    parser.add_argument("--seed", type=int, default=0, help="of the killing")
    parser.add_argument("--work", type=Path, default=Path("collection-work"), help="folder for both outputs")
    parser.add_argument("-o", "--output", type=Path, help="CSV that gets a line")
    return parser.parse_args()


def add_row(path: Path, row: dict[str, object]) -> None:
    """One more line of a CSV."""
    lines = [list(row.values())] if path.exists() else [list(row), list(row.values())]
    with path.open("a", newline="", encoding="utf-8") as stream:
        stream.write(table_text(lines))


def main() -> None:
    options = parsed()
    collection = shapes(options.shapes, options.vertices)
    alone, disturbed = options.work / "alone", options.work / "disturbed"
    begun = time.perf_counter()
    with local_client(options.workers) as client:
        one = match_collection(collection, alone, client=client)
    quiet, begun = time.perf_counter() - begun, time.perf_counter()
    told("left alone", one, quiet)
    with local_client(options.workers) as client, killing(client, options.kill_every, options.seed) as killed:
        other = match_collection(collection, disturbed, client=client)
    loud, begun = time.perf_counter() - begun, time.perf_counter()
    told(f"{len(killed)} workers killed", other, loud)
    if other.failed:
        with local_client(options.workers) as client:
            told("resumed", match_collection(collection, disturbed, client=client), time.perf_counter() - begun)
    expected, found = files(alone), files(disturbed)
    different = sorted(name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name))
    print(f"{len(expected)} files, {len(different)} different{': ' + ', '.join(different[:5]) if different else ''}")
    print(f"cycles: {len(one.consistency.cycles)}, mean {one.consistency.mean or 0:.3f} root areas")
    if options.output is not None:
        row = {"version": __version__, "shapes": len(one.shapes), "vertices": options.vertices, "pairs": len(one.pairs)}
        row |= {"workers": options.workers, "seconds_alone": round(quiet), "seconds_disturbed": round(loud)}
        row |= {"workers_killed": len(killed), "given_up": len(other.failed), "files": len(expected)}
        row |= {"different": len(different), "cycles": len(one.consistency.cycles)}
        add_row(options.output, {**row, "cycle_mean": round(one.consistency.mean or 0.0, 4)})
    raise SystemExit(1 if different else 0)


if __name__ == "__main__":
    main()
