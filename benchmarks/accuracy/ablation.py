"""What each part of `match` is worth: one thing changed at a time, on some pairs of several sets.

    GMDS_DATA=... python -m benchmarks.accuracy.ablation [--variants "loss Huber"] [--sets scaled] [--every 8]

Protocol and options as in accuracy.py. Writes ablation_<set>.csv, and ablation.md from all rows of this version of the
code, to benchmarks/results/. `--variants list` prints the names. A variant that changes no argument but something
inside the matcher is a line in `INSIDE`.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from functools import partial
from types import ModuleType
from typing import Any
from unittest import mock

import geodesics
import gmds.initialization
import gmds.matching.candidates
import gmds.matching.pair
import gmds.matching.steps
import gmds.surface.measured
from benchmarks.accuracy.halves import DEVELOPMENT
from benchmarks.accuracy.runs import Job, Rows, arguments, chosen_pairs, code_version, read_rows, run
from benchmarks.accuracy.tables import number
from benchmarks.markdown import table
from gmds.benchmarking.run import Matcher
from gmds.cli.choices import chosen_distance
from gmds.correspondence import Correspondence
from gmds.matching.candidates import TIME, MapCandidate
from gmds.matching.evidence import Evidence
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.registration.register import Registered, assessed
from gmds.registration.settings import FULL
from gmds.surface.measured import EIGENFUNCTIONS, SMOOTHING

EVERY = {"scaled": 1, "faust_5k": 11, "tosca_5k": 11, "tosca_cross_5k": 4}  # steps that meet pairs of both halves
BASE = "as it is"
EXPONENTS = {"0": 0.0, "1/3": 1 / 3, "1": 1.0}
SPECTRAL: dict[str, Callable[..., geodesics.Distance]] = {
    "diffusion": partial(geodesics.DiffusionDistance, time=TIME),
    "commute time": geodesics.CommuteTimeDistance,
}
ABOUT = f"""Mean geodesic error x100, direct (worst pair), and CPU seconds a pair. A distance "alone at exponent a":
starts, solve and choice all use that distance in the metric |K|^a g, curvature smoothed {SMOOTHING:g}; exponent 0 is
the metric of space. "Scale-invariant metric alone" is `gmds match --metric scale-invariant`, smoothed more. Losses are
those of the embedding."""


def distance(mesh: geodesics.Mesh, kind: str, exponent: float) -> geodesics.Distance:
    """A distance of a kind in the metric |K|^a g."""
    metric = geodesics.scale_invariant(mesh, exponent=exponent, smoothing=SMOOTHING)
    if kind == "geodesic":
        return geodesics.GeodesicDistance(metric)
    return SPECTRAL[kind](geodesics.eigenpairs(metric, min(EIGENFUNCTIONS, mesh.n_vertices - 1)))


def changed(changes: Mapping[ModuleType | type, Mapping[str, Any]]) -> Matcher:
    """`match` while attributes of modules or classes are others; raises AttributeError now where one does not exist."""
    for module, values in changes.items():
        for name in values:
            getattr(module, name)

    def matcher(source: geodesics.Mesh, target: geodesics.Mesh) -> Correspondence:
        with contextlib.ExitStack() as stack:
            for module, values in changes.items():
                stack.enter_context(mock.patch.multiple(module, **values))
            return gmds.match(source, target)

    return matcher


def left_as_it_is(pair: SurfacePair, points: geodesics.SurfacePoints) -> Registered:
    """In place of the registration of a map."""
    return assessed(*pair.full, points.positions, FULL)


def same(best: MapCandidate, progress: Callable[[float], None] | None = None) -> MapCandidate:
    """In place of polishing a map."""
    return best


def one_way(found: Evidence) -> float:
    """The negative log-likelihood without the deformation of the simplified target."""
    once = found.simplified.neg_log_likelihood
    return once + (found.whole.neg_log_likelihood if found.closed else once)


ARGUMENTS: dict[str, Matcher] = {
    "loss Huber": partial(gmds.match, loss=gmds.Huber()),
    "loss Minimax": partial(gmds.match, loss=gmds.Minimax()),
    "scale-invariant metric alone": partial(gmds.match, distance=chosen_distance("scale-invariant", None)),
    **{
        f"{kind} alone at exponent {name}": partial(
            gmds.match, distance=partial(distance, kind=kind, exponent=exponent)
        )
        for kind in (*SPECTRAL, "geodesic")
        for name, exponent in EXPONENTS.items()
    },
}
INSIDE: dict[str, Matcher] = {
    "no reflections": changed({gmds.matching.pair: {"mirror": lambda surface, view: None}}),
    "starts from eigenfunction signs only": changed({gmds.initialization: {"ALL": gmds.initialization.ALL[:1]}}),
    "starts from extremities only": changed({gmds.initialization: {"ALL": gmds.initialization.ALL[1:]}}),
    "starts in the metric of space only": changed({gmds.surface.measured: {"EXPONENTS": ()}}),
    "weighed one way": changed(
        {
            Proposal: {"neg_log_likelihood": property(lambda found: found.residuals[0].neg_log_likelihood)},
            Evidence: {"neg_log_likelihood": property(one_way)},
        }
    ),
    "choice by stress": changed({Evidence: {"neg_log_likelihood": property(lambda found: found.stress)}}),
    "choice by the outline alone": changed(
        {Evidence: {"neg_log_likelihood": property(lambda found: found.simplified.neg_log_likelihood)}}
    ),
    "no embedding by solve": changed({gmds.matching.candidates: {"ITERATIONS": 0}}),
    "no registration": changed(
        {gmds.matching.candidates: {"registered": left_as_it_is}, gmds.matching.steps: {"polished": same}}
    ),
    "registered once": changed({gmds.matching.steps: {"polished": same}}),
    "no eigenfunctions in the registration": changed({gmds.matching.polishing: {"SPECTRAL_GAIN": 1.0}}),
    "no way back": changed({gmds.matching.polishing: {"RETURNS": 0}}),
}
VARIANTS: dict[str, Matcher] = {BASE: gmds.match, **ARGUMENTS, **INSIDE}


def variant(name: str) -> Matcher:
    """A variant by its name."""
    return VARIANTS[name]


def report(found: Mapping[str, Rows], version: str) -> str:
    """ablation.md: a line for each variant; only pairs that the matcher as it is was run on as well."""
    pairs = {name: {pair for who, pair in rows if who == BASE} for name, rows in found.items()}
    lines = []
    for who in VARIANTS:
        line = [who]
        for name, rows in found.items():
            mine = [row for (matcher, pair), row in rows.items() if matcher == who and pair in pairs[name]]
            missing = f", {len(mine)} pairs" if 0 < len(mine) < len(pairs[name]) else ""
            cell = f"{number(mine, 'direct')} ({number(mine, 'direct', max)}{missing}); {number(mine, 'cpu_seconds')} s"
            line.append(cell if mine else "-")
        if set(line[1:]) != {"-"}:
            lines.append(line)
    head = ["variant", *(f"{name} ({len(pairs[name])})" for name in found)]
    return "\n".join(["# Ablation", "", f"Measured at {version}. {ABOUT}", "", *table(head, lines)])


def main() -> None:
    """Run, and write the table."""
    parser = arguments(__doc__, EVERY, every=None)
    parser.add_argument("--variants", type=lambda text: text.split(","), default=list(VARIANTS), help="default: all")
    options = parser.parse_args()
    if options.variants == ["list"]:
        print("\n".join(VARIANTS))
        return
    unknown = [name for name in options.variants if name not in VARIANTS]
    if unknown:
        parser.error(f"{unknown[0]!r} is no variant; `--variants list` prints their names")
    version = code_version()
    for name in options.sets:
        job = Job(
            name, chosen_pairs(name, options.half, options.every or EVERY.get(name, 1)), options.variants, variant
        )
        run(job, options.output / f"ablation_{name}.csv", version, options.workers)
    found = {name: read_rows(options.output / f"ablation_{name}.csv", version) for name in DEVELOPMENT}
    text = report({name: rows for name, rows in found.items() if rows}, version)
    (options.output / "ablation.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
