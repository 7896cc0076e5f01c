"""What a loss is, and the step shared by all smooth ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gmds.jacobian import Jacobian

Array = NDArray[np.float64]


class Loss(Protocol):
    """A number for a vector of residuals, and a way down."""

    def value(self, residuals: Array) -> float:
        """The loss of residuals (r,)."""

    def step(self, jacobian: Jacobian, residuals: Array, radius: float) -> Array:
        """A step (p, 2) that lowers the loss of residuals + J step, within a trust region of size `radius`."""


class SmoothLoss(ABC):
    """A mean of rho(r) over the residuals; subclasses give rho, its derivative and a positive curvature."""

    @abstractmethod
    def rho(self, residuals: Array) -> Array:
        """rho(r), shape (r,)."""

    @abstractmethod
    def slope(self, residuals: Array) -> Array:
        """rho'(r), shape (r,)."""

    @abstractmethod
    def curvature(self, residuals: Array) -> Array:
        """rho''(r) or a positive majorant of it, shape (r,)."""

    def value(self, residuals: Array) -> float:
        """The mean of rho."""
        return float(self.rho(residuals).mean())

    def step(self, jacobian: Jacobian, residuals: Array, radius: float) -> Array:
        """Gauss-Newton step (p, 2) in the ball whose root-mean-square step a point is `radius`,
        no point going farther than twice that.

        Minimises slope . J y + 1/2 sum of curvature (J y)^2 by conjugate gradients stopped at the ball (Steihaug 1983).
        """
        step = truncated_newton(jacobian, self.slope(residuals), self.curvature(residuals), radius)
        length = np.linalg.norm(step, axis=1, keepdims=True)
        return step * (2 * radius / np.maximum(length, 2 * radius))


def truncated_newton(
    jacobian: Jacobian, slope: Array, curvature: Array, radius: float, accuracy: float = 0.02, max_iterations: int = 60
) -> Array:
    """Conjugate gradients for J^T C J y = -J^T slope, stopped where they leave the ball |y| = radius sqrt(p)."""
    y = np.zeros((jacobian.n_points, 2))
    rest = -jacobian.transposed(slope)
    direction = rest
    square = first_square = float((rest * rest).sum())
    reach = radius * radius * jacobian.n_points
    for _ in range(max_iterations):
        if not square > accuracy**2 * first_square:
            break
        image = jacobian.normal(curvature, direction)
        bend = float((direction * image).sum())
        length = square / bend if bend > 0 else np.inf
        if bend <= 0 or float(((y + length * direction) ** 2).sum()) >= reach:
            return y + _to_sphere(y, direction, reach) * direction
        y = y + length * direction
        rest = rest - length * image
        square, previous = float((rest * rest).sum()), square
        direction = rest + square / previous * direction
    return y


def _to_sphere(y: Array, direction: Array, reach: float) -> float:
    """The t >= 0 with |y + t direction|^2 = reach."""
    a, b, c = float((direction**2).sum()), float((y * direction).sum()), float((y**2).sum()) - reach
    return (-b + np.sqrt(max(b * b - a * c, 0.0))) / a if a > 0 else 0.0
