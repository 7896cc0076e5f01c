"""Candidate maps: prolonged from the simplified meshes, refined, placed by the solver, registered, and weighed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from geodesics import DiffusionDistance, Distance, SurfacePoints
from geodesics.arrays import Integers
from gmds.matching.evidence import Evidence, evidence
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.mds.losses import Loss
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution, solve
from gmds.registration.register import COARSE, FINE, Registered, register
from gmds.registration.register import registered as as_it_is
from gmds.spectral.extension import extend
from gmds.spectral.refinement import ROUNDS, upsampled
from gmds.surface.view import View

Measured = tuple[Distance, Distance]

FUNCTIONS = 60  # eigenfunctions of the dense map
TIME = 3e-3  # of the diffusion distance that the solver compares, in units of the area
ITERATIONS = 20


@dataclass(frozen=True, eq=False)
class MapCandidate:
    """A map to `points` (n,) of the target, whose samples `solve` placed in the `views` of both surfaces."""

    pair: SurfacePair
    points: SurfacePoints
    views: tuple[View, View]
    solution: Solution
    deformation: Registered
    evidence: Evidence


def make_candidate(
    pair: SurfacePair,
    proposal: Proposal,
    loss: Loss,
    count: int,
    given: tuple[tuple[View, View], Measured] | None = None,
) -> MapCandidate:
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
        deformation = as_it_is(*pair.full, points.positions, growing=True, partial=True)
    weighed = evidence(pair, views, points, proposal.residuals, deformation.residuals)
    return MapCandidate(pair, points, views, solution, deformation, weighed)


def lifted(pair: SurfacePair, proposal: Proposal) -> Integers:
    """For every source vertex the target vertex (n,) that the proposal's deformation brings it closest to."""
    (source, target), simplified = pair.full, pair.simplified[0]
    y = simplified.deformed(proposal.registered.y, source.mesh.vertices)
    return target.usable[target.tree.query(source.moved_features(y))[1]]


def placed(
    pair: SurfacePair, images: Integers, views: tuple[View, View], loss: Loss, count: int, distances: Measured | None
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
    source, target = pair.full
    y = points.positions
    same = as_it_is(source, target, y, growing=True, partial=True)
    if same.residuals.is_congruence:
        return replace(same, points=points)
    return register(source, target, y, stages, growing=True, partial=True)


def mirrored(best: MapCandidate) -> MapCandidate | None:
    """The map composed with a reflection of one of the surfaces, if there is one."""
    pair = best.pair
    ours, theirs = pair.reflections
    if ours is not None:
        points = best.points[ours]
    elif theirs is not None:
        points = SurfacePoints.at_vertices(pair.target.mesh, theirs[best.points.nearest_vertices()])
    else:
        return None
    deformation = as_it_is(*pair.full, points.positions, growing=True, partial=True)
    simplified = Proposal.of(pair, points.positions[pair.simplified[0].origin]).residuals
    weighed = evidence(pair, best.views, points, simplified, deformation.residuals)
    return replace(best, points=points, deformation=deformation, evidence=weighed)
