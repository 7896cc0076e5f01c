"""What an atlas costs: CPU time beside that of its shapes and pairs, memory of the driver, and a run that is killed.

    python -m benchmarks.cost.atlas_cost FOLDER [--counts 15 30 60] [--vertices 5000]

Built-in animals in four poses, with parts of other sizes. Each count is one `gmds atlas` with one worker and nothing
kept from before, in a process of its own: CPU seconds are its own and those of its workers, memory the most that it,
not its workers, held. A *shape* is what `match_collection` measures of each, a *pair* a match of two measured shapes:
the mean CPU seconds of those of that run. The goal is `count` times a shape and one and a half pairs. The smallest
count is run once more, killed with all its workers once a third of its maps are there, and started again: its files
are to be the same bytes. FOLDER keeps what was measured. Writes results/atlas_cost.md.
"""

from __future__ import annotations

import argparse
import functools
import hashlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.memory import peak_megabytes
from benchmarks.places import RESULTS
from geodesics import write_mesh
from gmds.shapes import Figure, quadruped

PAGE = RESULTS / "atlas_cost.md"
POSES = ("stand", "walk", "graze", "turn")
SAME = ("atlas.npz", "mean.ply", "summary.csv", "variation.csv", "registered")
KILLED_AT = 1 / 3  # of the maps


def animals(count: int, vertices: int) -> Iterator[tuple[str, Figure]]:
    """`count` animals in four poses, of which parts are larger or smaller by 15 % (standard deviation), with names."""
    rng = np.random.default_rng(3)
    for i in range(count):
        ear, leg, head = np.exp(0.15 * rng.standard_normal(3)).tolist()
        pose = POSES[i % len(POSES)]
        yield (
            f"animal{i:02d}",
            quadruped(pose, n_vertices=vertices, seed=i, ear_scale=ear, leg_scale=leg, head_scale=head),
        )


def write_animals(folder: Path, count: int, vertices: int) -> None:
    """The animals as files of a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    if len(list(folder.iterdir())) < count:
        for name, mesh in animals(count, vertices):
            write_mesh(mesh, folder / f"{name}.ply")


def child(meshes: Path, count: int, out: Path) -> None:
    """One atlas in this process; what it took as a line of JSON."""
    from gmds.atlases.build import atlas
    from gmds.atlases.output import write_atlas
    from gmds.batch import local_client

    made = atlas(sorted(meshes.iterdir())[:count], out, client=local_client(1))
    write_atlas(made, out)
    own, others = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    cpu = sum(usage.ru_utime + usage.ru_stime for usage in (own, others))
    print(json.dumps({"cpu": cpu, "own": own.ru_utime + own.ru_stime, "memory": peak_megabytes()}))


def command(meshes: Path, count: int, out: Path) -> list[str]:
    """The command of `child`."""
    return [
        sys.executable,
        "-m",
        "benchmarks.cost.atlas_cost",
        str(out),
        "--child",
        str(meshes),
        "--counts",
        str(count),
    ]


def pair_seconds(out: Path) -> float:
    """Mean CPU seconds of a pair, as the run has written them."""
    events = [json.loads(line) for line in (out / "maps" / "manifest.jsonl").read_text().splitlines()]
    pairs = [event["seconds"] for event in events if event.get("source") and event.get("seconds")]
    return float(np.mean(pairs))


def shape_seconds(meshes: Path, out: Path, some: int = 5) -> float:
    """Mean CPU seconds that measuring and storing a shape takes."""
    from gmds.batch.collection import Shape
    from gmds.batch.store import Store

    shutil.rmtree(out, ignore_errors=True)
    (out / "shapes").mkdir(parents=True)
    store, spent = Store(out / "shapes"), []
    for path in sorted(meshes.iterdir())[:some]:
        started = time.process_time()
        store.keep(Shape(path.stem, path))
        spent.append(time.process_time() - started)
    return float(np.mean(spent[1:]))  # the first compiles


def killed_and_resumed(meshes: Path, count: int, out: Path) -> None:
    """An atlas whose processes are all killed once some maps are there; then the same command again."""
    run = subprocess.Popen(command(meshes, count, out), start_new_session=True, stdout=subprocess.DEVNULL)
    while len(list((out / "maps" / "pairs").glob("*.npz"))) < KILLED_AT * count and run.poll() is None:
        time.sleep(0.2)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    subprocess.run(command(meshes, count, out), check=True, stdout=subprocess.DEVNULL)


def digests(out: Path) -> dict[str, str]:
    """A digest of every file that an atlas consists of."""
    files = [
        path for name in SAME for path in (sorted((out / name).iterdir()) if (out / name).is_dir() else [out / name])
    ]
    return {str(path.relative_to(out)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def measured(meshes: Path, count: int, out: Path, shape: Callable[[], float]) -> dict[str, Any]:
    """What one atlas takes, beside its goal; from the folder, where it was measured before."""
    kept = out / "cost.json"
    if kept.exists():
        return dict(json.loads(kept.read_text(encoding="utf-8")))
    done = subprocess.run(command(meshes, count, out), check=True, capture_output=True, text=True)
    told = json.loads(done.stdout.splitlines()[-1])
    found = {"count": count, **told, "shape": shape(), "pair": pair_seconds(out), "version": code_version()}
    found["goal"] = count * (found["shape"] + 1.5 * found["pair"])
    kept.write_text(json.dumps(found), encoding="utf-8")
    print(found, flush=True)
    return found


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--counts", type=int, nargs="+", default=[15, 30, 60])
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--child", type=Path)
    given = parser.parse_args()
    if given.child:
        return child(given.child, given.counts[0], given.folder)
    os.environ["GMDS_THREADS"] = "1"
    folder, counts = given.folder, sorted(given.counts)
    meshes = folder / "meshes"
    write_animals(meshes, counts[-1], given.vertices)
    shape = functools.partial(shape_seconds, meshes, folder / "shape")
    largest_first = [measured(meshes, count, folder / f"atlas-{count}", shape) for count in reversed(counts)]
    rows = largest_first[::-1]
    killed_and_resumed(meshes, counts[0], folder / "killed")
    before, after = digests(folder / f"atlas-{counts[0]}"), digests(folder / "killed")
    PAGE.write_text(page(rows, before == after, len(before), given.vertices), encoding="utf-8")
    return None


def page(rows: list[dict[str, Any]], is_same: bool, files: int, vertices: int) -> str:
    """The table."""
    lines = []
    for row in rows:
        figures = (f"{row[key]:.1f}" for key in ("cpu", "shape", "pair", "goal"))
        lines.append([row["count"], *figures, f"{row['cpu'] / row['goal']:.2f}", f"{row['own']:.1f}"])
        lines[-1] += [f"{row['memory']:.0f}", row["version"]]
    head = ["specimens", "CPU s", "a shape", "a pair", "goal", "of the goal", "driver, CPU s", "driver, MB", "version"]
    told = f"`python -m benchmarks.cost.atlas_cost FOLDER`, {vertices:,} vertices, a machine with other work."
    about = (
        f"The atlas of {rows[0]['count']} that was killed and started again: {files} files, "
        f"{'all the same bytes' if is_same else '**not the same bytes**'}."
    )
    return "\n".join(["# Cost of an atlas", "", told, "", *table(head, lines), about, ""])


if __name__ == "__main__":
    main()
