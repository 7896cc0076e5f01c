"""What the exponent a of |K|^a g does to tips, limbs and trunks.

    GMDS_DATA=... python -m benchmarks.accuracy.metric_shares

Five extremities of a body are farthest points by geodesics of space, from that of most eccentricity; r is the least of
their distances to the middle, the point nearest to the farthest of all. Tips are what is within 0.2 r of an extremity,
limbs what is within 0.7 r and no tip, the trunk is the rest: regions that are fixed in space. Told are their shares of
the area in |K|^a g (eps 1, curvature smoothed 0.02 as `match` has it), and how far extremities are from the middle,
over the mean distance from it. Writes metric_shares.md to benchmarks/results/.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import geodesics
from benchmarks.accuracy.halves import set_folder
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from gmds.surface.measured import SMOOTHING

BODIES = ("tosca_5k/cat0.off", "tosca_5k/michael0.off", "tosca_5k/horse0.off", "faust_5k/tr_reg_000.off")
EXTREMITIES, EXPONENTS = 5, (0.0, 0.5, 1.0)
TIP, LIMB = 0.2, 0.7  # of r; set by hand: about a hand, and an arm
AMONG = 200  # farthest points that the middle and the first extremity are looked for among


def shares(path: Path) -> list[list[str]]:
    """A line for each exponent: shares of tips, limbs and trunk, and distances of extremities."""
    mesh = geodesics.read_mesh(path)
    space = geodesics.GeodesicDistance(mesh)
    some = geodesics.farthest_point_sampling(space, AMONG)
    farthest = geodesics.distance_matrix(space, some).max(axis=1)
    middle, first = int(some[farthest.argmin()]), int(some[farthest.argmax()])
    ends = geodesics.farthest_point_sampling(space, EXTREMITIES, first=first)
    reach, near = space.field(middle)[0][ends].min(), space.field(ends).min(axis=0)
    tip, limb = near < TIP * reach, (near >= TIP * reach) & (near < LIMB * reach)
    lines = []
    for a in EXPONENTS:
        metric = geodesics.scale_invariant(mesh, exponent=a, smoothing=SMOOTHING)
        away, mass = geodesics.GeodesicDistance(metric).field(middle)[0], metric.mass / metric.mass.sum()
        parts = [f"{100 * mass[part].sum():.0f} %" for part in (tip, limb, ~tip & ~limb)]
        lines.append([path.stem, f"{a:g}", *parts, " ".join(f"{one:.1f}" for one in sorted(away[ends] / away.mean()))])
    return lines


def main() -> None:
    """Measure, and write the page."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    lines = []
    for body in BODIES:
        folder, name = body.split("/")
        lines += shares(next(set_folder(folder).rglob(name)))
    head = ["body", "a", "tips", "limbs", "trunk", "extremities from the middle"]
    text = [
        "# What |K|^a g does to tips, limbs and trunks",
        "",
        "`python -m benchmarks.accuracy.metric_shares`: see there for what they are. Shares of the area, and distances",
        "of the five extremities from the middle over the mean distance from it. At a = 1 the trunk shrinks most,",
        "limbs less or not at all; their tips, being curved, take the area, and most go farther from the middle.",
        "",
        *table(head, lines),
    ]
    (RESULTS / "metric_shares.md").write_text("\n".join(text), encoding="utf-8")


if __name__ == "__main__":
    main()
