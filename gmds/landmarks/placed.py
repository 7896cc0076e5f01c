"""Landmarks once they are points of both surfaces: what matching takes, what the map keeps, what its file holds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
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
    those of one body of several are told of with the whole, where they are `rows` (k,).
    """

    on_source: SurfacePoints
    on_target: SurfacePoints
    tolerance: Floats
    notes: tuple[Note, ...] = ()
    names: tuple[str, ...] = ()
    told: bool = True
    rows: Integers | None = None

    @property
    def constraints(self) -> LandmarkConstraints:
        """As the parts of matching see them."""
        here, there = WeightedCorners.of(self.on_source), WeightedCorners.of(self.on_target)
        return LandmarkConstraints(here, there, self.tolerance, self._rows)

    @property
    def _rows(self) -> Integers:
        return np.arange(len(self.tolerance)) if self.rows is None else self.rows

    @property
    def called(self) -> tuple[str, ...]:
        """What notes call each (k,): its name, else its vertices, else its row, from 0."""
        if self.names:
            return self.names
        ours, theirs = _corners(self.on_source), _corners(self.on_target)
        return tuple(
            f"landmark {i} (counted from 0)" if here < 0 else f"vertex {here}" + f" on vertex {there}" * (there >= 0)
            for i, (here, there) in enumerate(zip(ours, theirs, strict=True))
        )

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

        Its parameters hold the landmarks. The notes name soft ones that were not followed (W302): the map misses them
        by far, or the shapes contradict them, as its evidence says. And those that it meets although what is around
        them lies elsewhere, where it is torn, or although a likelier map misses them (W307): it is then POOR.
        """
        hard = np.flatnonzero((self.tolerance <= 0) & (self.on_source.barycentric.max(axis=1) >= 1 - 1e-9))
        place = np.zeros(len(answer.points), dtype=np.int64)
        fixed = np.zeros(len(place), dtype=bool)
        rows = self.on_source[hard].nearest_vertices()
        place[rows], fixed[rows] = hard, True
        points = mixed(fixed, self.on_target[place], answer.points)
        meta = {**answer.meta, "parameters": {**answer.meta.get("parameters", {}), "landmarks": self.as_parameters()}}
        pinned = replace(answer, points=points, valid=answer.valid | fixed, meta=meta)
        if not self.told:
            return pinned, []
        followed = self._followed(answer)
        torn = self._misfits(answer, followed)
        status = max(answer.status, MatchStatus.POOR, key=lambda one: one.rank) if torn else answer.status
        return replace(pinned, status=status), [*self._doubts(answer, followed), *torn]

    def _missed(self, answer: Correspondence) -> Floats:
        """By how many root areas of the target the map misses each (k,)."""
        sent = self.on_source.interpolate(answer.points.positions)
        missed = np.linalg.norm(sent - self.on_target.positions, axis=1) / np.sqrt(answer.target.area)
        return np.asarray(missed, dtype=np.float64)

    def _contradicted(self, answer: Correspondence) -> Floats:
        """By how many root areas a far likelier map misses each (k,), as the evidence of the map says; else 0."""
        by = np.zeros(len(self.tolerance))
        for row, distance in answer.meta.get("evidence", {}).get("contradicted", ()):
            by[row] = distance
        return by

    def _followed(self, answer: Correspondence) -> Bools:
        """Whether each (k,) had a say to the end: hard ones, and soft ones that are not missed by far."""
        given_up = (self._missed(answer) > DOUBTFUL * self.tolerance) | (self._contradicted(answer) > 0)
        return (self.tolerance <= 0) | ~given_up

    def _doubts(self, answer: Correspondence, followed: Bools) -> list[Note]:
        missed, wrong = self._missed(answer), np.flatnonzero(~followed)
        if not len(wrong):
            return []
        worst, *others = wrong[np.argsort(-missed[wrong], kind="stable")].tolist()
        rest = f", then {named(others[: NAMED - 1], missed, self.called)}" if others else ""
        rest += f" and {len(others) - NAMED + 1} more" if len(others) >= NAMED else ""
        many = len(wrong) > 1
        message = (
            f"{len(wrong)} soft landmark{'s are' if many else ' is'} not followed, as the shapes contradict "
            f"{'them; the worst' if many else 'it'}, {self.called[worst]}, by {missed[worst]:.3f} square roots of the "
            f"area{rest}; {'are they' if many else 'is it'} right?"
        )
        return [Note("W302", "warning", message, tuple(wrong.tolist()), len(wrong))]

    def _misfits(self, answer: Correspondence, followed: Bools) -> list[Note]:
        """The note on those that do not go with the map around them, or with far likelier maps without them."""
        gaps = misfits(answer, self.on_source, self.on_target)
        torn = followed & (gaps > np.maximum(MISFIT, DOUBTFUL * self.tolerance))
        by = np.where(torn, gaps, self._contradicted(answer))
        wrong = np.flatnonzero(followed & (by > 0))
        if not len(wrong):
            return []
        wrong = wrong[np.argsort(-by[wrong], kind="stable")]
        rest = "" if len(wrong) <= NAMED else f", and {len(wrong) - NAMED} more"
        message = (
            "landmarks do not fit the map around them, or the shapes, which would put them elsewhere, by square roots "
            f"of the area: {named(wrong[:NAMED], by, self.called)}{rest}; the map is torn or bent to meet them; "
            "are they right?"
        )
        return [Note("W307", "warning", message, tuple(wrong.tolist()), len(wrong))]


def _corners(points: SurfacePoints) -> list[int]:
    """The vertex that each point (k,) is, from 0; -1 for one within a face."""
    exact = points.barycentric.max(axis=1) >= 1 - 1e-9
    return [int(vertex) for vertex in np.where(exact, points.nearest_vertices(), -1)]
