"""Built-in shapes of which one part grew or shrank, in other poses: how far maps are off, and what they say of it.

    python -m benchmarks.accuracy.built_in [--vertices 1500 3000 5000] [--seeds 201 202]

Source: the shape as it stands; target: another pose of another triangulation, one part larger or smaller. Errors are
distances in space to where all vertices belong, over the root of the area of the target, x100. Triangulations are drawn
by seeds of which none was used while the matcher was made. Pairs that results/built_in.csv has of the same version are
not run again.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics.threads import on_one_blas_thread
from gmds.files.table import read_table, write_table
from gmds.shapes import humanoid, quadruped, truth

SHAPES = {
    "animal": (
        quadruped,
        ("walk", "turn", "graze"),
        (("ear", 0.6), ("ear", 1.6), ("tail", 0.6), ("leg", 0.7), ("leg", 1.4), ("head", 1.4)),
    ),
    "person": (humanoid, ("walk", "wave", "kick"), (("head", 1.4), ("hand", 1.6), ("leg", 0.7), ("leg", 1.3))),
}
FAR, MANY = 0.1, 0.05  # root areas by which a point is in another place, and the share of such that makes a map wrong
COLUMNS = ("shape", "pose", "part", "size", "vertices", "seed", "error", "far", "status", "cpu_seconds", "version")


class Case(NamedTuple):
    """A shape in a `pose` with a `part` of another `size`, of so many `vertices`."""

    shape: str
    pose: str
    part: str
    size: float
    vertices: int
    seed: int

    @property
    def key(self) -> tuple[str, ...]:
        """As the table has it."""
        return tuple(map(str, self))


def cases(vertices: list[int], seeds: list[int]) -> Iterator[Case]:
    """All of them."""
    for count, seed, (shape, (_, poses, parts)) in itertools.product(vertices, seeds, SHAPES.items()):
        for pose, (part, size) in itertools.product(poses, parts):
            yield Case(shape, pose, part, size, count, seed)


@on_one_blas_thread
def row(case: Case) -> dict[str, Any]:
    """What comes of one."""
    make = SHAPES[case.shape][0]
    source = make(n_vertices=case.vertices, seed=case.seed)
    target = make(case.pose, n_vertices=case.vertices, seed=case.seed + 1000, **{f"{case.part}_scale": case.size})
    started = time.process_time()
    answer = gmds.match(source, target)
    seconds = time.process_time() - started
    errors = np.linalg.norm(answer.points.positions - truth(source, target).positions, axis=1) / np.sqrt(target.area)
    return {
        **dict(zip(COLUMNS, case.key, strict=False)),
        "error": f"{100 * errors.mean():.2f}",
        "far": f"{(errors > FAR).mean():.3f}",
        "status": answer.status.name,
        "cpu_seconds": f"{seconds:.1f}",
        "version": code_version(),
    }


def lines(rows: list[dict[str, str]]) -> Iterator[list[object]]:
    """A line of the page for each shape and size."""
    for shape, count in sorted({(one["shape"], int(one["vertices"])) for one in rows}):
        of_it = [one for one in rows if (one["shape"], one["vertices"]) == (shape, str(count))]
        errors, far = (np.array([float(one[column]) for one in of_it]) for column in ("error", "far"))
        good, wrong = np.array([one["status"] == "GOOD" for one in of_it]), far > MANY
        seconds = np.mean([float(one["cpu_seconds"]) for one in of_it])
        figures = [f"{value:.2f}" for value in (errors.mean(), np.median(errors), errors.max())]
        counts = [int(mask.sum()) for mask in (wrong, wrong & good, ~wrong & ~good)]
        yield [shape, f"{count:,}", len(of_it), *figures, *counts, f"{seconds:.1f}"]


def main() -> None:
    """Run what is not there, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vertices", type=int, nargs="+", default=[1500, 3000, 5000])
    parser.add_argument("--seeds", type=int, nargs="+", default=[201, 202])
    asked = parser.parse_args()
    path, version = RESULTS / "built_in.csv", code_version()
    rows = [one for one in read_table(path) if one["version"] == version] if path.exists() else []
    there = {tuple(one[column] for column in COLUMNS[:6]) for one in rows}
    for case in cases(asked.vertices, asked.seeds):
        if case.key not in there:
            rows.append(row(case))
            print(*rows[-1].values(), file=sys.stderr)
            write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in rows])
    head = ["shape", "vertices", "pairs", "mean", "median", "worst"]
    head += ["5 % off by 0.1", "of these GOOD", "right and not GOOD", "CPU s"]
    page = [
        "# Built-in shapes with parts that grew",
        "",
        f"`python -m benchmarks.accuracy.built_in` at {version}; x100.",
        "",
    ]
    (RESULTS / "built_in.md").write_text("\n".join([*page, *table(head, lines(rows)), ""]), encoding="utf-8")


if __name__ == "__main__":
    main()
