"""The answer: for every source vertex a point on the target surface."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import cached_property
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.errors import MapArray, MapError
from gmds.maps.confidence import confidence_at, known_confidence, not_rated
from gmds.maps.doubt import DoubtfulRegion, doubtful_regions
from gmds.maps.growth import growth_of
from gmds.maps.images import composed, inverted
from gmds.maps.npz_format import read_map, write_map
from gmds.maps.overlap import covered, overlap
from gmds.maps.point_map import Candidate, MatchStatus
from gmds.maps.rows import attributes, check_rows, frozen_rows, members
from gmds.maps.values import carry
from gmds.pictures.panels import write_picture
from gmds.report.notebook import mimebundle
from gmds.report.page import write_report


@dataclass(frozen=True, eq=False)
class Correspondence:
    """A map from every vertex of `source` (n of them) to a point of `target`.

    Attributes
    ----------
    source, target : Mesh
        The surfaces.
    points : SurfacePoints
        n points of the target.
    valid : bool array of shape (n,)
        False where the vertex has no counterpart; the point of such a row is finite and means nothing.
    distortion : float64 array of shape (n,)
        By what share lengths around a point change, from 0 for none. `gmds.maps.distortion` has the formula.
    status, candidates : MatchStatus, tuple of Candidate
        How far to trust the whole, and other maps, best first.
    meta : mapping
        Parameters, seed, notes (`gmds.matching.notes`), versions, timings, as JSON.
    confidence : float64 array of shape (n,)
        The probability, from 0 to 1, that a point is sent to within 0.05 root areas of the target of where it belongs;
        0 where it has no counterpart. NaN everywhere where nobody rated the map; `gmds.maps.confidence` has more.

    Raises
    ------
    MapError
        When a row is missing, lies on another mesh than `target`, or has no finite distortion or no probability.

    See Also
    --------
    match, geodesic_error : Make one, judge one.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> answer = gmds.Correspondence.from_points(source, truth(source, target))
    >>> heights = answer.transfer(target.vertices[:, 2])  # of the target, carried to the source
    >>> answer, heights.shape
    (Correspondence(200 -> 200 vertices, 200 valid, UNRATED), (200,))
    """

    source: Mesh
    target: Mesh
    points: SurfacePoints
    valid: Bools
    distortion: Floats
    status: MatchStatus = MatchStatus.UNRATED
    candidates: tuple[Candidate, ...] = ()
    meta: Mapping[str, Any] = field(default_factory=dict)
    confidence: Floats = field(default_factory=not_rated)

    def __post_init__(self) -> None:
        object.__setattr__(self, "confidence", known_confidence(self.confidence, self.valid))
        check_rows(self)
        for name, array in frozen_rows(self).items():
            object.__setattr__(self, name, array)
        object.__setattr__(self, "candidates", tuple(self.candidates))

    @classmethod
    def from_points(cls, source: Mesh, points: SurfacePoints, **others: Any) -> Correspondence:
        """The map that sends vertex i of `source` to `points[i]`.

        Parameters
        ----------
        source : Mesh, of n vertices
        points : SurfacePoints, n of them, on the target
        **others
            Any other attribute; unless given `distortion` is zero, and `valid` but what is on no face.
        """
        n = (source := Mesh.from_object(source)).n_vertices
        others = {"valid": np.bincount(source.faces.ravel(), minlength=n) > 0, "distortion": np.zeros(n), **others}
        return cls(source=source, target=points.mesh, points=points, **others)

    def __reduce__(self) -> tuple[Any, ...]:
        """Unpickled maps are checked and frozen again."""
        return type(self), tuple(getattr(self, column.name) for column in fields(self))

    def __repr__(self) -> str:
        counts = f"{self.source.n_vertices} -> {self.target.n_vertices} vertices, {int(self.valid.sum())} valid"
        return f"Correspondence({counts}, {self.status.name})"

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        return mimebundle(self)  # for notebooks

    @cached_property
    def covered(self) -> Bools:
        """Which target vertices (n_target,) the valid part of the source reaches."""
        return covered(self)

    @property
    def stress(self) -> float:
        """Mean |d_S - d_Q| between samples over mean d_S (sec. 5), as `match` measured it; NaN where nobody did."""
        return float(self.meta.get("evidence", {}).get("stress", np.nan))

    @property
    def overlap(self) -> tuple[float, float]:
        """The shares in [0, 1] of the area of the source that is valid, and of that of the target that is covered."""
        return overlap(self)

    def confidence_at(self, radius: float) -> Floats:
        """The probability (n,) that a point is within another `radius` of the truth, in root areas of the target."""
        return confidence_at(self.confidence, radius)

    @property
    def doubtful(self) -> list[DoubtfulRegion]:
        """Regions of the source where the map is probably wrong, the largest first (see `gmds.maps.doubt`)."""
        return doubtful_regions(self.source, self.confidence, self.valid)

    @cached_property
    def growth(self) -> Floats:
        """The log change of length around each vertex (n,), in given units; NaN where unknown (`gmds.maps.growth`)."""
        return growth_of(self).length

    def vertex_map(self) -> Integers:
        """The target vertex nearest to each point, among the corners of its face: int64 array of shape (n,)."""
        return self.points.nearest_vertices()

    def transfer(self, values: ArrayLike, *, labels: bool | None = None, fill: Any = None) -> NDArray[Any]:
        """Values per target vertex as values per source vertex, (n,) or (n, c).

        Numbers and colours are interpolated on the triangle; labels take the value with the largest weight.
        Raises `MapError` when there is not one value per target vertex.

        Parameters
        ----------
        values : array_like of shape (n_target,) or (n_target, c)
            Of any dtype.
        labels : bool, optional
            Whether they are labels, which keep their dtype. Unless given, integers, booleans and strings are, except
            uint8 with 3 or 4 columns, which are colours.
        fill : optional
            What goes into the rows that are not `valid`; without it they hold whatever their point says."""
        moved = carry(self.points, np.asarray(values), labels)
        if fill is not None:
            moved[~self.valid] = fill
        return moved

    def inverse(self) -> Correspondence:
        """The map from target to source, without candidates.

        Each target vertex takes the nearest point of the images of the source triangles (`gmds.maps.images.preimage`);
        a vertex map that is one to one is inverted exactly. A vertex is not `valid` when that is further than 0.05
        sqrt(target area), or when it is on no face. Distortion adds the distance to the image over sqrt(target area).
        """
        return Correspondence(self.target, self.source, status=self.status, meta=self.meta, **inverted(self))

    def compose(self, other: Correspondence) -> Correspondence:
        """First this map, then `other`, through which the points of this one are sent (see `gmds.maps.images.image`).

        A row is `valid` when this map is there and `other` is at every corner with weight; distortions add, confidences
        multiply. Raises `MapError` when `other` does not start on the very mesh where this map ends."""
        if self.target is not other.source:
            raise MapError("the second map must start on the very mesh (the same object) on which the first one ends")
        status = max(self.status, other.status, key=lambda status: status.rank)
        return Correspondence(self.source, other.target, status=status, **composed(self, other))

    def report(self, path: str | os.PathLike[str], errors: ArrayLike | None = None, **options: Any) -> None:
        """Write a page to look at this map in a browser; see `gmds.report.write_report`."""
        write_report(path, self, errors, **options)

    def picture(self, path: str | os.PathLike[str], errors: ArrayLike | None = None, **options: Any) -> str:
        """Draw both surfaces, corresponding points in the same colour; see `gmds.pictures.write_picture`."""
        return write_picture(path, self, errors, **options)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write map.npz (see `gmds.maps.npz_format`) atomically, with all candidates. Raises `OSError`."""
        write_map(path, *members(self), self.source, self.target)

    @classmethod
    def load(cls, path: str | os.PathLike[str], source: Mesh, target: Mesh) -> Correspondence:
        """Read a map.npz that belongs to these two meshes.

        Raises `OSError`, or `FormatError`: E210 members, E211 arrays, E212 other meshes, E213 version, E220 pickled."""
        read = read_map(path, source, target)
        try:
            return cls(source, target, **attributes(target, *read))
        except ValueError as error:
            raise MapArray(f"{path}: {error}") from error
