"""What a scanner sees of a surface from one side."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from geodesics import Mesh
from geodesics.arrays import Bools, Floats
from geodesics.errors import BadArgument
from gmds.deformations.directions import camera_axes, unit
from gmds.deformations.kept_faces import largest_piece, part
from gmds.deformations.truths import Part

ROUNDING = 1e-9  # sine of an angle, and share of the extent: what is nearer to edge-on, or to touching, is rounding


def scan(mesh: Mesh, direction: ArrayLike | None = None, *, rng: int = 0) -> Part:
    """Keep what is seen from far away in one direction, and of that the largest component.

    A face is seen when its outside faces the viewer and no other face lies between its middle and the viewer, along
    parallel rays. Remaining vertices keep their order and place.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices, with its faces counter-clockwise from outside.
    direction : array_like of shape (3,), optional
        From the surface towards the viewer, in the coordinates of the mesh and of any length; random without one.
    rng : int
        Seed of the random direction.

    Returns
    -------
    Part
        ``mesh, truth``, as of every deformation, and `missing`.

    Raises
    ------
    ValueError
        For no direction, and when nothing is seen.

    See Also
    --------
    cut : Parts cut off by a plane or by balls.
    """
    mesh = Mesh.from_object(mesh)
    towards = unit(np.random.default_rng(rng).standard_normal(3) if direction is None else direction)
    corners = (mesh.vertices @ camera_axes(towards).T)[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    seen = normals[:, 2] > ROUNDING * np.linalg.norm(normals, axis=1)
    seen[seen] = ~_hidden(corners[seen].mean(axis=1), corners)
    faces = largest_piece(mesh, mesh.faces[seen])
    if len(faces) == 0:
        raise BadArgument("nothing of the surface is seen from there; are its faces turned inside out?")
    return part(mesh, faces)


def _hidden(points: Floats, corners: Floats) -> Bools:
    """Which of p points (p, 3) have one of m triangles (m, 3, 3) between them and the viewer, on the third axis."""
    middle = corners[:, :, :2].mean(axis=1)
    radius = np.linalg.norm(corners[:, :, :2] - middle[:, None], axis=2).max(axis=1)
    near = cKDTree(points[:, :2]).query_ball_point(middle, radius)
    triangle = np.repeat(np.arange(len(corners)), [len(some) for some in near])
    point = np.array([one for some in near for one in some], dtype=np.int64)
    a, b, c = (corners[triangle, k] for k in range(3))
    ab, ac, ap = (side[:, :2] - a[:, :2] for side in (b, c, points[point]))
    determinant = _cross(ab, ac)
    with np.errstate(divide="ignore", invalid="ignore"):  # edge-on triangles hide nothing
        v, w = _cross(ap, ac) / determinant, _cross(ab, ap) / determinant
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        above = a[:, 2] + v * (b - a)[:, 2] + w * (c - a)[:, 2] - points[point, 2]
    hidden = np.zeros(len(points), dtype=bool)
    hidden[point[inside & (above > ROUNDING * np.ptp(corners[:, :, 2]))]] = True
    return hidden


def _cross(a: Floats, b: Floats) -> Floats:
    """The third component of cross products in the plane."""
    product: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product
