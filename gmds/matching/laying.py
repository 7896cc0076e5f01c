"""The answer laid on the target anew, as it lies in space, where surfaces keep their shape."""

from __future__ import annotations

from dataclasses import replace

from gmds.matching.candidates import MapCandidate
from gmds.matching.pair import SurfacePair
from gmds.registration.in_space import HARDLY_BENT, bent, in_space
from gmds.registration.register import Registered, assessed
from gmds.registration.settings import FULL

# A map is laid in space anew where it lies within so many root areas, in the root mean square, of a similarity, if
# nothing has limbs; of anything within `HARDLY_BENT`. It is taken where no more than so much of the log-likelihood of
# misfit and curvature is lost. On development pairs teeth, brains and faces lie within 0.06, skulls at 0.008, teddies
# at 0.07, people and animals in one pose at 0.026 and more; a map that lost 0.17 was far better for it
# (benchmarks/results/notes.md, "Shapes without limbs").
MOST_BENT = 0.065
MOST_LOST = 0.25


def laid(candidate: MapCandidate) -> MapCandidate:
    """The candidate, `laid` from the similarity nearest to it where nothing bends and as much is explained then.

    What speaks for it, and how far it is trusted, stays what it was: the elastic energies cannot be compared, as what
    slides in itself saves some of it.
    """
    pair, before = candidate.pair, candidate.deformation
    if pair.landmarks is not None or before.residuals.is_congruence or not keeps_its_shape(pair, before):
        return candidate
    after = assessed(*pair.full, in_space(*pair.full, before.y).y, FULL)
    lost = after.residuals.unexplained - before.residuals.unexplained
    return replace(candidate, laid=after) if lost < MOST_LOST else candidate


def keeps_its_shape(pair: SurfacePair, deformation: Registered) -> bool:
    """Whether the source was hardly bent; or not much, and neither surface has limbs to be in another pose."""
    by = bent(pair.full[0], deformation.y)
    if by <= HARDLY_BENT:
        return True
    return by < MOST_BENT and pair.limbless
