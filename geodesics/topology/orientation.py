"""The orientation of faces: consistent, and outward for closed surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arrays import Bools, Integers
from geodesics.mesh import Mesh, of_a_mesh
from geodesics.topology.edges import components, edges


@dataclass(frozen=True, eq=False)
class Orientation:
    """What to do for a consistent orientation: faces to turn, and what kind of parts the surface has.

    `turn` (m,) faces to turn so that neighbours agree, at most half of each part, `inward` (m,) faces of closed parts
    that would then enclose a negative volume, `one_sided` (m,) faces of parts that have no orientation.
    """

    turn: Bools
    inward: Bools
    one_sided: Bools


def orientation(mesh: Mesh) -> Orientation:
    """How the faces of each part (faces joined by edges of exactly two faces) are oriented.

    Every face stands for two nodes, as it is and turned; neighbours are joined so that both agree. A part that falls
    into two such halves can be oriented, and each half is one way of doing it.
    """
    m, table = mesh.n_faces, edges(mesh)
    s, t = table.pairs()
    f, g = s // 3, t // 3
    clash = table.forward.ravel()[s] == table.forward.ravel()[t]
    other = np.where(clash, g + m, g)
    sheet = components(np.concatenate([f, f + m]), np.concatenate([other, np.where(clash, g, g + m)]), 2 * m)
    part = components(f, g, m)
    one_sided = sheet[:m] == sheet[m:]
    n_parts = int(part.max()) + 1
    first_face = np.zeros(n_parts, dtype=np.int64)
    first_face[part[::-1]] = np.arange(m - 1, -1, -1)
    turn = (sheet[:m] != sheet[first_face][part]) & ~one_sided
    most = 2 * np.bincount(part[turn], minlength=n_parts) > np.bincount(part, minlength=n_parts)
    turn = (turn ^ most[part]) & ~one_sided
    return Orientation(turn, _inward(mesh, turn, part) & ~one_sided, one_sided)


@of_a_mesh
def orient_faces(mesh: Mesh) -> Mesh:
    """The same mesh with consistently oriented faces, outward where the surface is closed.

    Neighbours are faces that share an edge of exactly two faces. Parts that have no orientation (a Moebius strip) stay
    as they are.

    Parameters
    ----------
    mesh : Mesh
        The mesh.

    Returns
    -------
    Mesh
        Vertices and faces in the same order; a turned face keeps its first corner.

    See Also
    --------
    geodesics.repair.repair : Orients faces as well.

    Examples
    --------
    >>> import geodesics
    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> turned = geodesics.Mesh(square, [[0, 1, 2], [0, 3, 2]])
    >>> geodesics.orient_faces(turned).faces.tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    sides = orientation(mesh)
    turn = sides.turn ^ sides.inward
    if not turn.any():
        return mesh
    return Mesh(mesh.vertices, np.where(turn[:, None], mesh.faces[:, [0, 2, 1]], mesh.faces))


def _inward(mesh: Mesh, turn: Bools, part: Integers) -> Bools:
    """Faces of parts without a boundary whose volume is negative once `turn` is applied."""
    table = edges(mesh)
    open_side = (table.of_side >= 0) & (table.n_faces[table.of_side] == 1)
    is_open = np.zeros(int(part.max()) + 1, dtype=bool)
    is_open[part[open_side.any(axis=1)]] = True
    corner = mesh.vertices[mesh.faces]
    middle = np.stack([np.bincount(part, weights=axis) for axis in corner.mean(axis=1).T], axis=1)
    corner = corner - (middle / np.bincount(part)[:, None])[part][:, None]
    normal = np.cross(corner[:, 1], corner[:, 2])
    volume = np.einsum("fi,fi->f", corner[:, 0], normal)
    total = np.bincount(part, weights=np.where(turn, -volume, volume))
    size = np.linalg.norm(corner[:, 0], axis=1) * np.linalg.norm(normal, axis=1)
    rounding = 1e-9 * np.bincount(part, weights=size)  # a part folded flat has no inside
    return np.asarray(((total < -rounding) & ~is_open)[part])
