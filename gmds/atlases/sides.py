"""Specimens of the other side, and how far a mean shape moved: shapes laid on each other by their points."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Bools, Floats
from gmds.atlases.registered import MIRROR
from gmds.morphometrics.procrustes import fitted

# By how much a mirror image must lie nearer to the template, as residuals of superposition, to be taken for one. Set by
# hand: of the built-in animals a mirrored one is nearer by 2 and more, others are farther.
NEARER = 0.9


def is_mirror(template: Floats, places: Floats, valid: Bools) -> bool:
    """Whether points lie nearer to those of the template once they are mirrored."""
    plain, turned = (_misfit(one, template, valid) for one in (places, places * MIRROR))
    return bool(turned < NEARER * plain)


def _misfit(points: Floats, onto: Floats, used: Bools) -> float:
    return float(np.linalg.norm((fitted(points, onto, used)(points) - onto)[used]))


def moved(before: Floats, after: Floats) -> float:
    """How far a mean shape moved, over its centroid size."""
    move = fitted(after, before, np.ones(len(before), dtype=bool))
    return float(np.linalg.norm(move(after) - before) / np.linalg.norm(before - before.mean(axis=0)))
