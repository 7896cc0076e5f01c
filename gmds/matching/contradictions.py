r"""Landmarks that the shapes contradict: maps found with and without them are weighed by one likelihood.

.. math:: -\log L = -\log L_{shapes} + c \sum_i \min\bigl((d_i / f_i)^2,\, 1\bigr)

with the distance :math:`d_i` by which a map misses landmark i, or what is around it does where the map is torn to it,
and that from which on it counts as missed, :math:`f_i`.
What a landmark costs is bounded, by the truncated squares of robust statistics (Huber 1981; Black and Anandan 1996):
one that costs the shapes more than c is an error, not a hint. A soft one that the likeliest map misses is let go; a
hard one, which has to be met, is told of.

That is asked where the likeliest map with the landmarks is not as likely as right maps are of surfaces that keep their
sizes, or misses a landmark, or is torn to one. Else nothing is proposed again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import cached_property
from gmds.landmarks.constraints import LandmarkConstraints
from gmds.landmarks.misfits import MISFIT, carried_along, surroundings
from gmds.landmarks.placed import DOUBTFUL
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import DECISIVE, SAME_MAP, Proposal, Proposed
from gmds.registration.deformable import DeformableMesh
from gmds.registration.distinct import gap
from gmds.registration.register import Registered

# Negative log-likelihood that a landmark costs at the most: chosen on development pairs and built-in shapes
# (benchmarks/results/notes.md, "Wrong soft landmarks").
COST = 0.5
# Of log-likelihood, what annealing and putting together anew gain as a rule, at the most; set by hand. A map proposed
# without landmarks that falls short by more is not made better.
IMPROVABLE = 1.0
# Share of the distance at which a landmark counts as missed from which on it is looked into; set by hand: right ones of
# right maps are within it but for one in fifty (the notes, "Wrong landmarks").
SUSPECT = 0.5
# Negative log-likelihood below which maps are right as far as shapes can say, and the share of it that counts there:
# turned maps of one round shape, of 642 vertices, differ by 0.9 there, and above by up to 0.3. Set by hand.
CERTAIN = -13.0
SHARE = 0.1


class Believed(NamedTuple):
    """A pair with the landmarks that are believed, and all maps of it."""

    pair: SurfacePair
    maps: list[Proposal]


def believed(
    pair: SurfacePair,
    found: Proposed,
    maps: list[Proposal],
    propose: Callable[[SurfacePair, int | None], Proposed],
    improved: Callable[[SurfacePair, Proposed], list[Proposal]],
) -> Believed:
    """What is left to believe where some landmarks of a pair, if it has any, contradict its shapes.

    `found`: what was proposed with all landmarks; `maps`: with what was made of it. How that is done, `propose` in so
    many rounds and `improved`, is asked again for the pair without landmarks, where there is doubt. The result is as
    given if no likelier map comes of that; else all maps are weighed with those landmarks that the likeliest meets.
    """
    if pair.landmarks is None:
        return Believed(pair, maps)
    given, alone = Given(pair, pair.landmarks), replace(pair, landmarks=None)
    best = min(maps, key=given.cost)
    off = float((given.off(best) / given.far).max())
    if off < SUSPECT and of_the_shapes(best) < DECISIVE:
        return Believed(pair, maps)
    if off < 1 and given.agrees(best, min(propose(alone, 1).maps, key=given.cost)):
        return Believed(pair, maps)
    without = propose(alone, None)
    pool = [*maps, *improved(alone, without)]
    likeliest = min(pool, key=given.cost)
    is_new, soft = likeliest not in maps, pair.landmarks.tolerance > 0
    wrong = given.missed(likeliest) > given.far
    if not is_new and not (wrong & soft).any():
        return Believed(pair, maps)
    less = given.without(wrong, likeliest, isometric=(without if is_new else found).isometric)
    if not soft.any():  # they are met whatever speaks against them
        return Believed(less, maps)
    return Believed(less, [reweighed(one, less) for one in pool])


@dataclass(frozen=True, eq=False)
class Given:
    """The `landmarks` of a pair, k of them, as they weigh maps of it."""

    pair: SurfacePair
    landmarks: LandmarkConstraints

    def missed(self, one: Proposal) -> Floats:
        """The distances (k,) by which a map misses them, there or back, in root areas."""
        ways = zip(self.pair.simplified, (one.registered, one.back), strict=True)
        missed = [mesh.anchors.missed(way.y) for mesh, way in ways if mesh.anchors is not None]
        return np.asarray(np.max(missed, axis=0), dtype=np.float64)

    def off(self, one: Proposal) -> Floats:
        """The distances (k,) by which a map misses them, or would if they went along with what is around them."""
        return np.maximum(self.missed(one), self._torn(one.registered.y))

    @cached_property
    def _rings(self) -> list[Integers]:
        source = self.pair.simplified[0]
        starts = np.zeros(0, dtype=np.int64) if source.anchors is None else source.anchors.nearest_vertices
        return surroundings(source.mesh, starts, source.areas, 1.0)

    def _torn(self, y: Floats) -> Floats:
        """By how much they (k,) would miss if they went along with what is around them; 0 where that is too little."""
        source = self.pair.simplified[0]
        if source.anchors is None:
            return np.zeros(0)
        x = source.mesh.vertices
        sent = carried_along(self._rings, x, y, source.areas, source.anchors.positions(x))
        return np.nan_to_num(np.linalg.norm(sent - source.anchors.ends, axis=1))

    def cost(self, one: Proposal) -> float:
        """Minus the log-likelihood of a map up to a constant, with landmarks that cost `COST` at the most."""
        found = of_the_shapes(one)
        weighed = max(found, CERTAIN) + SHARE * min(found - CERTAIN, 0.0)
        return weighed + COST * float(np.minimum((self.off(one) / self.far) ** 2, 1.0).sum())

    @property
    def far(self) -> Floats:
        """By how much a landmark (k,) is missed at the least where something is wrong, in root areas."""
        return np.maximum(MISFIT, DOUBTFUL * self.landmarks.tolerance)

    def agrees(self, best: Proposal, other: Proposal) -> bool:
        """Whether a map proposed without landmarks is the best one with them, or far less likely."""
        same = gap(best.registered, other.registered, self.pair.simplified[0].areas) < SAME_MAP
        return same or self.cost(other) > self.cost(best) + IMPROVABLE

    def without(self, wrong: Bools, likeliest: Proposal, *, isometric: bool) -> SurfacePair:
        """The pair without the soft ones that are `wrong` (k,), and what is told: by how much these are missed."""
        gone = wrong & (self.landmarks.tolerance > 0)
        rows, by = self.landmarks.rows[wrong].tolist(), self.missed(likeliest)[wrong].tolist()
        return replace(
            self.pair,
            isometric=isometric,
            landmarks=None if gone.all() else self.landmarks[~gone],
            contradicted=tuple(zip(rows, by, strict=True)),
            given_up=COST * int(gone.sum()),
        )


def of_the_shapes(one: Proposal) -> float:
    """Minus the log-likelihood of a map, up to a constant, whatever its landmarks."""
    return one.neg_log_likelihood - sum(residuals.landmarks for residuals in one.residuals)


def reweighed(one: Proposal, pair: SurfacePair) -> Proposal:
    """The map as it is, weighed with the landmarks of that pair."""
    there, back = (_reweighed(*both) for both in zip(pair.simplified, (one.registered, one.back), strict=True))
    return replace(one, registered=there, back=back)


def _reweighed(mesh: DeformableMesh, way: Registered) -> Registered:
    cost = 0.0 if mesh.anchors is None else mesh.anchors.neg_log_likelihood(way.y)
    return replace(way, residuals=replace(way.residuals, landmarks=cost))
