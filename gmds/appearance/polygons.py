"""Polygons of the file a mesh was read from, so that they can be written as they were."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geodesics.arrays import Bools, Floats, Integers
from geodesics.io.reading import contents_of
from geodesics.mesh import Mesh
from gmds.appearance.seams import SAME


@dataclass(frozen=True, eq=False)
class Polygons:
    """Faces of any number of corners: how many each has (p,), their vertices (c,), texture coordinates (c, 2) or none.

    `slots` (m, 3): which corner each corner of the triangles is, that the mesh has in their place.
    """

    sizes: Integers
    corners: Integers
    slots: Integers
    uv: Floats | None = None


def polygons_of(path: Path, mesh: Mesh) -> Polygons | None:
    """The polygons of a file that was read as `mesh`; None where all are triangles, or the file is of another mesh."""
    contents = contents_of(path)
    if contents.polygons is None or contents.slots is None or not np.array_equal(contents.triangles, mesh.faces):
        return None
    sizes, corners = contents.polygons
    kept = np.repeat(sizes > 2, sizes)  # edges and points among them are no faces of the mesh
    slots = (np.cumsum(kept) - 1)[contents.slots]
    return Polygons(sizes[sizes > 2], corners[kept], slots) if (sizes > 3).any() else None


def as_triangles(mesh: Mesh, uv: Floats | None = None) -> Polygons:
    """The triangles (m, 3) of a mesh, with texture coordinates (m, 3, 2) of their corners."""
    slots = np.arange(3 * mesh.n_faces).reshape(-1, 3)
    return Polygons(np.full(mesh.n_faces, 3), mesh.faces.ravel(), slots, None if uv is None else uv.reshape(-1, 2))


def with_coordinates(polygons: Polygons, uv: Floats) -> Polygons:
    """The polygons with the coordinates (m, 3, 2) of their triangles; those whose triangles disagree are split."""
    at = np.zeros((len(polygons.corners), 2))
    at[polygons.slots] = uv
    torn = (np.abs(at[polygons.slots] - uv) > SAME).any(axis=(1, 2))
    owner = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)[polygons.slots[:, 0]]
    split = np.zeros(len(polygons.sizes), dtype=bool)
    split[owner[torn]] = True
    return _rebuilt(polygons, uv, at, owner, split)


def _rebuilt(polygons: Polygons, uv: Floats, at: Floats, owner: Integers, split: Bools) -> Polygons:
    """Polygons in order, those to `split` as their triangles."""
    ends = np.cumsum(polygons.sizes)
    whole = np.repeat(~split, polygons.sizes)
    triangle = split[owner]
    # Places in the new list: corners of a polygon by where it ended, of its triangles likewise; a stable sort merges.
    key = np.concatenate([np.repeat(ends, polygons.sizes)[whole], np.repeat(ends[owner[triangle]], 3)])
    order = np.argsort(key, kind="stable")
    corners = np.concatenate([polygons.corners[whole], polygons.corners[polygons.slots[triangle]].ravel()])[order]
    places = np.concatenate([at[whole], uv[triangle].reshape(-1, 2)])[order]
    sizes = np.concatenate([polygons.sizes[~split], np.full(int(triangle.sum()), 3)])
    sizes = sizes[np.argsort(np.concatenate([ends[~split], ends[owner[triangle]]]), kind="stable")]
    return Polygons(sizes, corners, polygons.slots, places)
