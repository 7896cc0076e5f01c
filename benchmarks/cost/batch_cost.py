"""What the pairs of a batch cost: a shape measured once, a pair of stored shapes, a pair of meshes, and what is kept.

    python -m benchmarks.cost.batch_cost

Two built-in animals in different poses, one with a larger head. CPU seconds of one thread, the better of two;
writes results/batch_cost.md.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.places import RESULTS

os.environ["GMDS_THREADS"] = "1"

from geodesics import Mesh
from gmds import dissimilarity, distance_profile, least_distortion, match
from gmds.batch.surface_file import read_surface, write_surface
from gmds.shapes import quadruped
from gmds.surface.measured import measure

PAGE = RESULTS / "batch_cost.md"
SIZES = (50, 600, 1000, 3000, 5000)  # vertices
COLUMNS = ("vertices", "a shape, once", "a pair of meshes", "a pair of stored shapes", "saved", "stored shape", "map")
COLUMNS += ("reading a shape", "profile of a shape", "bound of a pair", "dissimilarity of a pair")


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """CPU seconds of the better of two runs, and what the last returned."""
    seconds = []
    for _ in range(2):
        begun = time.process_time()
        found = work()
        seconds.append(time.process_time() - begun)
    return min(seconds), found


def row(n_vertices: int, folder: Path) -> tuple[str, ...]:
    """The line of one size."""
    meshes: list[Mesh] = [
        quadruped("stand", n_vertices=n_vertices),
        quadruped("walk", n_vertices=n_vertices, head_scale=1.5, seed=1),
    ]
    paths = [folder / f"{i}.npz" for i in range(2)]
    once, _ = timed(lambda: [write_surface(path, measure(m)) for path, m in zip(paths, meshes, strict=True)])
    alone, answer = timed(lambda: match(*meshes))
    stored, _ = timed(lambda: match(*(read_surface(path) for path in paths)))
    reading, _ = timed(lambda: read_surface(paths[0]))
    profile, _ = timed(lambda: distance_profile(meshes[0]))
    ours, theirs = (distance_profile(m) for m in meshes)
    bound, _ = timed(lambda: least_distortion(ours, theirs))
    apart, _ = timed(lambda: dissimilarity(*meshes))
    answer.save(folder / "map.npz")
    sizes = paths[0].stat().st_size, (folder / "map.npz").stat().st_size
    return (
        f"{n_vertices:,}",
        f"{once / 2:.1f}",
        f"{alone:.1f}",
        f"{stored:.1f}",
        f"{1 - stored / alone:.0%}",
        f"{sizes[0] / 1e6:.1f} MB",
        f"{sizes[1] / 1e3:.0f} kB",
        f"{1e3 * reading:.0f} ms",
        f"{profile:.2f}",
        f"{1e3 * bound:.1f} ms",
        f"{apart:.1f}",
    )


def main() -> None:
    """Measure and write the page."""
    match(*(quadruped(pose, n_vertices=300) for pose in ("stand", "walk")))  # compiles
    with tempfile.TemporaryDirectory() as folder:
        rows = [row(n, Path(folder)) for n in SIZES]
    lines = [
        "# Cost of the pairs of a batch",
        "",
        "`python -m benchmarks.cost.batch_cost`: CPU seconds of one thread.",
        "",
    ]
    lines += [f"| {' | '.join(cells)} |" for cells in (COLUMNS, ["---"] * len(COLUMNS), *rows)]
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
