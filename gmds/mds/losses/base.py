"""What a loss is, and the step shared by all smooth ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np

from geodesics.arrays import Floats
from gmds.mds.jacobian import Jacobian


class Loss(Protocol):
    """A number for a vector of residuals, and a way down."""

    def value(self, residuals: Floats) -> float:
        """The loss of residuals (r,)."""

    def step(self, jacobian: Jacobian, residuals: Floats, radius: float) -> Floats:
        """A step (p, 2) that lowers the loss of residuals + J step, within a trust region of size `radius`."""


class SmoothLoss(ABC):
    """A mean of rho(r) over the residuals; subclasses give rho, its derivative and a positive curvature."""

    @abstractmethod
    def rho(self, residuals: Floats) -> Floats:
        """rho(r), shape (r,)."""

    @abstractmethod
    def slope(self, residuals: Floats) -> Floats:
        """rho'(r), shape (r,)."""

    @abstractmethod
    def curvature(self, residuals: Floats) -> Floats:
        """rho''(r) or a positive majorant of it, shape (r,)."""

    def value(self, residuals: Floats) -> float:
        """The mean of rho."""
        return float(self.rho(residuals).mean())

    def step(self, jacobian: Jacobian, residuals: Floats, radius: float) -> Floats:
        """Gauss-Newton step (p, 2) in the ball whose root-mean-square step a point is `radius`,
        no point going farther than twice that.

        Where the Jacobian has walls, points that push against one keep to it, and none goes through.
        Minimises slope . J y + 1/2 sum of curvature (J y)^2 by conjugate gradients stopped at the ball (Steihaug 1983).
        """
        ways = np.broadcast_to(np.eye(2), (jacobian.n_points, 2, 2))
        for _ in range(4):
            step = truncated_newton(jacobian, self.slope(residuals), self.curvature(residuals), radius, ways)
            held = _held(jacobian, step, ways)
            if held is None:
                break
            ways = held
        length = np.linalg.norm(step, axis=1, keepdims=True)
        return _inside(jacobian, step * (2 * radius / np.maximum(length, 2 * radius)))


def _held(jacobian: Jacobian, step: Floats, ways: Floats) -> Floats | None:
    """The projections (p, 2, 2) on the ways left to points that stand at a wall and push against it, None if none do.

    One wall leaves the way along it, two leave none.
    """
    if jacobian.walls is None:
        return None
    weight, slope = jacobian.walls
    pushing = (weight <= 1e-9) & (np.einsum("pkx,px->pk", slope, step) < -1e-12)
    movable = np.abs(ways).sum(axis=(1, 2)) > 0
    point, corner = np.nonzero(pushing & movable[:, None])
    if len(point) == 0:
        return None
    normal = slope[point, corner] / np.linalg.norm(slope[point, corner], axis=1, keepdims=True)
    held, whole = ways.copy(), np.eye(2)
    along = whole - normal[:, :, None] * normal[:, None, :]
    free = (held[point] == whole).all(axis=(1, 2)) & (np.bincount(point)[point] == 1)
    held[point] = np.where(free[:, None, None], along, 0.0)
    return held


def _inside(jacobian: Jacobian, step: Floats) -> Floats:
    """The step (p, 2), shortened for each point so that it ends at the first wall."""
    if jacobian.walls is None:
        return step
    weight, slope = jacobian.walls
    fall = -np.einsum("pkx,px->pk", slope, step)
    share = np.min(
        weight / np.maximum(fall, np.maximum(weight, np.finfo(float).tiny)),
        axis=1,
        keepdims=True,
        where=fall > 1e-12,
        initial=1.0,
    )
    return step * share


def truncated_newton(jacobian: Jacobian, slope: Floats, curvature: Floats, radius: float, ways: Floats) -> Floats:
    """Conjugate gradients for J^T C J y = -J^T slope, stopped where they leave the ball |y| = radius sqrt(p).

    Each point moves within the range of its projection `ways` (p, 2, 2) only. Ends at a residual of 2 % of the first.
    """
    y = np.zeros((jacobian.n_points, 2))
    rest = -_projected(ways, jacobian.transposed(slope))
    direction = rest
    square = first_square = float((rest * rest).sum())
    reach = radius * radius * jacobian.n_points
    for _ in range(60):
        if not square > 0.02**2 * first_square:
            break
        image = _projected(ways, jacobian.normal(curvature, direction))
        bend = float((direction * image).sum())
        length = square / bend if bend > 0 else np.inf
        if bend <= 0 or float(((y + length * direction) ** 2).sum()) >= reach:
            return y + _to_sphere(y, direction, reach) * direction
        y = y + length * direction
        rest = rest - length * image
        square, previous = float((rest * rest).sum()), square
        direction = rest + square / previous * direction
    return y


def _projected(ways: Floats, step: Floats) -> Floats:
    """Each projection (p, 2, 2) times the step (p, 2) of its point."""
    return np.einsum("pxy,py->px", ways, step)


def _to_sphere(y: Floats, direction: Floats, reach: float) -> float:
    """The t >= 0 with |y + t direction|^2 = reach."""
    a, b, c = float((direction**2).sum()), float((y * direction).sum()), float((y**2).sum()) - reach
    return (-b + np.sqrt(max(b * b - a * c, 0.0))) / a if a > 0 else 0.0
