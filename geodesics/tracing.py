"""Straight lines and gradients on the faces of a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import intrinsic
from geodesics._kernels import tracing as kernel
from geodesics._kernels.tracing import NO_NEIGHBOUR
from geodesics.arrays import Bools, Floats
from geodesics.caching import memoized
from geodesics.delaunay import mollified
from geodesics.errors import BadShape
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from geodesics.topology.adjacency import neighbours

__all__ = ["barycentric_gradient", "gradient", "layout", "neighbours", "turned_over", "walk"]


def walk(
    points: SurfacePoints, displacement: ArrayLike, max_crossings: int = 1000, *, walled: bool = False
) -> SurfacePoints:
    """Move points straight along the surface.

    In the frame of a face corner 0 is the origin, corner 1 lies on the x axis and corner 2 above it. At an edge the
    next face is unfolded into the plane of the one before. At the boundary, and where more than two faces meet in an
    edge, the point slides along the edge with what is left of its displacement.

    Parameters
    ----------
    points : SurfacePoints
        Where to start, p points.
    displacement : array_like of shape (p, 2)
        Direction and length of each path in the frame of the face where it starts, in the unit of the mesh. A point
        whose displacement is not finite stays where it is.
    max_crossings : int
        Edges that a path may cross; after that the point stays where it is by then.
    walled : bool
        Whether to treat every edge as a boundary.

    Returns
    -------
    SurfacePoints
        The ends of the paths.

    Raises
    ------
    MeshError
        E108 when the shapes disagree.

    See Also
    --------
    gradient : The direction of steepest ascent, in the same frames.
    """
    step = np.array(displacement, dtype=np.float64, order="C")
    if step.shape != (len(points), 2):
        raise BadShape(f"displacement must have shape ({len(points)}, 2), not {step.shape}")
    mesh = points.mesh
    across = np.full((mesh.n_faces, 3), NO_NEIGHBOUR) if walled else neighbours(mesh)
    return SurfacePoints(mesh, *kernel.walk(points.face, points.barycentric, step, across, layout(mesh), max_crossings))


def turned_over(points: SurfacePoints, nearness: float = 1e-9) -> tuple[SurfacePoints, Bools]:
    """Points on an edge, expressed in the face across it.

    A point lies on an edge when a weight is at most `nearness` and there is a face across; the weight becomes 0. Points
    on a vertex go round it: on consistently oriented faces, repeated calls lead through all faces of an inner vertex.

    Parameters
    ----------
    points : SurfacePoints
        Points of a surface, p of them.
    nearness : float
        The largest weight that counts as 0.

    Returns
    -------
    points : SurfacePoints
        The same points.
    turned : bool array of shape (p,)
        Which of them changed their face.
    """
    index, across = np.arange(len(points)), neighbours(points.mesh)
    top = points.barycentric.argmax(axis=1)
    corner = (top + 1) % 3
    for other in (top + 2) % 3, (top + 1) % 3:
        possible = (points.barycentric[index, other] <= nearness) & (across[points.face, other] != NO_NEIGHBOUR)
        corner = np.where(possible, other, corner)
    code = across[points.face, corner]
    turned = (points.barycentric[index, corner] <= nearness) & (code != NO_NEIGHBOUR)
    index, corner, code = index[turned], corner[turned], code[turned]
    face, barycentric = points.face.copy(), points.barycentric.copy()
    face[index] = code // 9
    barycentric[index] = 0.0
    barycentric[index, code // 3 % 3] = points.barycentric[index, (corner + 1) % 3]
    barycentric[index, code % 3] = points.barycentric[index, (corner + 2) % 3]
    barycentric /= barycentric.sum(axis=1, keepdims=True)
    return SurfacePoints(points.mesh, face, barycentric), turned


def gradient(points: SurfacePoints, values: ArrayLike) -> Floats:
    """Gradient of a function that is linear on each face.

    Parameters
    ----------
    points : SurfacePoints
        Where to differentiate, p points.
    values : array_like of shape (n, c)
        c functions, by their values at the vertices.

    Returns
    -------
    array of shape (p, c, 2)
        Derivatives along the axes of the frames of the points' faces (see `walk`), per unit of length of the mesh.
    """
    corners = np.asarray(values, dtype=np.float64)[points.mesh.faces[points.face]]
    return np.einsum("pkc,pkx->pcx", corners, barycentric_gradient(points))


def barycentric_gradient(points: SurfacePoints) -> Floats:
    """Gradient of the three barycentric weights.

    Parameters
    ----------
    points : SurfacePoints
        Where to differentiate, p points.

    Returns
    -------
    array of shape (p, 3, 2)
        Derivatives along the axes of the frames of the points' faces (see `walk`).
    """
    c, x, y = layout(points.mesh)[points.face].T
    zero = np.zeros_like(c)
    one, two = np.stack([1 / c, -x / (c * y)], axis=1), np.stack([zero, 1 / y], axis=1)
    return np.stack([-one - two, one, two], axis=1)


@memoized
def layout(mesh: Mesh) -> Floats:
    """Each face in its own plane: corner 0 = (0, 0), corner 1 = (column 0, 0), corner 2 = (columns 1, 2).

    Degenerate faces get a little width: all edges are lengthened by one amount, just enough for every triangle
    inequality to hold by 1e-10 of the mean edge.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of m faces.

    Returns
    -------
    array of shape (m, 3)
        Coordinates, in the unit of the mesh.

    References
    ----------
    Sharp, Crane: A Laplacian for nonmanifold triangle meshes (2020), "intrinsic mollification".
    """
    length = mollified(np.sqrt(intrinsic.squared_lengths(mesh.vertices, mesh.faces)), 1e-10)
    a, b, c = length.T
    x = (b * b + c * c - a * a) / (2 * c)
    return np.stack([c, x, 2 * intrinsic.areas(length**2) / c], axis=1)
