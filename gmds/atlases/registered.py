"""What an atlas is: specimens on one triangulation, their mean shape, and maps between them that agree."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.barycentric import combination
from geodesics.errors import BadArgument
from geodesics.io import atomic_write
from gmds.atlases.error_bars import error_bars
from gmds.atlases.sheets import located
from gmds.batch.records import Failure
from gmds.correspondence import Correspondence
from gmds.errors import AtlasFileError
from gmds.files.npz import read_npz
from gmds.maps.growth import growth_between
from gmds.morphometrics.procrustes import Superposition, superimposed
from gmds.suggestions import did_you_mean

MIRROR = np.array([-1.0, 1.0, 1.0])
VERSION = 1  # of the file


@dataclass(frozen=True, eq=False)
class Atlas:
    """Specimens with one triangulation: vertex i is the same point of all of them.

    Attributes
    ----------
    names : tuple of str
        The k specimens, in the order of their names.
    faces : int64 array of shape (m, 3)
        The triangles that all share.
    positions : float64 array of shape (k, n, 3)
        Where each vertex is on each specimen, in its own place and units; of what is missing, where the mean has it.
    valid : bool array of shape (k, n)
        False where a specimen has no such point.
    mirrored : bool array of shape (k,)
        Specimens of the other side, which are mirrored before shapes are compared.
    spread : float64 array of shape (k, n)
        How far what all maps say of a point is from their median, over the root of the area of the specimen; NaN where
        one map alone says it. See `error_bar`.
    gap : float64 array of shape (k,)
        How far the vertices of a specimen are from its registered surface in the mean, over the root of its area.
    status : tuple of str
        Of the map from the first template to each.
    templates : tuple of str
        Those it was made with, the first first.
    changes : tuple of float
        By how much the mean shape moved in each later round, over its centroid size.
    failures : mapping
        Specimens that were left out, and why.

    See Also
    --------
    atlas : Makes one.
    ShapeModel : A model of the variation in it.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> import numpy as np
    >>> k, n = 2, animal.n_vertices
    >>> positions = np.stack([animal.vertices, 2 * animal.vertices])
    >>> spread, valid = np.full((k, n), np.nan), np.ones((k, n), bool)
    >>> names, status, templates = ("dog", "large"), ("GOOD", "GOOD"), ("dog",)
    >>> none, exact = np.zeros(k, bool), np.zeros(k)
    >>> made = gmds.Atlas(names, animal.faces, positions, valid, none, spread, exact, status, templates)
    >>> made.mean.n_vertices == n
    True
    """

    names: tuple[str, ...]
    faces: Integers
    positions: Floats
    valid: Bools
    mirrored: Bools
    spread: Floats
    gap: Floats
    status: tuple[str, ...]
    templates: tuple[str, ...]
    changes: tuple[float, ...] = ()
    failures: Mapping[str, Failure] = field(default_factory=dict)

    @property
    def registered(self) -> list[Mesh]:
        """The specimens (k) as meshes of the common triangulation."""
        return [Mesh(place, self.faces) for place in self.positions]

    @property
    def configurations(self) -> Floats:
        """Positions (k, n, 3) of which those of mirrored specimens are mirrored, so that all are of one side."""
        return np.where(self.mirrored[:, None, None], self.positions * MIRROR, self.positions)

    @property
    def superposition(self) -> Superposition:
        """The specimens but for place, rotation and size."""
        return superimposed(self.configurations, self.valid)

    @property
    def mean(self) -> Mesh:
        """The mean shape, nobody's specimen, of the mean centroid size."""
        laid = self.superposition
        return Mesh(laid.mean * laid.sizes.mean(), self.faces)

    @property
    def error_bar(self) -> Floats:
        """Over the root of its area, how far off (k, n) nine of ten points are at the most, told from their spread."""
        return error_bars(self.spread)

    @property
    def growth(self) -> Floats:
        """By how much lengths grew from the mean of all specimens to each (k, n), as a logarithm (`gmds.maps.growth`).

        Beside the whole: of each specimen its median is taken away, so that size and units have no part in it; nor has
        pose. From the first template to each, less the mean over specimens; NaN where either has no such point.
        """
        first = self.names.index(self.templates[0]) if self.templates[0] in self.names else 0
        before = Mesh(self.positions[first], self.faces)
        grown = np.stack([growth_between(before, Mesh(place, self.faces)).relative for place in self.positions])
        grown[~(self.valid & self.valid[first])] = np.nan
        known = np.isfinite(grown)
        return np.asarray(grown - np.where(known, grown, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1))

    def index(self, name: str) -> int:
        """The number of a specimen. Raises `BadArgument` (E604) for another name."""
        if name not in self.names:
            raise BadArgument(f"there is no specimen {name!r}{did_you_mean(name, self.names)}")
        return self.names.index(name)

    def map(self, source: str, target: str) -> Correspondence:
        """The map from one registered specimen to another; around any circle of specimens points come home exactly."""
        i, j = self.index(source), self.index(target)
        here, there = Mesh(self.positions[i], self.faces), Mesh(self.positions[j], self.faces)
        points = SurfacePoints.at_vertices(there, np.arange(there.n_vertices))
        return Correspondence.from_points(here, points, valid=self.valid[i] & self.valid[j])

    def carry(self, positions: ArrayLike | SurfacePoints, source: str, target: str) -> Floats:
        """Where positions (p, 3) on one specimen are on another (p, 3), through the common triangulation.

        Of points on the mesh of the specimen itself normals count as well: a hand on a thigh is not taken for it.
        """
        i, j = self.index(source), self.index(target)
        face, weights = located(positions, self.positions[i], self.faces)
        return combination(weights, self.positions[j][self.faces[face]])

    def at(self, points: SurfacePoints) -> tuple[Floats, Bools]:
        """Where points (p,) of the common triangulation are on each specimen (k, p, 3), and whether they are (k, p)."""
        corners, weights = self.faces[points.face], points.barycentric
        places = np.einsum("pc,kpcd->kpd", weights, self.positions[:, corners])
        there = (self.valid[:, corners] | (weights <= 0)).all(axis=2)
        return places, np.asarray(there, dtype=np.bool_)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a .npz that numpy alone reads, atomically."""
        names = {key: np.array(getattr(self, key), dtype=np.str_) for key in ("names", "status", "templates")}
        left_out = np.array([[name, why.code, why.reason] for name, why in self.failures.items()], dtype=np.str_)
        arrays = {key: getattr(self, key) for key in ("faces", "positions", "valid", "mirrored", "spread", "gap")}
        rest = {"changes": np.array(self.changes, dtype=np.float64), "left_out": left_out.reshape(-1, 3)}
        with atomic_write(path) as stream:
            np.savez(stream, format="gmds-atlas", version=VERSION, mean=self.mean.vertices, **arrays, **names, **rest)  # type: ignore[arg-type]

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Atlas:
        """Read what `save` wrote. Raises `AtlasFileError` (E234), `OSError`."""
        if Path(path).is_dir():
            raise AtlasFileError(f"{path} is a folder; name the atlas.npz in it that `gmds atlas` wrote")
        try:
            read = read_npz(Path(path))
            words = {key: tuple(str(one) for one in read[key]) for key in ("names", "status", "templates")}
            arrays = {key: read[key] for key in ("faces", "positions", "valid", "mirrored", "spread", "gap")}
            failures = {str(name): Failure(str(code), str(why)) for name, code, why in read["left_out"]}
            members: dict[str, Any] = {**words, **arrays}
            found = cls(**members, changes=tuple(read["changes"].tolist()), failures=failures)
            _check(found, read)
        except (ValueError, KeyError, IndexError, TypeError) as error:
            why = f"it has no array {error}" if isinstance(error, KeyError) else error
            raise AtlasFileError(f"{path} is no atlas that `gmds atlas` wrote ({why})") from error
        return found


def _check(atlas: Atlas, read: Mapping[str, Any]) -> None:
    """Raises `ValueError` where the arrays of a file are none of an atlas, or do not belong together."""
    if str(read["format"]) != "gmds-atlas" or int(read["version"]) > VERSION:
        raise ValueError(f"its format is {read['format']}, version {read['version']}")
    k, n = len(atlas.names), atlas.positions.shape[1]
    shapes = {"positions": (k, n, 3), "valid": (k, n), "spread": (k, n), "mirrored": (k,), "gap": (k,)}
    for name, shape in shapes.items():
        kinds = "b" if name in ("valid", "mirrored") else "f"
        array = getattr(atlas, name)
        if array.shape != shape or array.dtype.kind not in kinds:
            raise ValueError(f"{name} is {array.dtype} of shape {array.shape}, where {shape} is expected")
    if k < 1 or len(atlas.status) != k:
        raise ValueError(f"there are {k} names and {len(atlas.status)} statuses")
    for place in atlas.positions:
        Mesh(place, atlas.faces)
