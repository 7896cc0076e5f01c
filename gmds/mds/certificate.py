"""How far a solution is from done, where its descent ended before it could say so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gmds.mds.descent import CERTIFIED, remaining
from gmds.mds.field_pairs import FieldPairs
from gmds.mds.frozen_fields import frozen
from gmds.mds.losses import Loss
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution


def certified(problem: Problem, found: Solution, loss: Loss) -> Solution:
    """The solution with a certificate where the iteration limit left none: that of the problem linearised there."""
    if np.isfinite(found.certificate) or found.stress <= 0:
        return found
    here = problem.at(found.points)
    left = remaining(frozen(here) if isinstance(here.pairs, FieldPairs) else here, loss)
    return replace(found, certificate=left / found.stress, certificate_radius=CERTIFIED)


def of_all_pairs(problem: Problem, some: Problem, found: Solution, loss: Loss) -> Solution:
    """A certified solution of some pairs of a problem as one of all of them, with a certificate of all of them.

    What the other pairs have in the linearised problem is at least nothing: where some pairs can lower the loss f to
    f* at least, and all of them have F, the loss of all with the others at nothing is a bound of what F can be lowered
    to. It is close for a maximum, and for a mean as loose as the pairs are few.
    """
    found = certified(some, found, loss)
    if len(some.first) == len(problem.first):
        return found
    residuals = problem.at(found.points).residuals
    stress, rest = loss.value(residuals), np.zeros(len(residuals) - len(found.residuals))
    least = (1 - found.certificate) * loss.value(np.concatenate([found.residuals, rest]))
    certificate = 1 - least / stress if stress > 0 else 0.0
    return replace(found, residuals=residuals, stress=stress, certificate=certificate)
