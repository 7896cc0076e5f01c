"""Which face lies across each edge of each face, and how the corners of the two correspond."""

from __future__ import annotations

import numpy as np

from geodesics._kernels.tracing import NO_NEIGHBOUR
from geodesics.arrays import Integers
from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.edges import edge_keys, twice_given


@memoized
def neighbours(mesh: Mesh) -> Integers:
    """What lies across each edge of each face.

    Edges of more than two faces have nothing across. A repeated face leads where its first copy leads, and no face
    leads to one that names a vertex twice.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of m faces.

    Returns
    -------
    int array of shape (m, 3)
        9 g + 3 a + b at face f and corner k, when across the edge opposite corner k lies face g, whose corners a and b
        are corners k + 1 and k + 2 of f; -1 where nothing lies across.
    """
    corners = np.sort(mesh.faces, axis=1)
    proper = np.flatnonzero((np.diff(corners, axis=1) > 0).all(axis=1))
    first, copy_of = np.unique(corners[proper], axis=0, return_index=True, return_inverse=True)[1:]
    table = np.full((mesh.n_faces, 3), NO_NEIGHBOUR, dtype=np.int64)
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
        if code != NO_NEIGHBOUR and swapped:
            code = code // 9 * 9 + code % 3 * 3 + code // 3 % 3
        row.append(code)
    return row
