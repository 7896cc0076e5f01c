"""The most promising maps, refined for as long as the elastic energy gets less."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from geodesics import SurfacePoints
from gmds.matching.candidates import MapCandidate, registered
from gmds.matching.evidence import evidence
from gmds.registration.register import REFINE, SETTLE, Registered, both_ways, settled
from gmds.spectral.refinement import ROUNDS, upsampled

REST = tuple(range(1, len(ROUNDS)))  # rounds of alignment of a map that is good already
FINE_LADDER = (40, 50, 60, 70, 80, 90, 100)  # numbers of eigenfunctions for such a map
REPEATS = 2  # more refinements, if each pays
RETURNS = 2  # registrations there and back
GAIN = 0.005  # share of the energy by which each must lower it, where parts grew
SPECTRAL_GAIN = 0.08  # and by which eigenfunctions must: more where nothing grew, less across species


def polished(best: MapCandidate, progress: Callable[[float], None] | None = None) -> MapCandidate:
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
    trial = settled(*pair.full, now.y, SETTLE, growing=True, partial=True, views=regular)
    isometric = trial.residuals.cost < (1 - SPECTRAL_GAIN) * now.residuals.cost
    now, views = (trial, regular) if isometric else (now, None)
    for number in range(RETURNS):
        tell(0.4 + 0.6 * number / RETURNS)
        trial = both_ways(*pair.full, now, views)
        if not isometric and trial.residuals.cost >= (1 - GAIN) * now.residuals.cost:
            break
        now = trial
    weighed = evidence(pair, best.views, now.points, best.evidence.both_simplified, now.residuals)
    return replace(best, points=now.points, deformation=now, evidence=weighed)
