"""The derivative of the residuals with respect to where the points are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geodesics.arrays import Floats, Integers
from gmds._kernels import jacobian as kernel


@dataclass(frozen=True, eq=False)
class Jacobian:
    """Derivative of the residuals of pairs (first, second), each (r,), by a step (p, 2) of the points.

    `blocks` (r, 2, 2): row r depends on the two coordinates of point first[r] through blocks[r, 0], and of second[r]
    through blocks[r, 1]. Steps are measured in distances, not lengths: `frames` (p, 2, 2) turns the step of a point
    into its displacement in the frame of its face, so that a step of 1 changes its distances by about 1. `walls`, if
    there are any, are the barycentric weights (p, 3) and their derivative by the step (p, 3, 2): they must stay >= 0.
    """

    first: Integers
    second: Integers
    blocks: Floats
    frames: Floats
    walls: tuple[Floats, Floats] | None = None

    @property
    def n_points(self) -> int:
        """Number of points p."""
        return len(self.frames)

    def apply(self, step: Floats) -> Floats:
        """Change of the residuals (r,) to first order under a step (p, 2)."""
        return kernel.multiply(self.first, self.second, self.blocks, step)

    def transposed(self, rows: Floats) -> Floats:
        """The transpose applied to one number a residual (r,), shape (p, 2)."""
        return kernel.multiply_transposed(self.first, self.second, self.blocks, rows, self.n_points)

    def normal(self, weights: Floats, step: Floats) -> Floats:
        """J^T diag(weights) J step, shape (p, 2); weights (r,)."""
        return kernel.weighted_normal(self.first, self.second, self.blocks, weights, step)

    def rows(self, index: Integers) -> sp.csr_matrix:
        """The chosen rows as a sparse matrix (len(index), 2 p); columns 2 i and 2 i + 1 belong to point i."""
        ends = np.stack([self.first[index], self.second[index]], axis=1)
        columns = (2 * ends[:, :, None] + np.arange(2)).reshape(len(index), 4)
        values = self.blocks[index].reshape(len(index), 4)
        pointer = np.arange(0, 4 * len(index) + 1, 4)
        return sp.csr_matrix((values.ravel(), columns.ravel(), pointer), shape=(len(index), 2 * self.n_points))

    def displacement(self, step: Floats) -> Floats:
        """The step (p, 2) as displacements in the frames of the faces, in units of the mesh."""
        return np.einsum("pxy,py->px", self.frames, step)


def scaled(first: Integers, second: Integers, raw: Floats, n_points: int, total_weight: Floats) -> Jacobian:
    """The Jacobian from derivatives `raw` (r, 2, 2) by in-face displacement.

    The frame of a point is M^(-1/2), M being twice the mean of its blocks' outer products: M is the identity where
    the distances are geodesic, leave the point in all directions and are measured in lengths. Nearly flat directions
    are floored at 1/30 of the steepest direction of the point and of the typical point.
    """
    xx, xy, yy = (2 * kernel.second_moments(first, second, raw, n_points) / total_weight[:, None]).T
    slope, axes = np.linalg.eigh(np.stack([np.stack([xx, xy], 1), np.stack([xy, yy], 1)], 1))
    steepest = np.maximum(slope[:, 1], np.median(slope[:, 1]))
    slope = np.maximum(slope, steepest[:, None] / 900)
    with np.errstate(divide="ignore"):
        inverse_root = np.where(slope > 0, 1 / np.sqrt(slope), 0.0)
    frames = np.einsum("pxk,pk,pyk->pxy", axes, inverse_root, axes)
    return Jacobian(first, second, kernel.change_frames(first, second, raw, frames), frames)
