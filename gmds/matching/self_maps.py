"""Maps of a surface to itself, other than the identity: proposed, embedded, registered, and kept apart."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from geodesics import scale_invariant
from geodesics.arrays import Floats
from geodesics.smoothing import SHARP
from geodesics.threads import side_by_side
from gmds import initialization
from gmds.matching.candidates import MapCandidate, make_candidate
from gmds.matching.pair import SurfacePair
from gmds.matching.polishing import polished
from gmds.matching.proposals import SAME_MAP, Proposal, rough_maps
from gmds.mds.losses import Loss
from gmds.registration.distinct import distinct
from gmds.registration.energies import AsSimilarAsPossible
from gmds.registration.register import Registered, register, settled
from gmds.registration.residuals import Residuals
from gmds.registration.settings import COARSE, SIMPLIFIED, TO_IMAGES
from gmds.surface.measured import Surface

# All set by hand while the ten shapes of benchmarks/accuracy/symmetry.py were looked at, plain and with one part of
# another size; its table says what they are worth together.
MOST_REGISTERED = 12  # rough maps of each kind that are registered to the end, and more where they fit exactly
MOST_EMBEDDED = 24  # self-maps of each kind, orientation-reversing or not, that are embedded
REVERSING_KEPT = 3  # of the reversing ones, however unlikely
SHORTFALL = 1.2  # log-likelihood, on the simplified meshes, that the others may be short of the best
# Negative log-likelihood on the simplified meshes below which all maps fit exactly: a more likely one excludes none.
EXACT_FIT = -16.0
# Mean distance, in root areas, below which a map is the identity with something small misplaced: a map that reverses
# orientation (the identity inside out), one that keeps it.
IDENTITY_GAP = (0.05, 0.09)
SYMMETRY_GAP = 0.08  # the same between two symmetries
MAP_GAP = 0.03  # the same between two maps that are worth refining
ENERGY_RATIO = 2.5  # of the elastic energy of a map to that of the best, at the most; below FREE_ENERGY any will do
FREE_ENERGY = 0.03
# Beyond these a self-map is no symmetry: elastic energy, correlation of mean curvature, relative change of distances,
# signed share of the area whose orientation it treats alike.
MOST_ENERGY = 0.5
LEAST_CURVATURE = 0.77
MOST_STRESS = 0.2
LEAST_ORIENTATION = 0.5
SAMPLES = 300  # placed by the solver, as in `match`


GROWING = replace(SIMPLIFIED, energy=AsSimilarAsPossible)
"""On a surface and itself parts may change size from the beginning: the only other explanation is that they stay."""


@dataclass(frozen=True, eq=False)
class SelfMap:
    """A map of a surface to itself, embedded and registered; an orientation-reversing one goes to the mirror image."""

    candidate: MapCandidate

    @property
    def positions(self) -> Floats:
        """Where the vertices go (n, 3), on the surface itself."""
        return _unmirrored(self.candidate.points.positions, self.candidate.pair)

    @property
    def neg_log_likelihood(self) -> float:
        """Minus its log-likelihood up to a constant: the deformation of the whole, and how much of it is folded over.

        Unlike in `match`, the simplified meshes, whose parts keep their sizes, are weighed only when a map is proposed,
        and nothing is missing from a surface that is its own target. A map that swaps one pair of legs and not the
        other folds the surface in between.
        """
        evidence = self.candidate.evidence
        return evidence.whole.neg_log_likelihood + evidence.fold_neg_log_likelihood

    @property
    def energy(self) -> float:
        """Elastic energy of the deformation."""
        return self.candidate.evidence.whole.energy

    @property
    def is_identity(self) -> bool:
        """Whether it is hardly more than the identity."""
        moved = self._mean_distance(self.positions, self.candidate.pair.source.mesh.vertices)
        return moved <= _identity_gap(self.candidate.pair)

    @property
    def involution_error(self) -> float:
        """Mean distance in root areas from where the map, done twice, brings points back: 0 for an involution."""
        again = self.candidate.points.interpolate(self.positions)
        return self._mean_distance(again, self.candidate.pair.source.mesh.vertices)

    @property
    def plausible(self) -> bool:
        """Whether it keeps lengths, distances and curvature, and does to orientation what it is meant to."""
        evidence, reversing = self.candidate.evidence, self.candidate.pair.reflected
        keeps = (
            evidence.stress <= MOST_STRESS
            and evidence.whole.energy <= MOST_ENERGY
            and _curvature(evidence.whole) > LEAST_CURVATURE
        )
        return keeps and (-evidence.orientation if reversing else evidence.orientation) > LEAST_ORIENTATION

    def gap(self, other: SelfMap) -> float:
        """Mean distance between the images of two self-maps, in root areas."""
        return self._mean_distance(self.positions, other.positions)

    def _mean_distance(self, x: Floats, y: Floats) -> float:
        return float(self.candidate.pair.full[0].areas @ np.linalg.norm(x - y, axis=1))


def self_maps(
    surface: Surface, mirrored: Surface, loss: Loss, progress: Callable[[str, float], None]
) -> Iterator[SelfMap]:
    """Self-maps that may be symmetries, most likely first, no two alike and none the identity.

    An orientation-reversing self-map is a map to the mirror image that preserves orientation. Proposals are those of
    `match`; the likely ones are embedded, and the best of these refined.
    """
    pairs = SurfacePair(surface, mirrored, None, True), SurfacePair(surface, surface)
    kinds: list[list[Proposal]] = []
    for number, pair in enumerate(pairs):
        progress("proposing", 0.05 + 0.25 * number)
        moving = [p for p in proposed(pair) if _moves(p.registered, pair) > _identity_gap(pair)]
        kinds.append(distinct(moving, pair.simplified[0].areas, SAME_MAP, count=MOST_EMBEDDED))
    limit = max(min((p.neg_log_likelihood for kind in kinds for p in kind), default=0.0), EXACT_FIT) + SHORTFALL
    chosen = [(pairs[0], p) for i, p in enumerate(kinds[0]) if i < REVERSING_KEPT or p.neg_log_likelihood < limit]
    chosen += [(pairs[1], p) for p in kinds[1] if p.neg_log_likelihood < limit]
    begun: list[SelfMap] = []
    for i, (pair, proposal) in enumerate(chosen):
        progress("embedding", 0.55 + 0.3 * i / len(chosen))
        begun.append(SelfMap(make_candidate(pair, proposal, loss, min(SAMPLES, len(surface.regular.usable)))))
    best = likely(begun, MAP_GAP)
    for i, one in enumerate(best):
        progress("refining", 0.85 + 0.15 * i / len(best))
        yield SelfMap(polished(one.candidate))


def proposed(pair: SurfacePair) -> list[Proposal]:
    """Proposals from the rough maps of `match` that are neither alike nor near the identity: the likeliest of them.

    One metric more than in `match`: curvature of either side of a surface comes from the same mesh, so that there is
    less to be smoothed away, and what is left follows parts of another size more closely.
    """
    source, target = pair.simplified
    sharp = functools.partial(scale_invariant, smoothing=SHARP)
    views = [
        *zip(pair.source.views, pair.target.views, strict=True),
        (pair.source.view(sharp), pair.target.view(sharp)),
    ]
    places = [target.mesh.vertices[images] for images in rough_maps(pair, views, initialization.ALL)]
    begin, settle = GROWING.with_stages(TO_IMAGES), GROWING.with_stages(COARSE)
    begun = side_by_side(lambda place: register(source, target, place, begin), places)
    kept: list[int] = []
    for i in np.argsort([one.residuals.neg_log_likelihood for one in begun], kind="stable"):
        new = all(source.areas @ np.linalg.norm(begun[i].y - begun[j].y, axis=1) > MAP_GAP for j in kept)
        wanted = len(kept) < MOST_REGISTERED or begun[i].residuals.neg_log_likelihood < EXACT_FIT / 2
        if new and wanted and _moves(begun[i], pair) > _identity_gap(pair):
            kept.append(int(i))

    def completed(number: int) -> Proposal:
        return Proposal.completed(pair, settled(source, target, begun[number].y, settle), GROWING)

    return side_by_side(completed, kept)


def likely(maps: list[SelfMap], apart: float = SYMMETRY_GAP) -> list[SelfMap]:
    """Those that need not much more energy than the most likely, most likely first, without repetitions.

    A map that swaps one pair of legs and not the other costs a tear; where it is the best there is, it comes alone.
    """
    kept: list[SelfMap] = []
    for one in sorted((m for m in maps if not m.is_identity), key=lambda m: m.neg_log_likelihood):
        allowed = not kept or one.energy <= max(ENERGY_RATIO * kept[0].energy, FREE_ENERGY)
        if allowed and all(one.gap(other) > apart for other in kept):
            kept.append(one)
    return kept


def _curvature(residuals: Residuals) -> float:
    return min(residuals.curvature, residuals.curvature_back)


def _moves(deformation: Registered, pair: SurfacePair) -> float:
    """Mean distance over which a registration moves the simplified mesh."""
    simplified = pair.simplified[0]
    gaps = np.linalg.norm(_unmirrored(deformation.y, pair) - simplified.mesh.vertices, axis=1)
    return float(simplified.areas @ gaps)


def _identity_gap(pair: SurfacePair) -> float:
    return IDENTITY_GAP[0] if pair.reflected else IDENTITY_GAP[1]


def _unmirrored(places: Floats, pair: SurfacePair) -> Floats:
    """Positions (n, 3) on the target of a pair as positions on the source, of which it is a copy or mirror image."""
    return places * (-1.0, 1.0, 1.0) if pair.reflected else places
