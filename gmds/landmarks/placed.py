"""Landmarks once they are points of both surfaces: what matching takes, what the map keeps, what its file holds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats
from geodesics.errors import Note
from geodesics.points import mixed
from gmds.correspondence import Correspondence
from gmds.landmarks.constraints import LandmarkConstraints, WeightedCorners

DOUBTFUL = 3  # tolerances by which a map misses a soft landmark that may be wrong: a convention


@dataclass(frozen=True, eq=False)
class PlacedLandmarks:
    """Landmarks as points of both surfaces, k each, with the `tolerance` (k,) of each and `notes` on what was moved.

    `names` (k,) are those of the source, none where nobody named them.
    """

    on_source: SurfacePoints
    on_target: SurfacePoints
    tolerance: Floats
    notes: tuple[Note, ...] = ()
    names: tuple[str, ...] = ()

    @property
    def constraints(self) -> LandmarkConstraints:
        """As the parts of matching see them."""
        here, there = WeightedCorners.of(self.on_source), WeightedCorners.of(self.on_target)
        return LandmarkConstraints(here, there, self.tolerance)

    def as_parameters(self) -> dict[str, Any]:
        """All of it, as JSON can carry it."""
        sides = {"source": self.on_source, "target": self.on_target}
        points = {
            name: {"face": side.face.tolist(), "barycentric": side.barycentric.tolist()} for name, side in sides.items()
        }
        named = {"names": list(self.names)} if self.names else {}
        return {**points, "tolerance": self.tolerance.tolist(), **named}

    def applied(self, answer: Correspondence) -> tuple[Correspondence, list[Note]]:
        """The map with vertices that are hard landmarks sent exactly where they belong; what is inside a face stays.

        Its parameters hold the landmarks. The notes name soft ones that the map misses by far (W302).
        """
        hard = np.flatnonzero((self.tolerance <= 0) & (self.on_source.barycentric.max(axis=1) >= 1 - 1e-9))
        place = np.zeros(len(answer.points), dtype=np.int64)
        fixed = np.zeros(len(place), dtype=bool)
        rows = self.on_source[hard].nearest_vertices()
        place[rows], fixed[rows] = hard, True
        points = mixed(fixed, self.on_target[place], answer.points)
        meta = {**answer.meta, "parameters": {**answer.meta.get("parameters", {}), "landmarks": self.as_parameters()}}
        return replace(answer, points=points, valid=answer.valid | fixed, meta=meta), self._doubts(answer)

    def _doubts(self, answer: Correspondence) -> list[Note]:
        sent = self.on_source.interpolate(answer.points.positions)
        missed = np.linalg.norm(sent - self.on_target.positions, axis=1) / np.sqrt(answer.target.area)
        wrong = np.flatnonzero((self.tolerance > 0) & (missed > DOUBTFUL * self.tolerance))
        if not len(wrong):
            return []
        worst = int(wrong[missed[wrong].argmax()])
        called = self.names[worst] if self.names else f"number {worst}"
        message = (
            f"{len(wrong)} soft landmarks are missed by more than {DOUBTFUL} tolerances; the worst, {called}, by "
            f"{missed[worst]:.3f} square roots of the area; are they right?"
        )
        return [Note("W302", "warning", message, tuple(wrong.tolist()))]
