"""Maps under consideration: proposed by the starts, refined, weighed, and embedded by the solver."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geodesics import DiffusionDistance, Distance, SurfacePoints
from gmds.choice import Evidence, evidence
from gmds.extension import extend
from gmds.hypotheses import hypotheses
from gmds.losses import Loss
from gmds.problem import Problem, joined
from gmds.refinement import ROUNDS, Refiner, upsampled
from gmds.solver import Solution, solve
from gmds.surface import Surface, View
from gmds.symmetries import mirror
from gmds.upsampling import SampledPair

Index = NDArray[np.int64]
Start = Callable[[SampledPair], list[Index]]
Measured = tuple[Distance, Distance]
Known = tuple[Index, Index]

PROPOSED = 6  # maps that each metric proposes
GONE_ON = 6  # maps that go through all rounds of alignment
FIRST, REST = (0,), tuple(range(1, len(ROUNDS)))  # rounds of alignment before and after the worse half is dropped
SAMPLES = 500  # that carry a map through spectral upsampling
FUNCTIONS = 60  # eigenfunctions of the dense map
TIME = 3e-3  # of the diffusion distance that the solver compares, in units of the area
ITERATIONS = 20
WEIGHT = 10  # samples that a landmark is worth
APART = 0.1  # mean gap, in the same distances, below which two maps are one


@dataclass(frozen=True, eq=False)
class SurfacePair:
    """What is to be matched: two surfaces, the orientation wanted (`sense` 1 kept, -1 reversed, 0 either), landmarks.

    `known`: vertices of the source and those of the target they are known to correspond to, or None.
    """

    source: Surface
    target: Surface
    sense: int = 1
    known: Known | None = None

    def weighed(self, views: tuple[View, View], samples: Index, images: Index) -> Evidence:
        """What speaks for a map (n,) to target vertices, with how far it misses the landmarks."""
        found = evidence(self.source, self.target, views, samples, images)
        if self.known is None:
            return found
        place = self.target.mesh.vertices
        miss = np.linalg.norm(place[images[self.known[0]]] - place[self.known[1]], axis=1)
        return replace(found, landmark_error=float(miss.mean()))

    def with_landmarks(self, samples: Index, points: SurfacePoints) -> tuple[Index, SurfacePoints]:
        """Placed samples with the landmarks added, often enough that the extension heeds them."""
        if self.known is None:
            return samples, points
        ours, theirs = (np.repeat(side, WEIGHT) for side in self.known)
        return np.concatenate([samples, ours]), joined(points, SurfacePoints.at_vertices(points.mesh, theirs))


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A map under consideration: target vertices `images` (n,), and the `views` of both surfaces it is measured in."""

    images: Index
    views: tuple[View, View]
    evidence: Evidence


@dataclass(frozen=True, eq=False)
class Embedded(Hypothesis):
    """A map whose samples were placed by `solve`, with this `solution`, and extended to all vertices: `points` (n,)."""

    points: SurfacePoints
    solution: Solution


def proposals(pair: SurfacePair, starts: Sequence[Start]) -> Iterator[Hypothesis]:
    """Maps from starts in each metric of the family |K|^a g, each then aligned by its own factor.

    All go through the first round of alignment; the better ones, and the best of the other orientation, through the
    others; the best also comes refined in the metric of space.
    """
    source, target, sense = pair.source, pair.target, pair.sense
    refiner, samples = Refiner(source, target), source.regular.samples(SAMPLES)

    def aligned(images: Index, rounds: Sequence[int]) -> Hypothesis:
        images, view = refiner.aligned(images, rounds)
        views = source.regular, view
        return Hypothesis(images, views, pair.weighed(views, samples, images))

    family = zip(source.views, target.views, strict=True)
    rough = [images for views in family for images in hypotheses(SampledPair.of(*views, sense), starts, PROPOSED)]
    begun = [aligned(images, FIRST) for images in rough]
    begun += [aligned(images, FIRST) for images in partner(pair, begun)]
    best = sorted(begun, key=lambda h: h.evidence.loss(sense))[:GONE_ON]
    done = []
    for hypothesis in [*best, *(h for h in mirrored(begun, sense) if h not in best)]:
        done.append(aligned(hypothesis.images, REST))
        yield done[-1]
    views = source.regular, target.regular  # an isometry needs no factor, and one that is nearly 1 costs precision
    images = upsampled(*views, min(done, key=lambda h: h.evidence.loss(sense)).images)
    yield Hypothesis(images, views, pair.weighed(views, samples, images))


def proposals_in(pair: SurfacePair, views: tuple[View, View], starts: Sequence[Start]) -> Iterator[Hypothesis]:
    """Maps from starts in one given metric, refined in the same."""
    samples = views[0].samples(SAMPLES)

    def refined(images: Index) -> Hypothesis:
        images = upsampled(*views, images)
        return Hypothesis(images, views, pair.weighed(views, samples, images))

    rough = hypotheses(SampledPair.of(*views, pair.sense), starts, 2 * PROPOSED)
    done = [refined(images) for images in rough]
    yield from done
    yield from (refined(images) for images in partner(pair, done))


def partner(pair: SurfacePair, found: Sequence[Hypothesis]) -> list[Index]:
    """The best map of either orientation, composed with a reflection of the source: as good a map of the other one.

    Starts look for one orientation. Where they found the other one only, the partner is the map that was wanted;
    where they found the right one, it is the mirrored answer. Nothing where the source has no reflection.
    """
    if pair.sense == 0:
        return []
    best = min(found, key=lambda h: min(h.evidence.loss(pair.sense), h.evidence.loss(-pair.sense)))
    reflection = mirror(pair.source, pair.source.regular)
    return [] if reflection is None else [best.images[reflection]]


def mirrored(found: Sequence[Hypothesis], sense: int) -> list[Hypothesis]:
    """The best map of the orientation that is not wanted, if there is one."""
    others = [h for h in found if sense * h.evidence.orientation < 0]
    return [min(others, key=lambda h: h.evidence.loss(-sense))] if others else []


def distinct(found: Sequence[Hypothesis], count: int, sense: int) -> list[Hypothesis]:
    """The `count` best maps, best first, leaving out those that nearly repeat a better one."""
    kept: list[Hypothesis] = []
    for hypothesis in sorted(found, key=lambda h: h.evidence.loss(sense)):
        if len(kept) < count and all(_gap(hypothesis, other) > APART for other in kept):
            kept.append(hypothesis)
    return kept


def embed(
    pair: SurfacePair, hypothesis: Hypothesis, loss: Loss, count: int, distances: Measured | None = None
) -> Embedded:
    """The hypothesis after generalised multidimensional scaling of `count` samples, extended to every vertex.

    Distances are diffusion distances (3.1) in the views of the hypothesis, unless others are given.
    """
    ours, theirs = hypothesis.views
    k = min(FUNCTIONS, ours.functions.shape[1], theirs.functions.shape[1])
    if distances is None:
        both = (ours.first(k), theirs.first(k))  # as many in one as in the other, or equal surfaces would differ
        distances = DiffusionDistance(both[0].spectrum, TIME), DiffusionDistance(both[1].spectrum, TIME)
    here, there = distances
    samples = ours.samples(count)
    problem = Problem(here, SurfacePoints.at_vertices(pair.source.mesh, samples), there)
    start = SurfacePoints.at_vertices(pair.target.mesh, hypothesis.images[samples])
    solution = solve(problem, start, loss, max_iterations=ITERATIONS)
    points = extend(ours, theirs, *pair.with_landmarks(samples, solution.points), k)
    images = points.nearest_vertices()
    weighed = pair.weighed(hypothesis.views, samples, images)
    return Embedded(images, hypothesis.views, weighed, points, solution)


def _gap(one: Hypothesis, other: Hypothesis) -> float:
    """Mean distance between the images of two maps, over the mean distance from the centre."""
    e = one.views[1].embedding
    return float(np.linalg.norm(e[one.images] - e[other.images], axis=1).mean() / np.linalg.norm(e, axis=1).mean())
