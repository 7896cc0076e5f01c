"""Which of several maps to believe: four ways to be wrong, taken together as one likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geodesics.euclidean import euclidean_distances
from gmds.orientation import vertex_map_orientation
from gmds.surface import Surface, View

Array = NDArray[np.float64]
Index = NDArray[np.int64]

FUNCTIONS = 40
CLEAR = 0.5  # orientation score beyond which only the noise of the map speaks
HIT = 0.02  # square roots of the area within which a landmark counts as hit
LEAST = 1e-6  # residuals below this are rounding


@dataclass(frozen=True)
class Evidence:
    """What speaks for a map.

    `stress`: mean |d_S - d_Q| between samples over mean d_S; `curvature`: correlation of squashed mean curvature,
    which tells the chest from the back; `orientation`: signed share of the area that keeps its orientation;
    `dirichlet_energy`: of the map, over that of the identity, which tells torn maps from whole ones; `landmark_error`:
    mean distance of the landmarks, if any, from where they belong, in square roots of the area.
    """

    stress: float
    curvature: float
    orientation: float
    dirichlet_energy: float
    landmark_error: float = 0.0

    def loss(self, sense: int) -> float:
        """Minus the log-likelihood up to a constant, with the spread of each residual at its best value.

        A Gaussian residual of spread s contributes log s: the relative misfit of distances, the unexplained part of
        the curvature sqrt(1 - r^2), counted twice as it tells apart what distances can not, the share of the area
        turned over (half of it at least), and the stretch sqrt(energy). `sense` is 1 when orientation is to be kept,
        -1 when it is to be reversed, 0 when either will do.
        """
        orientation = abs(self.orientation) if sense == 0 else sense * self.orientation
        unexplained = 1 - np.clip(self.curvature, 0.0, 1.0) ** 2
        spreads = (self.stress, unexplained, 1 - min(orientation, CLEAR), np.sqrt(self.dirichlet_energy))
        return float(sum(np.log(max(spread, LEAST)) for spread in spreads) + np.log(1 + self.landmark_error / HIT))


def evidence(source: Surface, target: Surface, views: tuple[View, View], samples: Index, images: Index) -> Evidence:
    """What speaks for a map (n,) to target vertices, with distances measured in `views` between the `samples`."""
    ours, theirs = (view.distance(min(FUNCTIONS, view.functions.shape[1])).embedding for view in views)
    here, there = (euclidean_distances(rows, rows) for rows in (ours[samples], theirs[images[samples]]))
    used = source.regular.usable
    curvatures = source.squashed_curvature[used], target.squashed_curvature[images[used]]
    return Evidence(
        stress=float(np.abs(here - there).mean() / here.mean()),
        curvature=_correlation(*curvatures, source.areas[used]),
        orientation=vertex_map_orientation(source.mesh, target.mesh, images),
        dirichlet_energy=_edge_energy(source, theirs[images]) / _edge_energy(source, ours),
    )


def _edge_energy(source: Surface, rows: Array) -> float:
    a, b = source.mesh.faces, np.roll(source.mesh.faces, -1, axis=1)
    difference = rows[a.ravel()] - rows[b.ravel()]
    return float(np.einsum("ek,ek->", difference, difference))


def _correlation(x: Array, y: Array, weights: Array) -> float:
    """Weighted correlation; 0 where one of them is constant, 1 where both are."""
    w = weights / weights.sum()
    x, y = x - w @ x, y - w @ y
    square, other = w @ x**2, w @ y**2
    return float(w @ (x * y) / np.sqrt(square * other)) if square * other > 0 else float(square == other)
