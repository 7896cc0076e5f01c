"""Limbs, heads and halves cut off built-in shapes, TOSCA and FAUST, matched with another pose; and the way back.

    GMDS_DATA=... python -m benchmarks.accuracy.cuts [--groups TOSCA,FAUST] [--every N] [--workers 2]
    pip install pyfmaps==1.3.1; GMDS_DATA=... python -m benchmarks.accuracy.cuts --peer

Twenty parts, from which `gmds.deformations.cut` has taken 10 to 50 % of the area, each onto the whole of another pose
and the whole onto the part; every mesh turned and resized at random, defaults only. Truth and columns as in
`benchmarks.accuracy.parts`; that of built-in shapes is exact, also between vertices. No hyper-parameter was chosen on
these pairs. Writes results/cuts.csv, where what was measured at this version of the code is not measured again, and
results/cuts.md.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import gmds
from benchmarks.accuracy.part_tables import NAMES, cells_of, statuses
from benchmarks.accuracy.parts import PEER, Known, judged_row, read_rows, run
from benchmarks.accuracy.peers import functional_map
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, read_mesh
from geodesics.arrays import Floats
from gmds.benchmarking.truth_files import read_vts
from gmds.deformations import Part, carried, cut
from gmds.deformations.limbs import extremities
from gmds.shapes import humanoid, quadruped, truth

MAKERS = {"animal": quadruped, "person": humanoid}
VERTICES = 5000  # of built-in shapes, about as many as the others have
GOAL = "2.5 / 0.92"


class Cutting(NamedTuple):
    """A pose that is cut, one that stays whole, where it is cut, and how large a share of the area goes.

    `where` is `limb K`, a geodesic ball around the K-th most remote tip of a limb, or `axis +K` or `axis -K`, a plane
    across the K-th principal axis of which that end goes.
    """

    group: str
    part: str
    whole: str
    where: str
    share: float

    @property
    def name(self) -> str:
        """Without direction."""
        return f"{self.part}-{self.whole} {self.where} {self.share}"


CUTTINGS = (
    Cutting("built-in", "animal:walk", "animal:stand", "axis +1", 0.5),
    Cutting("TOSCA", "cat0", "cat2", "axis +1", 0.4),
    Cutting("FAUST", "tr_reg_000", "tr_reg_003", "limb 0", 0.1),
    Cutting("built-in", "person:kick", "person:stand", "limb 1", 0.2),
    Cutting("built-in", "animal:graze", "animal:walk", "limb 0", 0.1),
    Cutting("TOSCA", "horse0", "horse6", "axis -1", 0.5),
    Cutting("FAUST", "tr_reg_013", "tr_reg_016", "axis +1", 0.5),
    Cutting("built-in", "animal:stand", "animal:turn", "limb 2", 0.3),
    Cutting("TOSCA", "centaur0", "centaur3", "limb 1", 0.2),
    Cutting("FAUST", "tr_reg_021", "tr_reg_025", "axis -1", 0.4),
    Cutting("built-in", "person:wave", "person:walk", "axis +1", 0.5),
    Cutting("TOSCA", "michael1", "michael5", "limb 0", 0.1),
    Cutting("FAUST", "tr_reg_032", "tr_reg_035", "limb 2", 0.2),
    Cutting("built-in", "animal:walk", "animal:graze", "axis -1", 0.4),
    Cutting("TOSCA", "cat6", "cat10", "limb 3", 0.3),
    Cutting("FAUST", "tr_reg_043", "tr_reg_048", "limb 4", 0.3),
    Cutting("built-in", "person:stand", "person:wave", "limb 3", 0.3),
    Cutting("TOSCA", "michael3", "michael8", "axis +1", 0.4),
    Cutting("TOSCA", "horse5", "horse15", "limb 2", 0.15),
    Cutting("FAUST", "tr_reg_004", "tr_reg_009", "axis +2", 0.3),
)


def row(task: tuple[Cutting, bool], version: str) -> dict[str, Any]:
    """One cutting, the part onto the whole or the whole onto the part, matched and judged; by pyFM for its version."""
    cutting, back = task
    part, whole, known = (built_in if cutting.group == "built-in" else published)(cutting, back)
    meshes = (whole, part.mesh) if back else (part.mesh, whole)
    names = {"name": named(cutting, back), "group": cutting.group + (" back" if back else "")}
    return judged_row(names, meshes, known, version, functional_map if version == PEER else gmds.match)


def named(cutting: Cutting, back: bool) -> str:
    """The name of a row."""
    return f"{cutting.name} back" if back else cutting.name


def part_of(mesh: Mesh, cutting: Cutting) -> Part:
    """The mesh without what is cut off."""
    kind, number = cutting.where.split()
    if kind == "limb":
        return cut(mesh, cutting.share, centre=int(extremities(mesh)[0][int(number)]))
    return cut(mesh, cutting.share, normal=principal_axis(mesh, int(number)))


def principal_axis(mesh: Mesh, number: int) -> Floats:
    """The axis of vertices with the given rank from 1; reversed for a negative one. Its largest entry is positive."""
    axis = np.linalg.svd(mesh.vertices - mesh.vertices.mean(axis=0), full_matrices=False)[2][abs(number) - 1]
    axis = np.sign(axis[np.abs(axis).argmax()]) * axis
    return np.asarray(np.sign(number) * axis)


def built_in(cutting: Cutting, back: bool) -> tuple[Part, Mesh, Known]:
    """Part, whole and truth between built-in shapes, of triangulations of their own."""
    sides = [side.split(":") for side in (cutting.part, cutting.whole)]
    posed, whole = (MAKERS[who](pose, n_vertices=VERTICES, seed=seed) for seed, (who, pose) in enumerate(sides))
    part = part_of(posed, cutting)
    if not back:
        kept = np.flatnonzero(~part.missing)
        return part, whole, Known(np.arange(len(kept)), truth(posed, whole)[kept], np.array([], dtype=np.int64))
    points = truth(whole, posed)
    gone = points.interpolate(part.missing.astype(np.float64)) > 0
    there = np.flatnonzero(~gone)
    return part, whole, Known(there, carried(points[there], part.truth), np.flatnonzero(gone))


def published(cutting: Cutting, back: bool) -> tuple[Part, Mesh, Known]:
    """Part, whole and truth between remeshed shapes with canonical points."""
    folder = Path(os.environ["GMDS_DATA"]) / {"TOSCA": "tosca_5k", "FAUST": "faust_5k"}[cutting.group]
    posed, whole = (read_mesh(folder / f"{name}.off") for name in (cutting.part, cutting.whole))
    here, there = (read_vts(folder / "corres" / f"{name}.vts") for name in (cutting.part, cutting.whole))
    part = part_of(posed, cutting)
    number = np.cumsum(~part.missing) - 1  # of the old vertices, among those that remain
    kept = ~part.missing[here]
    if not back:
        return part, whole, Known(number[here[kept]], there[kept], np.array([], dtype=np.int64))
    return part, whole, Known(there[kept], number[here[kept]], there[~kept])


def page(rows: Sequence[Mapping[str, str]], version: str) -> str:
    """The table of all groups."""
    command = f"python -m benchmarks.accuracy.cuts{' --peer' if version == PEER else ''}"
    lines = ["# Cuts", "", f"`{command}` at {version}; see the script for the protocol.", ""]
    groups = sorted({one["group"] for one in rows})
    cells = [cells_of(group, [one for one in rows if one["group"] == group], GOAL) for group in groups]
    status = [] if version == PEER else ["", "## Status", "", *statuses({"all": rows})]
    return "\n".join([*lines, *table(NAMES, cells), *status, ""])


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--groups", type=lambda text: text.split(","), help="names, separated by commas")
    parser.add_argument("--every", type=int, default=1, help="every N-th row only")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--peer", action="store_true", help="pyFM on the same pairs")
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    name, version = ("peers_cuts", PEER) if options.peer else ("cuts", code_version())
    path = options.output / f"{name}.csv"
    tasks = [(cutting, back) for back in (False, True) for cutting in CUTTINGS]
    tasks = [(one, back) for one, back in tasks if options.groups is None or one.group in options.groups]
    done = read_rows(path, version)
    todo = [(one, back) for one, back in tasks[:: options.every] if named(one, back) not in done]
    rows = run(row, todo, path, version, options.workers)
    text = page(list(rows.values()), version)
    (options.output / f"{name}.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
