"""Maps under consideration: lifted from the outlines, refined, embedded by the solver, registered, and weighed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geodesics import DiffusionDistance, Distance, SurfacePoints
from gmds.choice import Evidence, evidence
from gmds.extension import extend
from gmds.losses import Loss
from gmds.pair import SurfacePair
from gmds.problem import Problem
from gmds.proposals import Proposal
from gmds.refinement import ROUNDS, upsampled
from gmds.registration import COARSE, FINE, REFINE, SETTLE, Registered, both_ways, register, settled
from gmds.registration import registered as as_it_is
from gmds.solver import Solution, solve
from gmds.surface import View

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Measured = tuple[Distance, Distance]

FUNCTIONS = 60  # eigenfunctions of the dense map
TIME = 3e-3  # of the diffusion distance that the solver compares, in units of the area
ITERATIONS = 20
REST = tuple(range(1, len(ROUNDS)))  # rounds of alignment of a map that is good already
FINE_LADDER = (40, 50, 60, 70, 80, 90, 100)  # numbers of eigenfunctions for such a map
REPEATS = 2  # more refinements, if each pays
RETURNS = 2  # registrations there and back
GAIN = 0.005  # share of the energy by which each must lower it, where parts grew
SPECTRAL_GAIN = 0.08  # and by which eigenfunctions must: more where nothing grew, less across species


@dataclass(frozen=True, eq=False)
class Embedded:
    """A map to `points` (n,) of the target, whose samples `solve` placed in the `views` of both surfaces."""

    pair: SurfacePair
    points: SurfacePoints
    views: tuple[View, View]
    solution: Solution
    deformation: Registered
    evidence: Evidence


def embed(
    pair: SurfacePair,
    proposal: Proposal,
    loss: Loss,
    count: int,
    given: tuple[tuple[View, View], Measured] | None = None,
) -> Embedded:
    """A proposal carried to all vertices: aligned, `count` samples embedded by `solve`, extended, and registered.

    Generalised multidimensional scaling compares diffusion distances (3.1) in the metric of the target in which the
    map keeps area; or, in given views, the distances given, and then that embedding is the answer as it stands.
    """
    images = lifted(pair, proposal)
    if given is None:
        images, view = pair.refiner.aligned(images, range(len(ROUNDS)))
        views = pair.source.regular, view
        points, solution = placed(pair, images, views, loss, count, None)
        deformation = registered(pair, points)
        points = deformation.points
    else:
        views, distances = given
        points, solution = placed(pair, upsampled(*views, images), views, loss, count, distances)
        deformation = as_it_is(*pair.geometries, points.positions, growing=True, partial=True)
    weighed = evidence(pair, views, points, proposal.residuals, deformation.residuals)
    return Embedded(pair, points, views, solution, deformation, weighed)


def finished(best: Embedded, progress: Callable[[float], None] | None = None) -> Embedded:
    """The map refined further, for as long as the elastic energy of the deformation gets less.

    It goes through spectral upsampling in the metric of space, or in the one in which it keeps area, and is registered
    again. Where nothing grew the first is the better: it does not follow the errors of the map. Then eigenfunctions
    take part in the search for closest points, if that pays; the target is registered to the source as
    well, and what both say is brought together.
    """
    pair, now = best.pair, best.deformation
    if now.residuals.is_congruence:
        return best
    regular = pair.source.regular, pair.target.regular
    tell = progress or (lambda share: None)

    def in_space(points: SurfacePoints) -> Registered:
        images = upsampled(*regular, points.nearest_vertices(), FINE_LADDER)
        return registered(pair, SurfacePoints.at_vertices(pair.target.mesh, images), REFINE)

    def keeping_area(points: SurfacePoints) -> Registered:
        images, _ = pair.refiner.aligned(points.nearest_vertices(), REST)
        return registered(pair, SurfacePoints.at_vertices(pair.target.mesh, images), REFINE)

    way, trial = keeping_area, in_space(now.points)
    if trial.residuals.cost < now.residuals.cost:
        way, now = in_space, trial
    for _ in range(REPEATS):
        trial = way(now.points)
        if trial.residuals.cost >= now.residuals.cost:
            break
        now = trial
    tell(0.3)
    trial = settled(*pair.geometries, now.y, SETTLE, growing=True, partial=True, views=regular)
    isometric = trial.residuals.cost < (1 - SPECTRAL_GAIN) * now.residuals.cost
    now, views = (trial, regular) if isometric else (now, None)
    for number in range(RETURNS):
        tell(0.4 + 0.6 * number / RETURNS)
        trial = both_ways(*pair.geometries, now, views)
        if not isometric and trial.residuals.cost >= (1 - GAIN) * now.residuals.cost:
            break
        now = trial
    weighed = evidence(pair, best.views, now.points, best.evidence.outlines, now.residuals)
    return replace(best, points=now.points, deformation=now, evidence=weighed)


def lifted(pair: SurfacePair, proposal: Proposal) -> Index:
    """For every source vertex the target vertex (n,) that the proposal's deformation brings it closest to."""
    (source, target), outline = pair.geometries, pair.outlines[0]
    y = outline.carried(proposal.registered.y, source.mesh.vertices)
    return target.usable[target.tree.query(source.moved_features(y))[1]]


def placed(
    pair: SurfacePair, images: Index, views: tuple[View, View], loss: Loss, count: int, distances: Measured | None
) -> tuple[SurfacePoints, Solution]:
    """The map `images` (n,) after generalised multidimensional scaling of `count` samples, extended to every vertex."""
    ours, theirs = views
    k = min(FUNCTIONS, ours.functions.shape[1], theirs.functions.shape[1])
    if distances is None:
        both = (ours.first(k), theirs.first(k))  # as many in one as in the other, or equal surfaces would differ
        distances = DiffusionDistance(both[0].spectrum, TIME), DiffusionDistance(both[1].spectrum, TIME)
    samples = ours.samples(count)
    problem = Problem(distances[0], SurfacePoints.at_vertices(pair.source.mesh, samples), distances[1])
    start = SurfacePoints.at_vertices(pair.target.mesh, images[samples])
    solution = solve(problem, start, loss, max_iterations=ITERATIONS)
    return extend(ours, theirs, *pair.with_landmarks(samples, solution.points), k), solution


def registered(
    pair: SurfacePair, points: SurfacePoints, stages: Sequence[tuple[float, int]] = (COARSE[0], *COARSE, *FINE)
) -> Registered:
    """The source deformed from where the map to `points` (n,) sends it; left there if that is a congruence already."""
    source, target = pair.geometries
    y = points.positions
    same = as_it_is(source, target, y, growing=True, partial=True)
    if same.residuals.is_congruence:
        return replace(same, points=points)
    return register(source, target, y, stages, growing=True, partial=True)


def mirrored(best: Embedded) -> Embedded | None:
    """The map composed with a reflection of one of the surfaces, if there is one."""
    pair = best.pair
    ours, theirs = pair.reflections
    if ours is not None:
        points = best.points[ours]
    elif theirs is not None:
        points = SurfacePoints.at_vertices(pair.target.mesh, theirs[best.points.nearest_vertices()])
    else:
        return None
    deformation = as_it_is(*pair.geometries, points.positions, growing=True, partial=True)
    outlines = Proposal.of(pair, points.positions[pair.outlines[0].origin]).residuals
    weighed = evidence(pair, best.views, points, outlines, deformation.residuals)
    return replace(best, points=points, deformation=deformation, evidence=weighed)
