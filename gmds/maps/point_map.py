"""What everybody who draws, judges, carries or writes a map needs of it, whoever made it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any, Protocol

from geodesics.arrays import Bools, Floats, Integers
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints


class MatchStatus(Enum):
    """The status of a map, best first; the value is a sentence for people.

    How far a map as a whole can be trusted, in one word: GOOD, INCOMPLETE, AMBIGUOUS, POOR, or UNRATED where nobody has
    judged it.

    What decides which one a match gets, with its thresholds, is in `gmds/matching/rating.py`.

    See Also
    --------
    Status : How a solver ended.

    Examples
    --------
    >>> import gmds
    >>> gmds.MatchStatus.AMBIGUOUS.value
    'Another map, for instance the mirrored one, does nearly as well; see `candidates`.'
    """

    GOOD = "Most of the map is expected to be right, and no other map does nearly as well."
    INCOMPLETE = "What was matched is matched well, but a body of one mesh has no partner in the other; see the notes."
    AMBIGUOUS = "Another map, for instance the mirrored one, does nearly as well; see `candidates`."
    UNRATED = "Nobody has rated this map."
    POOR = "Much of the map is expected to be wrong; the two surfaces may not be the same kind of thing."

    @property
    def rank(self) -> int:
        """0 for the best status, growing as trust falls."""
        return list(MatchStatus).index(self)


@dataclass(frozen=True, eq=False)
class Candidate:
    """Another map worth looking at, for instance the mirrored one.

    Attributes
    ----------
    points : SurfacePoints
        A point of the target for every source vertex.
    stress : float
        The mean difference between distances on the source and those between the same points on the target, over the
        mean distance: small is good. That is mean |d_S - d_Q| between samples over mean d_S.
    orientation : float
        From -1 to 1, the share of the area of the image that keeps the orientation of the surface, minus the share that
        reverses it: near -1 the map is a mirror image.

    See Also
    --------
    Correspondence : Has them in `candidates`, best first.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> mirrored = gmds.Candidate(truth(source, target, mirrored=True), stress=0.02, orientation=-1.0)
    >>> len(mirrored.points)
    200
    """

    points: SurfacePoints
    stress: float
    orientation: float


class PointMap(Protocol):
    """A map from every vertex of `source` (n of them) to a point of `target`.

    `Correspondence` is one; these are all the attributes that `gmds.maps`, `gmds.pictures`, `gmds.report`,
    `gmds.appearance`, `gmds.landmarks` and `gmds.evaluation` read, and `Correspondence` says what they mean.
    """

    @property
    def source(self) -> Mesh: ...
    @property
    def target(self) -> Mesh: ...
    @property
    def points(self) -> SurfacePoints: ...
    @property
    def valid(self) -> Bools: ...
    @property
    def distortion(self) -> Floats: ...
    @property
    def confidence(self) -> Floats: ...
    @property
    def status(self) -> MatchStatus: ...
    @property
    def candidates(self) -> tuple[Candidate, ...]: ...
    @property
    def meta(self) -> Mapping[str, Any]: ...
    def vertex_map(self) -> Integers: ...
