"""Which of several maps to believe: what they cost, as the logarithm of a likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import SurfacePoints
from geodesics.euclidean import euclidean_distances
from gmds.matching.pair import SurfacePair
from gmds.registration.residuals import Residuals
from gmds.spectral.orientation import orientation_score
from gmds.surface.view import View

FUNCTIONS = 40
SAMPLES = 500  # between which the stress is taken
LEAST_FOLDED = 1e-3  # share of the area, twice: so much is folded over at a vertex of any triangulation


@dataclass(frozen=True)
class Evidence:
    """What speaks for a map.

    `outline`: what is left when the outline of the source is deformed as the map says, its parts keeping their sizes;
    `outline_back`: when that of the target is, the other way; `whole`: when all of the source is, and parts may grow;
    `stress`: mean |d_S - d_Q| between samples over mean d_S; `orientation`: signed share of the area that keeps it;
    `folded`: share of the area whose orientation the map does not treat as the rest is meant to be;
    `closed`: whether neither surface has a boundary; `landmark_error`: mean distance of the landmarks, if any, from
    where they belong, in root areas.
    """

    outline: Residuals
    outline_back: Residuals
    whole: Residuals
    stress: float
    orientation: float
    folded: float
    closed: bool = True
    landmark_error: float = 0.0

    @property
    def outlines(self) -> tuple[Residuals, Residuals]:
        """Both ways."""
        return self.outline, self.outline_back

    @property
    def loss(self) -> float:
        """Minus the log-likelihood up to a constant: the deformations, with what they miss, and what is folded over.

        Where there is a boundary, and parts may be missing, parts that grow could hide it: there the outlines decide.
        Elsewhere a map that swaps two legs, and not what is between them, folds that.
        """
        loss = sum(residuals.loss for residuals in self.outlines)
        if not self.closed:
            return loss
        return loss + self.whole.loss + self.fold_loss

    @property
    def fold_loss(self) -> float:
        """The part of it that is for what is folded over."""
        return float(np.log(max(2 * self.folded, LEAST_FOLDED)))


def evidence(
    pair: SurfacePair,
    views: tuple[View, View],
    points: SurfacePoints,
    outlines: tuple[Residuals, Residuals],
    whole: Residuals,
) -> Evidence:
    """What speaks for a map to `points` (n,) of the target, with distances measured in `views`; residuals are known."""
    ours, theirs = (view.distance(min(FUNCTIONS, view.functions.shape[1])).embedding for view in views)
    samples = views[0].samples(SAMPLES)
    here, there = (euclidean_distances(rows, rows) for rows in (ours[samples], points[samples].interpolate(theirs)))
    normals = points.interpolate(pair.geometries[1].normals)
    score = orientation_score(pair.source.mesh, pair.target.mesh, points.positions, normals)
    miss = 0.0 if pair.known is None else pair.known.miss(points, pair.target.mesh.vertices)
    return Evidence(
        outline=outlines[0],
        outline_back=outlines[1],
        whole=whole,
        stress=float(np.abs(here - there).mean() / here.mean()),
        orientation=-score if pair.reflected else score,
        folded=(1 - score) / 2,
        closed=not any(geometry.boundary.any() for geometry in pair.geometries),
        landmark_error=miss,
    )
