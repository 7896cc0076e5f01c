"""Which of several maps to believe: what they cost, as the logarithm of a likelihood."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from geodesics import SurfacePoints
from geodesics.euclidean import euclidean_distances
from gmds.matching.pair import SurfacePair
from gmds.registration.residuals import Residuals
from gmds.spectral.orientation import orientation_score
from gmds.surface.view import View

FUNCTIONS = 40  # eigenfunctions of the commute-time distance that stress is measured in; set by hand
SAMPLES = 500  # between which it is taken; set by hand
LEAST_FOLDED = 1e-3  # twice a share of the area, a bound: any triangulation folds over so much at some vertex


@dataclass(frozen=True)
class Evidence:
    """What speaks for a map.

    `simplified`: what is left when the simplified source is deformed as the map says, its parts keeping their sizes;
    `simplified_back`: when the simplified target is, the other way; `whole`: when all of the source is, and parts may
    change size;
    `stress`: mean |d_S - d_Q| between samples over mean d_S; `orientation`: signed share of the area that keeps it;
    `folded`: share of the area whose orientation the map does not treat as the rest is meant to be;
    `closed`: whether neither surface has a boundary; `landmark_error`: mean distance of the landmarks, if any, from
    where they belong, in root areas.
    """

    simplified: Residuals
    simplified_back: Residuals
    whole: Residuals
    stress: float
    orientation: float
    folded: float
    closed: bool = True
    landmark_error: float = 0.0

    @property
    def both_simplified(self) -> tuple[Residuals, Residuals]:
        """Both ways."""
        return self.simplified, self.simplified_back

    @property
    def neg_log_likelihood(self) -> float:
        """Minus the log-likelihood up to a constant: the deformations, with what they miss, and what is folded over.

        Where there is a boundary, and parts may be missing, parts that grow could hide it: there the simplified meshes
        decide.
        Elsewhere a map that swaps two legs, and not what is between them, folds that.
        """
        total = sum(residuals.neg_log_likelihood for residuals in self.both_simplified)
        if not self.closed:
            return total
        return total + self.whole.neg_log_likelihood + self.fold_neg_log_likelihood

    def as_meta(self) -> dict[str, Any]:
        """What `Correspondence.meta["evidence"]` says of it, by the names of version 1 of map files."""
        return {
            "outline": asdict(self.simplified),
            "outline_back": asdict(self.simplified_back),
            "whole": asdict(self.whole),
            "stress": self.stress,
            "orientation": self.orientation,
            "folded": self.folded,
            "closed": self.closed,
            "landmark_error": self.landmark_error,
        }

    @classmethod
    def from_meta(cls, told: Mapping[str, Any]) -> Evidence:
        """What `as_meta` told."""
        simplified, back, whole = (Residuals(**told[name]) for name in ("outline", "outline_back", "whole"))
        names = ("stress", "orientation", "folded", "closed", "landmark_error")
        return cls(simplified, back, whole, **{name: told[name] for name in names})

    @property
    def fold_neg_log_likelihood(self) -> float:
        """The part of it that what is folded over accounts for."""
        return float(np.log(max(2 * self.folded, LEAST_FOLDED)))


def evidence(
    pair: SurfacePair,
    views: tuple[View, View],
    points: SurfacePoints,
    simplified: tuple[Residuals, Residuals],
    whole: Residuals,
) -> Evidence:
    """What speaks for a map to `points` (n,) of the target, with distances measured in `views`.

    `simplified` and `whole` are the residuals of the simplified source and target, and of the whole source.
    """
    ours, theirs = (view.distance(min(FUNCTIONS, view.functions.shape[1])).embedding for view in views)
    samples = views[0].samples(SAMPLES)
    here, there = (euclidean_distances(rows, rows) for rows in (ours[samples], points[samples].interpolate(theirs)))
    normals = points.interpolate(pair.full[1].normals)
    score = orientation_score(pair.source.mesh, pair.target.mesh, points.positions, normals)
    miss = 0.0 if pair.landmarks is None else pair.landmarks.miss(points, pair.target.mesh.vertices)
    return Evidence(
        simplified=simplified[0],
        simplified_back=simplified[1],
        whole=whole,
        stress=float(np.abs(here - there).mean() / here.mean()),
        orientation=-score if pair.reflected else score,
        folded=(1 - score) / 2,
        closed=pair.closed,
        landmark_error=miss,
    )
