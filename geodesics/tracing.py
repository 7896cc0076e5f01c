"""Walking straight across faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import intrinsic
from geodesics._kernels import tracing as kernel
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.delaunay import mollified
from geodesics.errors import BadShape
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from geodesics.topology.edges import edge_keys, twice_given


def walk(
    points: SurfacePoints, displacement: ArrayLike, max_crossings: int = 1000, *, walled: bool = False
) -> SurfacePoints:
    """Each point moved straight by its displacement (p, 2), given in the frame of its face, in units of the mesh.

    Frame of a face: corner 0 is the origin, corner 1 lies on the x axis and corner 2 above it. At an edge the next
    face is unfolded into the plane of the one before. At the boundary, and where more than two faces meet in an
    edge, the point slides along the edge with what is left of its displacement. After `max_crossings` edges, or when
    the displacement is not finite, the point stays where it is by then. `walled` makes every edge a boundary.

    Raises `MeshError` when the shapes disagree.
    """
    step = np.array(displacement, dtype=np.float64, order="C")
    if step.shape != (len(points), 2):
        raise BadShape(f"displacement must have shape ({len(points)}, 2), not {step.shape}")
    mesh = points.mesh
    across = np.full((mesh.n_faces, 3), kernel.NO_NEIGHBOUR) if walled else neighbours(mesh)
    return SurfacePoints(mesh, *kernel.walk(points.face, points.barycentric, step, across, layout(mesh), max_crossings))


def turned_over(points: SurfacePoints, nearness: float = 1e-9) -> tuple[SurfacePoints, Bools]:
    """The same points, those on an edge now as points of the face across it, and which they are, (p,).

    On an edge are points with a weight up to `nearness` and a face across; the weight becomes 0. Points on a vertex
    go round it: on consistently oriented faces, repeated calls lead through all faces of an inner vertex.
    """
    index, across = np.arange(len(points)), neighbours(points.mesh)
    top = points.barycentric.argmax(axis=1)
    corner = (top + 1) % 3
    for other in (top + 2) % 3, (top + 1) % 3:
        possible = (points.barycentric[index, other] <= nearness) & (across[points.face, other] != kernel.NO_NEIGHBOUR)
        corner = np.where(possible, other, corner)
    code = across[points.face, corner]
    turned = (points.barycentric[index, corner] <= nearness) & (code != kernel.NO_NEIGHBOUR)
    index, corner, code = index[turned], corner[turned], code[turned]
    face, barycentric = points.face.copy(), points.barycentric.copy()
    face[index] = code // 9
    barycentric[index] = 0.0
    barycentric[index, code // 3 % 3] = points.barycentric[index, (corner + 1) % 3]
    barycentric[index, code % 3] = points.barycentric[index, (corner + 2) % 3]
    barycentric /= barycentric.sum(axis=1, keepdims=True)
    return SurfacePoints(points.mesh, face, barycentric), turned


def gradient(points: SurfacePoints, values: ArrayLike) -> Floats:
    """Derivative of per-vertex values (n, c), linear on each face, along the axes of the points' frames: (p, c, 2)."""
    corners = np.asarray(values, dtype=np.float64)[points.mesh.faces[points.face]]
    return np.einsum("pkc,pkx->pcx", corners, barycentric_gradient(points))


def barycentric_gradient(points: SurfacePoints) -> Floats:
    """Derivative of the three barycentric weights along the axes of each point's frame, shape (p, 3, 2)."""
    c, x, y = layout(points.mesh)[points.face].T
    zero = np.zeros_like(c)
    one, two = np.stack([1 / c, -x / (c * y)], axis=1), np.stack([zero, 1 / y], axis=1)
    return np.stack([-one - two, one, two], axis=1)


@memoized
def layout(mesh: Mesh) -> Floats:
    """Each face in its own plane, (m, 3): corner 0 = (0, 0), corner 1 = (column 0, 0), corner 2 = (columns 1, 2).

    Degenerate faces get a little width: all edges are lengthened by one amount, just enough for every triangle
    inequality to hold by 1e-10 of the mean edge (Sharp and Crane 2020, "intrinsic mollification").
    """
    length = mollified(np.sqrt(intrinsic.squared_lengths(mesh.vertices, mesh.faces)), 1e-10)
    a, b, c = length.T
    x = (b * b + c * c - a * a) / (2 * c)
    return np.stack([c, x, 2 * intrinsic.areas(length**2) / c], axis=1)


@memoized
def neighbours(mesh: Mesh) -> Integers:
    """What lies across each edge of each face, (m, 3), as `geodesics._kernels.tracing.walk` reads it; -1 for nothing.

    Edges of more than two faces have nothing across. A repeated face leads where its first copy leads, and a face
    with a repeated vertex is not led to.
    """
    corners = np.sort(mesh.faces, axis=1)
    proper = np.flatnonzero((np.diff(corners, axis=1) > 0).all(axis=1))
    first, copy_of = np.unique(corners[proper], axis=0, return_index=True, return_inverse=True)[1:]
    table = np.full((mesh.n_faces, 3), kernel.NO_NEIGHBOUR, dtype=np.int64)
    kept = proper[np.sort(first)]
    _join(mesh.faces, kept, table)
    original = proper[first][copy_of.reshape(-1)]
    for copy in np.flatnonzero(proper != original):
        table[proper[copy]] = _turned(mesh.faces, proper[copy], original[copy], table)
    table.setflags(write=False)
    return table


def _join(faces: Integers, kept: Integers, table: Integers) -> None:
    """Fill the table for edges that exactly two of the kept faces share."""
    slot = np.array([[1, 2], [2, 0], [0, 1]])
    ends = faces[kept][:, slot].reshape(-1, 2)
    first, second = twice_given(edge_keys(ends[:, 0], ends[:, 1], int(faces.max()) + 1))
    for one, other in ((first, second), (second, first)):
        same_way = ends[one, 0] == ends[other, 0]
        a, b = slot[other % 3].T
        code = np.where(same_way, 3 * a + b, 3 * b + a)
        table[kept[one // 3], one % 3] = 9 * kept[other // 3] + code


def _turned(faces: Integers, face: int, original: int, table: Integers) -> list[int]:
    """The original's row of the table, for a copy whose corners may come in another order."""
    row = []
    for k in range(3):
        k_original = int(np.flatnonzero(faces[original] == faces[face, k])[0])
        code = int(table[original, k_original])
        swapped = faces[original, (k_original + 1) % 3] != faces[face, (k + 1) % 3]
        if code != kernel.NO_NEIGHBOUR and swapped:
            code = code // 9 * 9 + code % 3 * 3 + code // 3 % 3
        row.append(code)
    return row
