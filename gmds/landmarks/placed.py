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
from gmds.landmarks.misfits import MISFIT, misfits, named
from gmds.maps.point_map import MatchStatus

DOUBTFUL = 3  # tolerances by which a map misses a soft landmark that may be wrong: a convention
NAMED = 5  # landmarks that do not fit that are named, at the most: set by hand


@dataclass(frozen=True, eq=False)
class PlacedLandmarks:
    """Landmarks as points of both surfaces, k each, with the `tolerance` (k,) of each and `notes` on what was moved.

    `names` (k,) are those of the source, none where nobody named them. `told`: whether the map says which do not fit;
    those of one body of several are told of with the whole.
    """

    on_source: SurfacePoints
    on_target: SurfacePoints
    tolerance: Floats
    notes: tuple[Note, ...] = ()
    names: tuple[str, ...] = ()
    told: bool = True

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

        Its parameters hold the landmarks. The notes name soft ones that the map misses by far (W302), and those that it
        meets although what is around them lies elsewhere (W307): there it is torn, and then POOR.
        """
        hard = np.flatnonzero((self.tolerance <= 0) & (self.on_source.barycentric.max(axis=1) >= 1 - 1e-9))
        place = np.zeros(len(answer.points), dtype=np.int64)
        fixed = np.zeros(len(place), dtype=bool)
        rows = self.on_source[hard].nearest_vertices()
        place[rows], fixed[rows] = hard, True
        points = mixed(fixed, self.on_target[place], answer.points)
        meta = {**answer.meta, "parameters": {**answer.meta.get("parameters", {}), "landmarks": self.as_parameters()}}
        torn = self._misfits(answer) if self.told else []
        status = max(answer.status, MatchStatus.POOR, key=lambda one: one.rank) if torn else answer.status
        pinned = replace(answer, points=points, valid=answer.valid | fixed, meta=meta, status=status)
        return pinned, [*self._doubts(answer), *torn] if self.told else []

    def _missed(self, answer: Correspondence) -> Floats:
        """By how many root areas of the target the map misses each (k,)."""
        sent = self.on_source.interpolate(answer.points.positions)
        missed = np.linalg.norm(sent - self.on_target.positions, axis=1) / np.sqrt(answer.target.area)
        return np.asarray(missed, dtype=np.float64)

    def _doubts(self, answer: Correspondence) -> list[Note]:
        missed = self._missed(answer)
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

    def _misfits(self, answer: Correspondence) -> list[Note]:
        gaps = misfits(answer, self.on_source, self.on_target)
        given_up = (self.tolerance > 0) & (self._missed(answer) > DOUBTFUL * self.tolerance)
        wrong = np.flatnonzero((gaps > np.maximum(MISFIT, DOUBTFUL * self.tolerance)) & ~given_up)
        if not len(wrong):
            return []
        wrong = wrong[np.argsort(-gaps[wrong], kind="stable")]
        rest = "" if len(wrong) <= NAMED else f", and {len(wrong) - NAMED} more"
        message = (
            "landmarks do not fit the map around them, which would put them elsewhere, by square roots of the area: "
            f"{named(wrong[:NAMED], gaps, self.names)}{rest}; the map is torn or bent to meet them; are they right?"
        )
        return [Note("W307", "warning", message, tuple(wrong.tolist()), len(wrong))]
