"""Candidate maps: prolonged from the simplified meshes, refined, placed by the solver, registered, and weighed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from geodesics import DiffusionDistance, Distance, SurfacePoints
from geodesics.arrays import Integers
from geodesics.caching import cached_property
from geodesics.threads import both
from gmds.matching.effort import keeps_sizes
from gmds.matching.evidence import Evidence, evidence
from gmds.matching.given_distances import GivenDistances, placed_in_given
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import FEWEST_DECIDED, Proposal
from gmds.mds.ladder import solve_by_ladder
from gmds.mds.losses import Loss
from gmds.mds.many_samples import pairs_asked
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution
from gmds.registration.in_space import HARDLY_BENT, bent
from gmds.registration.register import Registered, assessed, register
from gmds.registration.settings import FULL, RegistrationSettings
from gmds.spectral.extension import extend
from gmds.spectral.refinement import ROUNDS, upsampled
from gmds.surface.view import View

FUNCTIONS = 60  # eigenfunctions of the dense map; set by hand
# Of the diffusion distance that the solver compares, in units of the area: better than 1e-3 and than the biharmonic
# distance on development pairs, as good as commute time (benchmarks/results/notes.md, "Embedding").
TIME = 3e-3
# Share of its energy by which another registration may exceed the cheapest, and be polished as well: set by hand, with
# six pairs of SHREC'20 (benchmarks/results/notes.md, "Landmarks").
HARDLY_MORE = 0.07
LEAST_BENT = 0.01  # root areas: a bound, what other triangles of one surface may leave
ITERATIONS = 20  # of the solver, at the most: with as many the figures of notes.md, "Embedding", were measured


@dataclass(frozen=True, eq=False)
class MapCandidate:
    """A map to `points` (n,) of the target, whose samples `solve` placed in the `views` of both surfaces.

    `other`: the source registered from another start, at nearly the same cost, until it shows which is the better;
    `laid`: the source on the target once more, as it lies in space, if that is better; `is_plain`: nothing registered.
    """

    pair: SurfacePair
    points: SurfacePoints
    views: tuple[View, View]
    solution: Solution
    deformation: Registered
    evidence: Evidence
    other: Registered | None = None
    laid: Registered | None = None
    is_plain: bool = False

    @property
    def answer(self) -> SurfacePoints:
        """Where vertices (n,) go in the end."""
        return self.points if self.laid is None else self.laid.points

    @property
    def final(self) -> Registered:
        """The source where it lies in the end."""
        return self.deformation if self.laid is None else self.laid

    @cached_property
    def neg_log_likelihood(self) -> float:
        """Minus the log-likelihood of the map among maps of this pair, up to a constant: what it is chosen by.

        Its evidence, and how far the source is bent: distances from a similarity are Gaussian residuals too, of which
        the largest tell the most. Limbs bend, so where there are some it counts only that a map hardly bends anything.
        """
        most = np.inf if self.pair.limbless else HARDLY_BENT
        by = min(max(bent(self.pair.full[0], self.deformation.y), LEAST_BENT), most)
        return self.evidence.neg_log_likelihood + float(np.log(by)) + self.pair.given_up


def make_candidate(
    pair: SurfacePair, proposal: Proposal, loss: Loss, count: int, given: GivenDistances | None = None
) -> MapCandidate:
    """A proposal prolonged to all vertices: aligned, `count` samples placed by `solve`, extended, and registered.

    With landmarks, or `improved`, it is registered as it is, too, unembedded, and that is taken where it is `cheaper`.

    Generalised multidimensional scaling compares diffusion distances (3.1) in the metric of the target in which the
    map keeps area; or the distances given, in their metrics, and then that embedding is the answer as it stands.
    """
    images, other = prolonged(pair, proposal), None
    if given is None:
        better, views = refined_images(pair, images)
        points, solution = placed(pair, better, views, loss, count, diffusion_distances(*views))
        deformation = registered(pair, points)
        if may_lose_extremities(pair, proposal):
            deformation, other = cheaper(pair, deformation, images)
        points = deformation.points
    else:
        views = given.views
        points, solution = placed_in_given(pair, images, given, loss, count)
        deformation = assessed(*pair.full, points.positions, FULL)
    weighed = evidence(pair, views, points, proposal.residuals, deformation.residuals)
    return MapCandidate(pair, points, views, solution, deformation, weighed, other, is_plain=given is not None)


def may_lose_extremities(pair: SurfacePair, proposal: Proposal) -> bool:
    """Whether a foot or an ear that the proposal has right may be lost to eigenfunctions, and not come back.

    Registration brings it back unless landmarks hold what is around it, or it is a handful of vertices. Where parts
    grew nothing is gained without landmarks: a map that denies it takes less energy. What was annealed or recombined
    knows more than eigenfunctions do.
    """
    if pair.landmarks is not None or proposal.improved:
        return True
    fewest = min(len(surface.regular.usable) for surface in (pair.source, pair.target))
    return fewest < FEWEST_DECIDED and keeps_sizes(pair.simplified[0], proposal.registered.y)


def cheaper(pair: SurfacePair, deformation: Registered, images: Integers) -> tuple[Registered, Registered | None]:
    """That `deformation` or one from where the proposal sends vertices, `images` (n,), whichever takes less energy.

    And with landmarks the other, if it takes hardly more. Without them what saves hardly anything is not taken.
    """
    if deformation.residuals.is_congruence:
        return deformation, None
    direct = register(*pair.full, pair.target.mesh.vertices[images], pair.settings)
    if pair.landmarks is None and deformation.residuals.energy < (1 + HARDLY_MORE) * direct.residuals.energy:
        return deformation, None
    best, other = sorted((deformation, direct), key=lambda one: one.residuals.energy)
    return best, other if other.residuals.energy < (1 + HARDLY_MORE) * best.residuals.energy else None


def refined_images(pair: SurfacePair, images: Integers) -> tuple[Integers, tuple[View, View]]:
    """A map `images` (n,) refined spectrally, and both surfaces in the metrics in which that was done."""
    if pair.isometric:
        views = pair.source.regular, pair.target.regular
        return upsampled(*views, images), views
    images, view = pair.refiner.aligned(images, range(len(ROUNDS)))
    return images, (pair.source.regular, view)


def prolonged(pair: SurfacePair, proposal: Proposal) -> Integers:
    """For every source vertex the target vertex (n,) that the proposal's deformation brings it closest to."""
    (source, target), simplified = pair.full, pair.simplified[0]
    y = simplified.deformed(proposal.registered.y, source.mesh.vertices)
    return target.usable[target.tree.query(source.moved_features(y))[1]]


def diffusion_distances(source: View, target: View) -> tuple[Distance, Distance]:
    """Diffusion distances (3.1), by as many eigenfunctions in one view as in the other, or equal surfaces differ."""
    ours, theirs = (view.first(common_functions(source, target)).spectrum for view in (source, target))
    return DiffusionDistance(ours, TIME), DiffusionDistance(theirs, TIME)


def common_functions(source: View, target: View) -> int:
    """The number of eigenfunctions of the dense map that both views have."""
    return min(FUNCTIONS, source.functions.shape[1], target.functions.shape[1])


def placed(
    pair: SurfacePair,
    images: Integers,
    views: tuple[View, View],
    loss: Loss,
    count: int,
    distances: tuple[Distance, Distance],
) -> tuple[SurfacePoints, Solution]:
    """The map `images` (n,) after generalised multidimensional scaling of `count` samples, extended to every vertex."""
    source, target = views
    samples = source.samples(count)
    problem = Problem(distances[0], samples, distances[1], pairs=pairs_asked(len(samples)))
    solution = solve_by_ladder(problem, images[samples], loss, max_iterations=ITERATIONS)
    held = pair.with_landmarks(samples, solution.points)
    return extend(source, target, *held, common_functions(source, target)), solution


def registered(pair: SurfacePair, points: SurfacePoints, settings: RegistrationSettings | None = None) -> Registered:
    """The source deformed from where the map to `points` (n,) sends it; left there if that is a congruence already."""
    y, settings = points.positions, settings or pair.settings
    same = assessed(*pair.full, y, settings)
    is_congruence = same.residuals.is_congruence
    return replace(same, points=points) if is_congruence else register(*pair.full, y, settings)


def mirrored(best: MapCandidate) -> list[MapCandidate]:
    """The map composed with a reflection of one of the surfaces; none if neither has one."""
    pair, (ours, theirs) = best.pair, best.pair.reflections
    if ours is not None:
        points = best.points[ours]
    elif theirs is not None:
        points = SurfacePoints.at_vertices(pair.target.mesh, theirs[best.points.nearest_vertices()])
    else:
        return []
    deformation, simplified = both(
        lambda: assessed(*pair.full, points.positions, FULL),
        lambda: Proposal.of(pair, points.positions[pair.simplified[0].origin]).residuals,
    )
    weighed = evidence(pair, best.views, points, simplified, deformation.residuals)
    return [replace(best, points=points, deformation=deformation, evidence=weighed, other=None, laid=None)]
