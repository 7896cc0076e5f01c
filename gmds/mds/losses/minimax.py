"""The maximum, by linear programs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.optimize import linprog

from geodesics.arrays import Floats, Integers
from gmds.mds.jacobian import Jacobian

IDLE_COST = 1e-3
"""What moving every point by the whole radius costs, in radii, so that points that cannot lower the maximum stay.
Set by hand: it bounds what is given away of the maximum."""


@dataclass(frozen=True)
class Minimax:
    r""":math:`\max |r|`: the distortion of sec. 5, :math:`\min_\rho \max_{s, s'} |d_S(s, s') - d_Q(\rho s, \rho s')|`.

    Each step is a linear program (HiGHS) over the residuals that are largest.

    References
    ----------
    Sec. 5 of Aflalo, Kimmel, Raviv: Scale invariant geometry for nonrigid shapes (2013).

    See Also
    --------
    LeastSquares, Huber, Power : Other losses.

    Examples
    --------
    >>> import gmds
    >>> import numpy as np
    >>> round(gmds.Minimax().value(np.array([0.1, -0.2, 0.3])), 4)
    0.3
    """

    def value(self, residuals: Floats) -> float:
        """The largest |r|."""
        return float(np.abs(residuals).max())

    def step(self, jacobian: Jacobian, residuals: Floats, radius: float) -> Floats:
        """The step (p, 2), each coordinate within `radius`, that lowers max |r + J y| most; NaN if no program solves.

        A linear program over an active set of the largest residuals, which grows until no other residual exceeds the
        maximum found. Where the Jacobian has walls, the points also stay inside them.
        """
        highest = self.value(residuals)
        size = 4 * jacobian.n_points
        active = _largest(np.abs(residuals), size)
        step = np.zeros((jacobian.n_points, 2))
        for _ in range(40):
            step, maximum = _program(jacobian, residuals, radius, active, highest)
            excess = np.abs(residuals + jacobian.apply(step)) - maximum
            excess[active] = 0
            over = np.flatnonzero(excess > 1e-5 * radius)
            if len(over) == 0:
                break
            active = np.union1d(active, over[_largest(excess[over], size)])
        return step


def _largest(values: Floats, count: int) -> Integers:
    """The places of the `count` largest values, ascending."""
    if count >= len(values):
        return np.arange(len(values))
    return np.sort(np.argpartition(-values, count)[:count])


def _program(
    jacobian: Jacobian, residuals: Floats, radius: float, active: Integers, highest: float
) -> tuple[Floats, float]:
    """The best step (p, 2) for the active residuals alone, and their maximum after it.

    Unknowns, all in radii: the change of the maximum, then the step as its positive and its negative part.
    """
    rows, r = jacobian.rows(active), residuals[active]
    both = sp.vstack([rows, -rows])
    bound = np.concatenate([highest - r, highest + r]) / radius
    side, room = _walls(jacobian, radius)
    matrix = sp.vstack([_program_rows(both, -1.0), _program_rows(side, 0.0)]).tocsc()
    n = 2 * jacobian.n_points
    cost = np.concatenate([[1.0], np.full(2 * n, IDLE_COST / n)])
    limits = np.concatenate([[[-np.inf, 0.0]], np.tile([0.0, 1.0], (2 * n, 1))])
    for method in ("highs-ds", "highs-ipm"):
        answer = linprog(cost, matrix, np.concatenate([bound, room]), bounds=limits, method=method)
        if answer.status == 0:
            step = (answer.x[1 : n + 1] - answer.x[n + 1 :]).reshape(-1, 2)
            return radius * step, highest + radius * float(answer.x[0])
    return np.full((jacobian.n_points, 2), np.nan), np.nan


def _program_rows(rows: sp.csr_matrix, maximum: float) -> sp.csr_matrix:
    """Rows for the unknowns (change of the maximum, positive part, negative part)."""
    column = sp.csr_matrix(np.full((rows.shape[0], 1), maximum))
    return sp.hstack([column, rows, -rows]).tocsr()


def _walls(jacobian: Jacobian, radius: float) -> tuple[sp.csr_matrix, Floats]:
    """Rows and bounds that keep the barycentric weights from falling below zero, for the walls within reach."""
    n = 2 * jacobian.n_points
    if jacobian.walls is None:
        return sp.csr_matrix((0, n)), np.zeros(0)
    weight, slope = jacobian.walls
    steepness = np.abs(slope).sum(axis=2)
    point, corner = np.nonzero((weight < radius * steepness) & (steepness > 0))
    scale = steepness[point, corner]
    columns = (2 * point[:, None] + np.arange(2)).ravel()
    values = (-slope[point, corner] / scale[:, None]).ravel()
    side = sp.csr_matrix((values, columns, np.arange(0, len(columns) + 1, 2)), shape=(len(point), n))
    return side, weight[point, corner] / (radius * scale)
