"""The steps of a match that are not files of their own: what to propose from, embedding, and registering the best."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Sequence

from geodesics import Distance, Mesh
from geodesics.threads import side_by_side
from gmds import initialization
from gmds.initialization.from_landmarks import landmarks as from_landmarks
from gmds.matching.candidates import MapCandidate, make_candidate
from gmds.matching.given_distances import GivenDistances
from gmds.matching.laying import laid
from gmds.matching.pair import SurfacePair
from gmds.matching.polishing import polished
from gmds.matching.proposals import Proposal, Start, Views
from gmds.matching.result import contenders
from gmds.mds.losses import Loss
from gmds.surface.measured import EXPONENTS
from gmds.surface.view import View

# Hard landmarks, and landmarks of any kind, that need no other starts: chosen on development pairs of SHREC'20
# (benchmarks/results/notes.md, "Landmarks"). With fewer than six, a wrong one does less harm beside the other starts.
ENOUGH_HARD = 3
ENOUGH = 6

Report = Callable[[str, float], None]


def rounds_of(
    pair: SurfacePair, distance: Callable[[Mesh], Distance] | None
) -> tuple[list[Views], GivenDistances | None]:
    """Both surfaces in each metric in which maps are proposed, by rounds, and the distances that are given, if any.

    First the metric of space: where it decides, those of curvature need not be measured. Beside it that of distances
    that are given: where a pair is nearly isometric, space tells the map from its mirror image and from halves of both,
    which the curvature of few surfaces does as well.
    """
    if distance is None:
        return [functools.partial(_in_space, pair), functools.partial(_curved, pair)], None
    given, regular = GivenDistances.of(pair.source, pair.target, distance), (pair.source.regular, pair.target.regular)
    views = [given.views, *([regular] if given.differ_from(regular) else [])]
    return [lambda: views, functools.partial(_curved, pair)], given


def _in_space(pair: SurfacePair) -> list[tuple[View, View]]:
    ours, theirs = side_by_side(lambda surface: surface.regular, (pair.source, pair.target))
    return [(ours, theirs)]


def _curved(pair: SurfacePair) -> list[tuple[View, View]]:
    views = side_by_side(lambda both: both[0].curved(both[1]), itertools.product((pair.source, pair.target), EXPONENTS))
    return list(zip(views[: len(EXPONENTS)], views[len(EXPONENTS) :], strict=True))


def starts_of(pair: SurfacePair) -> list[Start]:
    """Those of `gmds.initialization`, and those from landmarks, alone where there are enough of these."""
    starts: list[Start] = list(initialization.ALL)
    if pair.landmarks is None:
        return starts
    enough = len(pair.landmarks.hard) >= ENOUGH_HARD or len(pair.landmarks) >= ENOUGH
    return [from_landmarks(*pair.landmarks.vertices), *(() if enough else starts)]


def embedded(
    pair: SurfacePair,
    proposed: Sequence[Proposal],
    loss: Loss,
    count: int,
    given: GivenDistances | None,
    report: Report,
) -> list[MapCandidate]:
    """The proposals with `count` samples placed by the solver, prolonged to all vertices."""
    report("embedding", 0.5)
    count = min(count, len(pair.source.regular.usable))
    place = functools.partial(make_candidate, pair, loss=loss, count=count, given=given)
    return side_by_side(place, proposed, lambda share: report("embedding", 0.5 + 0.2 * share))


def registered(candidates: Sequence[MapCandidate], report: Report) -> list[MapCandidate]:
    """The candidates, the most likely first, after the one or two that contend to be the answer were polished.

    The first is laid on the target anew where that keeps its shape.
    """
    report("refining", 0.7)
    rivals = contenders(candidates)
    refining = functools.partial(_refining, report)
    done = side_by_side(lambda one: polished(one, refining if one is rivals[0] else None), rivals)
    ranked = sorted(done, key=lambda candidate: candidate.neg_log_likelihood)
    return [laid(ranked[0]), *ranked[1:], *(candidate for candidate in candidates if candidate not in rivals)]


def _refining(report: Report, share: float) -> None:
    report("refining", 0.7 + 0.3 * share)
