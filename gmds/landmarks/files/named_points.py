"""Named points of one surface, and which of two surfaces belong together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Bools, Floats, Integers
from geodesics.errors import FormatError

Space = Literal["LPS", "RAS"]
Status = Literal["defined", "undefined", "missing"]
SPACES: tuple[Space, ...] = ("LPS", "RAS")


class BadLandmarkFile(FormatError):
    """A landmark file that is not what its ending says, or with a line that is no landmark."""

    code = "E306"


class PointList(NamedTuple):
    """A list of 3D Slicer: its kind ("Fiducial", "Curve", "ClosedCurve", ...), its name, how many landmarks it has."""

    kind: str
    name: str
    size: int


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Named points of one surface, k of them, in the order of their list.

    Parameters
    ----------
    names : tuple of str
        Two may be equal; they are then told apart by their order.
    at : array_like of shape (k, 3), (k,) or (k, 4)
        Positions, vertices from 0, or faces from 0 with three barycentric weights, as `match` takes them. NaN, or
        vertex -1, where a landmark has no place.
    named : bool
        Whether the names were given; otherwise they are 1, 2, ...
    status : tuple of str, optional
        For each "defined", "undefined" (not placed yet) or "missing" (known not to be there), as in 3D Slicer. Without
        it those without a place are missing.
    selected : tuple of bool, optional
        False for those that are excluded, as in 3D Slicer; they are kept and carried like all others.
    lists : tuple of PointList, optional
        Which of them, one list after the other, are single points and which the points of a curve.
    framed : bool
        Whether their file said in which frame it is, LPS or RAS, as those of 3D Slicer do.

    Raises
    ------
    BadLandmarkFile
        When the shapes do not agree (E306).

    See Also
    --------
    gmds.landmarks.files.read_landmarks : From a file.
    SoftLandmarks : Landmarks that pull rather than pin.
    """

    names: tuple[str, ...]
    at: NDArray[Any]
    named: bool = True
    status: tuple[Status, ...] = ()
    selected: tuple[bool, ...] = ()
    lists: tuple[PointList, ...] = ()
    framed: bool = False

    def __post_init__(self) -> None:
        at = np.array(self.at, dtype=np.int64 if np.ndim(self.at) == 1 else np.float64)
        if at.shape not in ((len(self.names),), (len(self.names), 3), (len(self.names), 4)):
            raise BadLandmarkFile(f"{len(self.names)} names for landmarks of shape {at.shape}")
        nowhere = at < 0 if at.ndim == 1 else ~np.isfinite(at).all(axis=1)
        status = self.status or tuple("missing" if lost else "defined" for lost in np.asarray(nowhere))
        there = np.array([word == "defined" for word in status], dtype=bool)
        if len(status) != len(at) or (there & nowhere).any():
            raise BadLandmarkFile(f"{len(status)} words of status for {len(at)} landmarks, or one without place")
        selected = self.selected or (True,) * len(at)
        if len(selected) != len(at) or (self.lists and sum(one.size for one in self.lists) != len(at)):
            raise BadLandmarkFile(f"what is said of {len(at)} landmarks is said of more or fewer of them")
        at[~there] = -1 if at.ndim == 1 else np.nan
        at.setflags(write=False)
        object.__setattr__(self, "at", at)
        object.__setattr__(self, "status", status)
        object.__setattr__(self, "selected", selected)

    @classmethod
    def unnamed(cls, at: Any) -> Landmarks:
        """Landmarks known by their order only."""
        return cls(tuple(str(i + 1) for i in range(len(at))), at, named=False)

    def __len__(self) -> int:
        return len(self.names)

    def __getitem__(self, rows: Integers | Bools) -> Landmarks:
        chosen = np.arange(len(self))[rows]
        names, status = (tuple(words[i] for i in chosen) for words in (self.names, self.status))
        selected = tuple(self.selected[i] for i in chosen)
        return Landmarks(names, self.at[chosen], self.named, status, selected, self._lists_of(chosen), self.framed)

    def _lists_of(self, chosen: Integers) -> tuple[PointList, ...]:
        """The lists of some of the landmarks; none where they are in another order."""
        if not self.lists or (np.diff(chosen) <= 0).any():
            return ()
        ends = np.cumsum([one.size for one in self.lists])
        counts = np.bincount(np.searchsorted(ends, chosen, side="right"), minlength=len(ends)).tolist()
        return tuple(one._replace(size=n) for one, n in zip(self.lists, counts, strict=True) if n)

    @property
    def defined(self) -> Bools:
        """Which have a place, (k,)."""
        return np.array([status == "defined" for status in self.status], dtype=bool)

    @property
    def missing(self) -> tuple[str, ...]:
        """The names of those that are listed without a place."""
        return tuple(name for name, there in zip(self.distinct_names, self.defined, strict=True) if not there)

    @property
    def distinct_names(self) -> tuple[str, ...]:
        """The names, all different: of equal ones the second is followed by (2), and so on."""
        return distinct(self.names)

    @property
    def positions(self) -> Floats:
        """Positions (k, 3); raises `BadLandmarkFile` when vertices were given."""
        if self.at.shape[1:] != (3,):
            raise BadLandmarkFile("this format keeps positions, and the landmarks are vertices or points of faces")
        return self.at

    @property
    def vertices(self) -> Integers:
        """Vertices (k,) from 0; raises `BadLandmarkFile` when positions were given."""
        if self.at.ndim != 1:
            raise BadLandmarkFile("this format keeps vertices, and the landmarks are no vertices")
        return self.at


Specimens = dict[str, Landmarks]  # landmarks of several surfaces in one file, by the name of the specimen


def distinct(names: Sequence[str]) -> tuple[str, ...]:
    """The names, all different: of equal ones the second is followed by (2), and so on."""
    taken, found = set(names), []
    for name, again in occurrences(names):
        told = name if again == 1 else next(x for i in count(again) if (x := f"{name} ({i})") not in taken)
        taken.add(told)
        found.append(told)
    return tuple(found)


def turned(positions: Floats, given: str, wanted: Space) -> Floats:
    """Positions (k, 3) of the frame `given` in the frame `wanted`: x and y change sign when they differ."""
    return positions if given == wanted else positions * np.array([-1.0, -1.0, 1.0])


def occurrences(names: Sequence[str]) -> list[tuple[str, int]]:
    """Each name with how often it was there so far, itself included."""
    so_far: Counter[str] = Counter()
    found = []
    for name in names:
        so_far[name] += 1
        found.append((name, so_far[name]))
    return found
