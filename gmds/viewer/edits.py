"""What hands have placed: landmarks on both surfaces, in the places of the drawing, and vertices marked as wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Integers
from gmds.landmarks.files import Landmarks
from gmds.report.drawing import Drawing
from gmds.viewer.asked import Refused

MOST = 2_000  # landmarks of a page; set by hand
LONGEST = 200  # characters of a name; set by hand
Place = tuple[float, float, float]


@dataclass(frozen=True)
class Placed:
    """A landmark: its name, and where it is drawn on source and target; None where it has no place yet."""

    name: str
    at: tuple[Place | None, Place | None]


@dataclass(frozen=True)
class Edits:
    """All that was placed: landmarks, and the numbers of source vertices that are marked as wrong."""

    landmarks: tuple[Placed, ...] = ()
    wrong: tuple[int, ...] = ()

    @classmethod
    def of(cls, given: Mapping[str, Any], n_vertices: int) -> Edits:
        """From what the page sends; `Refused` (400) for anything else."""
        marks, wrong = given.get("landmarks"), given.get("wrong")
        if not isinstance(marks, list) or len(marks) > MOST or not isinstance(wrong, list):
            raise Refused(400, f"landmarks must be a list of at most {MOST}, wrong a list")
        if not all(type(i) is int and 0 <= i < n_vertices for i in wrong):
            raise Refused(400, f"wrong must hold vertices from 0 to {n_vertices - 1}")
        return cls(tuple(map(_placed, marks)), tuple(sorted(set(wrong))))

    def as_data(self) -> dict[str, Any]:
        """As the page reads it."""
        return {"landmarks": [{"name": one.name, "at": one.at} for one in self.landmarks], "wrong": list(self.wrong)}

    @property
    def complete(self) -> tuple[Placed, ...]:
        """The landmarks that have a place on both surfaces."""
        return tuple(one for one in self.landmarks if None not in one.at)

    def on(self, side: int, mesh: Mesh, drawn: Drawing) -> SurfacePoints | None:
        """The complete landmarks as points of a surface."""
        if not self.complete:
            return None
        return SurfacePoints.closest(mesh, drawn.given(np.array([one.at[side] for one in self.complete])))

    def named(self, side: int, mesh: Mesh, drawn: Drawing) -> Landmarks:
        """All landmarks of a surface, for a file; those without a place there are undefined."""
        there = [one.at[side] is not None for one in self.landmarks]
        at = np.full((len(there), 3), np.nan)
        if any(there):
            at[there] = SurfacePoints.closest(
                mesh, drawn.given(np.array([one.at[side] for one in self.landmarks if one.at[side] is not None]))
            ).positions
        status: Any = tuple("defined" if one else "undefined" for one in there)
        return Landmarks(tuple(one.name for one in self.landmarks), at, True, status)

    def wrong_vertices(self, mesh: Mesh, drawn: Drawing) -> Bools:
        """The vertices (n,) marked as wrong: of a surface that is drawn as a copy, those nearest to a marked one."""
        marked = np.zeros(mesh.n_vertices, dtype=bool)
        marked[list(self.wrong)] = True
        if len(drawn.origin) == mesh.n_vertices:
            return marked
        nearest: Integers = cKDTree(mesh.vertices[drawn.origin]).query(mesh.vertices)[1]
        return marked[drawn.origin][nearest]


def _placed(given: Any) -> Placed:
    name, at = (given.get("name"), given.get("at")) if isinstance(given, dict) else (None, None)
    if not isinstance(name, str) or not 0 < len(name.strip()) <= LONGEST or not name.isprintable():
        raise Refused(400, f"a landmark has a name of 1 to {LONGEST} printable characters")
    if not isinstance(at, list) or len(at) != 2:
        raise Refused(400, f"landmark {name!r} must have two places, of which one may be null")
    return Placed(name.strip(), (_place(at[0], name), _place(at[1], name)))


def _place(given: Any, name: str) -> Place | None:
    if given is None:
        return None
    numbers = isinstance(given, Sequence) and len(given) == 3 and all(type(c) in (int, float) for c in given)
    if not numbers or not all(abs(c) <= 1 for c in given):  # the drawing is a ball of diameter one
        raise Refused(400, f"landmark {name!r} must have three coordinates within the drawing")
    return float(given[0]), float(given[1]), float(given[2])
