"""Where the time of a match goes: CPU seconds by stage, with slopes in the number of vertices, and by function.

    GMDS_DATA=... python -m benchmarks.cost.profile_match

Warm, on one thread. Stages are those that `match` reports, for pairs of 5,000 vertices a side that are easy, locally
scaled, of two species, and a part, and for two poses of a cat at three sizes, with the slope of each stage in the
number of vertices. Functions by cProfile, which adds a tenth, of the cats. Writes results/profile.md.
"""

from __future__ import annotations

import cProfile
import os
import pstats
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.cost.against_pyfm import PAIRS, found
from benchmarks.cost.match_cost import SIZES, pair
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, read_mesh
from gmds import match
from gmds.deformations import cut

PAGE = RESULTS / "profile.md"
PACKAGES = ("gmds", "geodesics")
MOST, LEAST = 30, 0.05  # rows of a table, and seconds that a row must have
STAGES = ("measuring", "proposing", "embedding", "refining", "looking for the part")


def pairs_of_stages() -> Iterator[tuple[str, Mesh, Mesh]]:
    """A name and two meshes each."""
    data = Path(os.environ["GMDS_DATA"])
    for folder, source, target in PAIRS:
        one = found(data / folder, source, target)
        yield one.name, read_mesh(one.source), read_mesh(one.target)
    cats = pair(SIZES["5k"])[:2]
    yield "half of cat0 - cat2", cut(cats[0], 0.4, normal=(0, 0, 1))[0], cats[1]


def by_stage(source: Mesh, target: Mesh) -> dict[str, float]:
    """CPU seconds of each stage, and of all."""
    spent: dict[str, float] = {}
    began = last = time.process_time()
    stage = "measuring"

    def told(now: str, _: float) -> None:
        nonlocal last, stage
        at = time.process_time()
        spent[stage] = spent.get(stage, 0.0) + at - last
        last, stage = at, now

    match(fresh(source), fresh(target), progress=told)
    return {**spent, "all": time.process_time() - began}


def fresh(mesh: Mesh) -> Mesh:
    """The same, with nothing known of it yet."""
    return Mesh(mesh.vertices, mesh.faces)


def by_function(source: Mesh, target: Mesh) -> list[tuple[float, float, int, str]]:
    """CPU seconds with and without what it calls, and the number of calls, of each function."""
    profile = cProfile.Profile(time.process_time)
    profile.runcall(match, fresh(source), fresh(target))
    rows = []
    for (file, _, name), (_, calls, own, cumulative, _) in pstats.Stats(profile).stats.items():  # type: ignore[attr-defined]
        path = Path(file)
        package = next((part for part in PACKAGES if part in path.parts), None)
        where = "/".join(path.parts[path.parts.index(package) :]) if package else path.name
        if "<" not in name.replace("<built-in", ""):
            rows.append((cumulative if package else own, own, calls, name if where == "~" else f"{where} {name}"))
    return rows


def stage_lines(named: list[tuple[str, dict[str, float]]]) -> list[str]:
    """A line for each pair."""
    lines = [
        [name, *(f"{spent.get(stage, 0.0):.2f}" for stage in STAGES), f"{spent['all']:.2f}"] for name, spent in named
    ]
    return table(["pair", *STAGES, "all"], lines)


def main() -> None:
    """Measure, and write the page."""
    os.environ["GMDS_THREADS"] = "1"
    pairs = list(pairs_of_stages())
    match(*pairs[0][1:])
    match(*pairs[-1][1:])  # compiled
    lines = ["# Where the time of a match goes", ""]
    lines += ["`GMDS_DATA=... python -m benchmarks.cost.profile_match`; CPU seconds of one thread, warm.", ""]
    lines += ["## By stage, 5,000 vertices a side", ""]
    lines += stage_lines([(name, by_stage(source, target)) for name, source, target in pairs])
    sizes = {name: pair(size)[:2] for name, size in SIZES.items()}
    counts = np.array([np.mean([mesh.n_vertices for mesh in meshes]) for meshes in sizes.values()])
    spent = [(name, by_stage(*meshes)) for name, meshes in sizes.items()]
    times = np.array([[max(one.get(stage, 0.0), LEAST) for stage in (*STAGES[:4], "all")] for _, one in spent])
    slopes = np.diff(np.log(times), axis=0) / np.diff(np.log(counts))[:, None]
    lines += ["## By stage and size", "", *stage_lines(spent)]
    lines += ["Slopes, d log(seconds) / d log(vertices), from each size to the next: 1 is linear.", ""]
    steps = [f"{one} to {other}" for one, other in zip(SIZES, list(SIZES)[1:], strict=False)]
    rows = [[name, *(f"{value:.2f}" for value in row)] for name, row in zip(steps, slopes, strict=True)]
    lines += table(["sizes", *STAGES[:4], "all"], rows)
    functions = by_function(*sizes["5k"])
    total = max(row[0] for row in functions)
    for title, place in (("With what it calls", 0), ("Own time, the compiled code that it calls included", 1)):
        lines += [f"## {title}, two cats of 5,000 vertices", ""]
        most = sorted((row for row in functions if row[place] >= LEAST), key=lambda row: -row[place])[:MOST]
        cells = [[f"{row[place]:.2f}", f"{row[place] / total:.0%}", row[2], f"`{row[3]}`"] for row in most]
        lines += table(["CPU s", "share", "calls", "function"], cells)
    PAGE.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
