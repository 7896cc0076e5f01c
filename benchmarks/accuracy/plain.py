"""Plain generalised multidimensional scaling: `match` with every distance and every loss, without registration.

    GMDS_DATA=... python -m benchmarks.accuracy.plain [--sets scaled] [--half reporting] [--every 8] [--grid]

Protocol and options as in accuracy.py. Writes plain_<set>.csv and plain.md to benchmarks/results/. A cell is named
"distance a eps smoothing loss": the distance in the metric (K^2 + eps^2)^(a/2) g, as `geodesics.scale_invariant` takes
its arguments. `--grid`, for the development half, varies a, eps and smoothing of geodesic distances, from the same
starts: plain_grid_<set>.csv and the second table.

Cells of one pair share what they have in common (measured surfaces, eigenfunctions, starts in the same metric), so run
with one worker; `cpu_seconds` are those of what a cell did not find done. `--signs DIR` keeps what the confidence of
each map is made of, for `benchmarks.trust.plain`.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import geodesics
import gmds
import gmds.matching.attempts
from benchmarks.accuracy.halves import pairs_of
from benchmarks.accuracy.runs import SMALL, Job, Rows, arguments, chosen_pairs, code_version, read_rows, run
from benchmarks.markdown import table
from benchmarks.trust.plain_signs import SIGNS, noted
from gmds.benchmarking.run import BenchmarkRow
from gmds.correspondence import Correspondence
from gmds.matching.candidates import TIME
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import proposals
from gmds.surface.measured import EIGENFUNCTIONS, SMOOTHING, Surface, measure

EVERY = {"tosca_5k": 17, "faust_5k": 12, "scaled": 2}  # four or five pairs of each: a cell takes seconds
FAILED = 15.0  # mean error x100 above which a map is wrong, as the goals of this table say
LOSSES: dict[str, Callable[[], Any]] = {"LeastSquares": gmds.LeastSquares, "Huber": gmds.Huber, "Minimax": gmds.Minimax}
METRICS = {"diffusion": (0.0, 1.0), "commute": (0.0, 1.0), "geodesic": (0.0, 0.5, 1.0)}
CELLS = [f"{kind} {a:g} 1 {SMOOTHING:g} {loss}" for kind, exps in METRICS.items() for a in exps for loss in LOSSES]
GRID = [
    f"geodesic {a:g} {eps:g} {smoothing:g} Huber"
    for a, eps, smoothing in [
        *((a, 1.0, SMOOTHING) for a in (0.0, 1 / 3, 0.5, 2 / 3, 1.0)),
        *((a, 5.0, SMOOTHING) for a in (0.5, 1.0)),
        *((a, 1.0, 1e-3) for a in (0.5, 1.0)),
    ]
]

_kept: dict[str, Any] = {}  # of the pair at hand


def kept(key: str, compute: Callable[[], Any]) -> Any:
    """What was computed for this key, if it was for this pair."""
    if key not in _kept:
        _kept[key] = compute()
    return _kept[key]


def surface(mesh: geodesics.Mesh) -> Surface:
    """The mesh measured, once."""
    digest = hashlib.sha256(mesh.vertices.tobytes()).hexdigest()
    if not any(key == f"surface {digest}" for key in _kept) and sum(key.startswith("surface") for key in _kept) == 2:
        _kept.clear()
    return kept(f"surface {digest}", partial(measure, mesh))


def distance(mesh: geodesics.Mesh, kind: str, *settings: float) -> geodesics.Distance:
    """A distance of a kind in the metric of exponent, regularisation and smoothing."""
    key = f"{id(mesh)} {settings}"
    a, eps, smoothing = settings
    metric = kept(
        f"metric {key}", lambda: geodesics.scale_invariant(mesh, exponent=a, regularisation=eps, smoothing=smoothing)
    )
    if kind == "geodesic":
        return kept(f"geodesic {key}", lambda: gmds.TabulatedDistance(geodesics.GeodesicDistance(metric)))
    count = min(EIGENFUNCTIONS, mesh.n_vertices - 1)
    spectrum = kept(f"spectrum {key}", lambda: geodesics.eigenpairs(metric, count))
    return (
        geodesics.DiffusionDistance(spectrum, TIME) if kind == "diffusion" else geodesics.CommuteTimeDistance(spectrum)
    )


def cell(name: str, *, starts: str | None = None) -> Callable[[geodesics.Mesh, geodesics.Mesh], Correspondence]:
    """The matcher of a cell; those with the same `starts` share them, by default those in the same metric."""
    kind, *numbers, loss = name.split()
    settings = [float(number) for number in numbers]

    def matcher(source: geodesics.Mesh, target: geodesics.Mesh) -> Correspondence:
        if source.n_vertices == SMALL:  # what workers warm up on keeps nothing
            with mock.patch.dict(_kept, clear=True):
                return matched(source, target)
        with noted(name, source, target):
            return matched(source, target)

    def matched(source: geodesics.Mesh, target: geodesics.Mesh) -> Correspondence:
        ours, theirs = surface(source), surface(target)

        def shared(pair: SurfacePair, *others: Any) -> Any:
            key = f"starts {starts or numbers} {pair.reflected} {pair.target.turned}"
            return kept(key, lambda: proposals(pair, *others))

        how = {"distance": partial(distance_of, kind, settings), "loss": LOSSES[loss]()}
        with mock.patch.object(gmds.matching.attempts, "proposals", shared):
            return gmds.match(ours, theirs, **how)

    return matcher


def distance_of(kind: str, settings: Iterable[float], mesh: geodesics.Mesh) -> geodesics.Distance:
    """As `distance`, the mesh last."""
    return distance(mesh, kind, *settings)


def grid_cell(name: str) -> Callable[[geodesics.Mesh, geodesics.Mesh], Correspondence]:
    """The matcher of a cell of the grid: all cells of a pair have the same starts."""
    return cell(name, starts="of the first cell")


def figures(rows: list[BenchmarkRow]) -> str:
    """Mean, median and failures of some rows."""
    errors = [row.direct for row in rows if row.direct is not None]
    if not errors:
        return "-"
    wrong = sum(error > FAILED for error in errors) + len(rows) - len(errors)
    return f"{np.mean(errors):.1f} ({np.median(errors):.1f}; {wrong} of {len(rows)})"


def report(found: Mapping[str, Rows], cells: list[str], about: str) -> list[str]:
    """A line for each cell: mean error (median; failures) on each set, the groups of `scaled` apart."""
    groups = {name: sorted({row.group for row in rows.values()}) for name, rows in found.items() if rows}
    columns = [(name, group) for name, those in groups.items() for group in those]
    lines = []
    for one in cells:
        kind, a, eps, smoothing, loss = one.split()
        mine = [
            [row for (who, _), row in found[name].items() if who == one and row.group == group]
            for name, group in columns
        ]
        if any(mine):
            lines.append([kind, a, eps, smoothing, loss, *map(figures, mine)])
    head = ["distance", "a", "eps", "smoothing", "loss", *(f"{name} {group}".strip() for name, group in columns)]
    return [about, "", *table(head, lines)]


def main() -> None:
    """Run, and write the tables."""
    parser = arguments(__doc__, EVERY, every=None)
    parser.add_argument("--grid", action="store_true", help="a, eps and smoothing of geodesic distances")
    parser.add_argument("--signs", type=Path, help="a folder that keeps what confidence is made of")
    parser.add_argument("--cells", help="cells with this in their name")
    parser.set_defaults(workers=1)
    options = parser.parse_args()
    version = code_version()
    if options.signs is not None:
        options.signs.mkdir(parents=True, exist_ok=True)
        os.environ[SIGNS] = str(options.signs)  # read by workers
    cells, find, prefix = (GRID, grid_cell, "plain_grid") if options.grid else (CELLS, cell, "plain")
    for name in options.sets:
        half = options.half if pairs_of(name) and options.half else None
        chosen = cells if options.cells is None else [one for one in cells if options.cells in one]
        job = Job(name, chosen_pairs(name, half, options.every or EVERY.get(name, 1)), chosen, find)
        run(job, options.output / f"{prefix}_{name}.csv", version, options.workers)
    write(options.output, version)


def write(output: Any, version: str) -> None:
    """plain.md, of the rows that are there."""
    sections = ["# Plain generalised multidimensional scaling", "", f"Measured at {version}. {ABOUT}", ""]
    for prefix, cells, about in (("plain", CELLS, MAIN), ("plain_grid", GRID, OF_GRID)):
        found = {name: read_rows(output / f"{prefix}_{name}.csv", version) for name in EVERY}
        if any(found.values()):
            sections += report({name: rows for name, rows in found.items() if rows}, cells, about)
    (output / "plain.md").write_text("\n".join(sections), encoding="utf-8")


ABOUT = f"""Mean geodesic error x100, direct, of `match(distance=..., loss=...)`, without registration
(the median; how many are above {FAILED:g} or failed). Distances are those of the metric (K^2 + eps^2)^(a/2) g."""
MAIN = "## Distances and losses\n\n`python -m benchmarks.accuracy.plain --half reporting`"
OF_GRID = """## What a, eps and smoothing do to geodesic distances

`python -m benchmarks.accuracy.plain --half development --grid`"""


if __name__ == "__main__":
    main()
