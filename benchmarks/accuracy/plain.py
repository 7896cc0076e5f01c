"""Plain generalised multidimensional scaling: `match` with every distance and every loss, without registration.

    GMDS_DATA=... python -m benchmarks.accuracy.plain [--sets scaled] [--half reporting] [--every 8] [--grid | --hard]

Protocol and options as in accuracy.py. Writes plain_<set>.csv and plain.md to benchmarks/results/. A cell is named
"distance a eps smoothing loss": the distance in the metric (K^2 + eps^2)^(a/2) g, as `geodesics.scale_invariant` takes
its arguments. `--grid`, for the development half, varies a, eps and smoothing of geodesic distances, from the same
starts: plain_grid_<set>.csv and the second table. `--hard`: three distances on surfaces of other classes and species,
where maps may be wrong, plain_hard_<set>.csv and the third table.

Cells of one pair share what they have in common (measured surfaces, eigenfunctions, starts in the same metric), so run
with one worker; `cpu_seconds` are those of what a cell did not find done. `--signs DIR` keeps what the confidence of
each map is made of, for `benchmarks.trust.plain`.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import geodesics
import gmds
import gmds.evaluation
import gmds.matching.attempts
from benchmarks.accuracy.plain_page import write
from benchmarks.accuracy.runs import SMALL, Job, arguments, chosen_pairs, code_version, run
from benchmarks.trust.plain_signs import SIGNS, noted
from geodesics.arrays import Floats
from gmds.benchmarking.pairs import Pair
from gmds.correspondence import Correspondence
from gmds.matching.candidates import TIME
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import proposals
from gmds.surface.measured import EIGENFUNCTIONS, SMOOTHING, Surface, measure

EVERY = {"tosca_5k": 11, "faust_5k": 8, "scaled": 1}  # six of two sets, all of the third: a cell takes seconds
GRID_EVERY = {"tosca_5k": 22, "faust_5k": 16, "scaled": 2}  # of the development halves
HARD = {"tosca_cross_5k": 9, "shrec20": 4}  # other classes and species, of which maps may be wrong: two pairs of each
LOSSES: dict[str, Callable[[], Any]] = {"LeastSquares": gmds.LeastSquares, "Huber": gmds.Huber, "Minimax": gmds.Minimax}
FEW = {"L2_50": gmds.LeastSquares, "L4_50": lambda: gmds.Power(4.0)}  # with 50 samples, as the TOSCA toolbox has them
METRICS = {"diffusion": (0.0, 1.0), "commute": (0.0, 1.0), "geodesic": (0.0, 0.5, 1.0)}
CELLS = [f"{kind} {a:g} 1 {SMOOTHING:g} {loss}" for kind, exps in METRICS.items() for a in exps for loss in LOSSES]
CELLS += [f"geodesic 0 1 {SMOOTHING:g} {loss}" for loss in FEW]
GRID = [
    f"geodesic {a:g} {eps:g} {smoothing:g} Huber"
    for a, eps, smoothing in [
        *((a, 1.0, SMOOTHING) for a in (0.0, 1 / 3, 0.5, 2 / 3, 1.0)),
        *((a, 5.0, SMOOTHING) for a in (0.5, 1.0)),
        *((a, 1.0, 1e-3) for a in (0.5, 1.0)),
    ]
]

HARD_CELLS = [f"{kind} 1 {SMOOTHING:g} LeastSquares" for kind in ("commute 0", "commute 1", "geodesic 1")]
TABLES = {"plain": (CELLS, EVERY), "plain_grid": (GRID, GRID_EVERY), "plain_hard": (HARD_CELLS, HARD)}

_kept: dict[str, Any] = {}  # of the pair at hand
_warm: list[Correspondence] = []  # what a worker warmed up on


def kept(key: str, compute: Callable[[], Any]) -> Any:
    """What was computed for this key, if it was for this pair."""
    if key not in _kept:
        _kept[key] = compute()
    return _kept[key]


class KeptFields:
    """Geodesic distances that errors are judged by: the fields of true points serve all cells of a pair."""

    def __init__(self, target: geodesics.Mesh) -> None:
        self.mesh, self.exact = target, geodesics.GeodesicDistance(geodesics.embedded(target))

    def field(self, points: geodesics.SurfacePoints) -> Floats:
        """Distances (p, n) from points."""
        given = (self.mesh.vertices, points.face, points.barycentric)
        digest = hashlib.sha256(b"".join(one.tobytes() for one in given)).hexdigest()
        return kept(f"judged {digest}", lambda: self.exact.field(points))


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
    mock.patch.object(gmds.evaluation, "_embedded_geodesics", KeptFields).start()  # of a worker, which ends with it
    kind, *numbers, loss = name.split()
    settings = [float(number) for number in numbers]

    def matcher(source: geodesics.Mesh, target: geodesics.Mesh) -> Correspondence:
        if source.n_vertices == SMALL:  # what workers warm up on: once for all cells, and nothing is kept
            with mock.patch.dict(_kept, clear=True):
                if not _warm:
                    _warm.append(matched(source, target))
            return _warm[0]
        with noted(name, source, target):
            answer = matched(source, target)
        points = geodesics.SurfacePoints(target, answer.points.face, answer.points.barycentric)
        return replace(answer, source=source, target=target, points=points)  # the meshes kept are equal ones

    def matched(source: geodesics.Mesh, target: geodesics.Mesh) -> Correspondence:
        ours, theirs = surface(source), surface(target)

        def shared(pair: SurfacePair, *others: Any) -> Any:
            key = f"starts {starts or numbers} {pair.reflected} {pair.target.turned}"
            return kept(key, lambda: proposals(pair, *others))

        how = {"distance": partial(distance_of, kind, settings), "loss": (LOSSES | FEW)[loss]()}
        how |= {"n_samples": 50} if loss in FEW else {}
        with mock.patch.object(gmds.matching.attempts, "proposals", shared):
            return gmds.match(ours, theirs, **how)

    return matcher


def distance_of(kind: str, settings: Iterable[float], mesh: geodesics.Mesh) -> geodesics.Distance:
    """As `distance`, the mesh last."""
    return distance(mesh, kind, *settings)


def grid_cell(name: str) -> Callable[[geodesics.Mesh, geodesics.Mesh], Correspondence]:
    """The matcher of a cell of the grid: all cells of a pair have the same starts."""
    return cell(name, starts="of the first cell")


def spread(pairs: Sequence[Pair]) -> list[Pair]:
    """The pairs in an order (van der Corput's) in which the first few are from all over the set."""
    digits = max(len(pairs) - 1, 1).bit_length()
    order = sorted(range(len(pairs)), key=lambda place: f"{place:0{digits}b}"[::-1])
    return [pairs[place] for place in order]


def main() -> None:
    """Run, and write the tables."""
    parser = arguments(__doc__, EVERY, every=None)
    kind = parser.add_mutually_exclusive_group()
    for one in ("grid", "hard"):
        kind.add_argument(f"--{one}", action="store_const", const=f"plain_{one}", dest="kind", default="plain")
    parser.add_argument("--signs", type=Path, help="a folder that keeps what confidence is made of")
    parser.add_argument("--cells", help="cells with one of these words in their name, separated by commas")
    parser.set_defaults(workers=1, sets=None)
    options = parser.parse_args()
    version = code_version()
    if options.signs is not None:
        options.signs.mkdir(parents=True, exist_ok=True)
        os.environ[SIGNS] = str(options.signs)  # read by workers
    cells, sets = TABLES[options.kind]
    words = [""] if options.cells is None else options.cells.split(",")
    chosen = [one for one in cells if any(word in one for word in words)]
    pairs = {}
    for name in options.sets or sets:
        half = None if name == "scaled" else options.half  # those published are all for reporting
        pairs[name] = spread(chosen_pairs(name, half, options.every or sets.get(name, 1)))
    find = grid_cell if options.kind == "plain_grid" else cell
    for count in range(max(map(len, pairs.values()))):  # a pair of each in turn, or what is cut short says nothing
        for name, those in pairs.items():
            job = Job(name, those[: count + 1], chosen, find)
            run(job, options.output / f"{options.kind}_{name}.csv", version, options.workers)
    write(options.output, version, TABLES)


if __name__ == "__main__":
    main()
