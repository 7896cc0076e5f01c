"""Named points of one surface, and which of two surfaces belong together."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.errors import FormatError
from gmds.errors import LandmarkError

Space = Literal["LPS", "RAS"]
SPACES: tuple[Space, ...] = ("LPS", "RAS")


class BadLandmarkFile(FormatError):
    """A landmark file that is not what its ending says, or with a line that is no landmark."""

    code = "E306"


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Named points of one surface, k of them.

    Parameters
    ----------
    names : tuple of str
        All different.
    at : array_like of shape (k, 3), (k,) or (k, 4)
        Positions, vertices from 0, or faces from 0 with three barycentric weights, as `match` takes them.
    named : bool
        Whether the names were given; otherwise they are 1, 2, ...
    missing : tuple of str
        Names that are listed without a place.

    Raises
    ------
    BadLandmarkFile
        When a name is there twice or the shapes do not agree (E306).

    See Also
    --------
    gmds.landmarks.files.read_landmarks : From a file.
    SoftLandmarks : Landmarks that pull rather than pin.
    """

    names: tuple[str, ...]
    at: NDArray[Any]
    named: bool = True
    missing: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        at = np.array(self.at, dtype=np.int64 if np.ndim(self.at) == 1 else np.float64)
        if at.shape not in ((len(self.names),), (len(self.names), 3), (len(self.names), 4)):
            raise BadLandmarkFile(f"{len(self.names)} names for landmarks of shape {at.shape}")
        twice = [name for name, count in Counter(self.names).items() if count > 1]
        if twice:
            raise BadLandmarkFile(f"more than one landmark is called {twice[0]!r}; give each a name of its own")
        at.setflags(write=False)
        object.__setattr__(self, "at", at)

    @classmethod
    def unnamed(cls, at: Any) -> Landmarks:
        """Landmarks known by their order only."""
        return cls(tuple(str(i + 1) for i in range(len(at))), at, named=False)

    def __len__(self) -> int:
        return len(self.names)

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


def paired(source: Landmarks, target: Landmarks) -> tuple[Landmarks, Landmarks, tuple[str, ...]]:
    """The landmarks that both surfaces have, in the same order: by name when both name theirs, else by order.

    Parameters
    ----------
    source, target : Landmarks
        Of either surface.

    Returns
    -------
    source, target : Landmarks
        Those that both have, in one order.
    alone : tuple of str
        The names of those that only one has.

    Raises
    ------
    LandmarkError
        When no name is shared, or when the order decides and the counts differ (E303).

    See Also
    --------
    check_landmarks : Takes what both give.
    """
    if not (source.named and target.named):
        if len(source) != len(target):
            raise LandmarkError(
                "E303",
                f"{len(source)} landmarks on the source but {len(target)} on the target, and no names to pair them by",
            )
        return source, target, ()
    shared = [name for name in source.names if name in set(target.names)]
    if not shared:
        raise LandmarkError(
            "E303",
            f"the landmarks share no name: {_some(source.names)} on the source, {_some(target.names)} on the target",
        )
    alone = tuple(name for name in (*source.names, *target.names) if name not in set(shared))
    return _chosen(source, shared), _chosen(target, shared), alone


def turned(positions: Floats, given: str, wanted: Space) -> Floats:
    """Positions (k, 3) of the frame `given` in the frame `wanted`: x and y change sign when they differ."""
    return positions if given == wanted else positions * np.array([-1.0, -1.0, 1.0])


def _chosen(landmarks: Landmarks, names: list[str]) -> Landmarks:
    row = {name: i for i, name in enumerate(landmarks.names)}
    return Landmarks(tuple(names), landmarks.at[[row[name] for name in names]])


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(repr(name) for name in names[:3]) + (", ..." if len(names) > 3 else "")
