"""The most promising maps, refined for as long as the elastic energy gets less."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from geodesics import SurfacePoints
from geodesics.threads import side_by_side
from gmds.matching.candidates import MapCandidate, registered
from gmds.matching.evidence import evidence
from gmds.matching.pair import SurfacePair
from gmds.registration.contacts import taken_back
from gmds.registration.register import Registered, both_ways, settled
from gmds.registration.settings import REFINEMENT, SPECTRAL, RegistrationSettings
from gmds.spectral.refinement import ROUNDS, upsampled

LATER_ROUNDS = tuple(range(1, len(ROUNDS)))  # of the alignment: the first is for rough maps
# Numbers of eigenfunctions for a map that is good already: 160 were no better than 100 on development pairs
# (benchmarks/results/notes.md, "Refinement, one after the other").
FINE_LADDER = (40, 50, 60, 70, 80, 90, 100)
REPEATS = 2  # more refinements, at the most: they gain little (the same table)
RETURNS = 2  # registrations there and back, at the most: a third gains at most 0.03 (as SPECTRAL_GAIN below)
ISOMETRIC_RETURNS = 1  # a second gains 0.02 of 1.5 on development pairs (the same file, "Effort")
GAIN = 0.005  # share of the energy that each must save without eigenfunctions; set by hand
# Share of the energy that eigenfunctions must save: on development pairs they save 10 to 30 % where parts keep their
# sizes, and at most 6 % where they do not, and there the error rises ("Eigenfunctions in the registration" there).
SPECTRAL_GAIN = 0.08


def polished(candidate: MapCandidate, progress: Callable[[float], None] | None = None) -> MapCandidate:
    """The map refined further, for as long as the elastic energy of the deformation gets less.

    It is refined spectrally and registered again; then eigenfunctions take part in the search for closest points, if
    that pays; then the target is registered to the source as well, and what both say is brought together; then what
    lies on a sheet that it only touches is taken back. Of two registrations that cost nearly the same both are
    refined, and the likelier is the map.
    """
    if candidate.deformation.residuals.is_congruence:
        return candidate
    starts = [one for one in (candidate.deformation, candidate.other) if one is not None]
    done = side_by_side(lambda one: _polished(candidate, one, progress if one is starts[0] else None), starts)
    return min(done, key=lambda one: one.neg_log_likelihood)


def _polished(
    candidate: MapCandidate, deformation: Registered, progress: Callable[[float], None] | None
) -> MapCandidate:
    pair, report = candidate.pair, progress or (lambda share: None)
    deformation = refined(pair, deformation)
    report(0.3)
    deformation, settings = with_eigenfunctions(pair, deformation)
    deformation = there_and_back(pair, deformation, settings, report)
    points = taken_back(*pair.full, deformation.y, deformation.points)
    weighed = evidence(pair, candidate.views, points, candidate.evidence.both_simplified, deformation.residuals)
    return replace(candidate, points=points, deformation=deformation, evidence=weighed, other=None)


def refined(pair: SurfacePair, deformation: Registered) -> Registered:
    """The map after spectral upsampling, in the metric of space or in the one in which it keeps area, and registration.

    Where no part changed size the metric of space is the better: it does not follow the errors of the map.
    """

    def in_space(points: SurfacePoints) -> Registered:
        images = upsampled(pair.source.regular, pair.target.regular, points.nearest_vertices(), FINE_LADDER)
        return registered(pair, SurfacePoints.at_vertices(pair.target.mesh, images), settings)

    def keeping_area(points: SurfacePoints) -> Registered:
        images, _ = pair.refiner.aligned(points.nearest_vertices(), LATER_ROUNDS)
        return registered(pair, SurfacePoints.at_vertices(pair.target.mesh, images), settings)

    settings = pair.settings.with_stages(REFINEMENT)
    way, trial = in_space if pair.isometric else keeping_area, in_space(deformation.points)
    if trial.residuals.cost < deformation.residuals.cost:
        way, deformation = in_space, trial
    elif pair.isometric:
        return deformation
    for _ in range(REPEATS):
        trial = way(deformation.points)
        if trial.residuals.cost >= deformation.residuals.cost:
            break
        deformation = trial
    return deformation


def with_eigenfunctions(pair: SurfacePair, deformation: Registered) -> tuple[Registered, RegistrationSettings]:
    """The map settled with eigenfunctions in the search for closest points, and so the settings, if that pays."""
    spectral = replace(pair.settings, stages=SPECTRAL, views=(pair.source.regular, pair.target.regular))
    trial = settled(*pair.full, deformation.y, spectral)
    pays = trial.residuals.cost < (1 - SPECTRAL_GAIN) * deformation.residuals.cost
    return (trial, spectral) if pays else (deformation, pair.settings)


def there_and_back(
    pair: SurfacePair, deformation: Registered, settings: RegistrationSettings, report: Callable[[float], None]
) -> Registered:
    """The map registered both ways, a few times; without eigenfunctions only for as long as it pays."""
    for number in range(ISOMETRIC_RETURNS if pair.isometric else RETURNS):
        report(0.4 + 0.6 * number / RETURNS)
        trial = both_ways(*pair.full, deformation, settings)
        if settings.views is None and trial.residuals.cost >= (1 - GAIN) * deformation.residuals.cost:
            break
        deformation = trial
    return deformation
