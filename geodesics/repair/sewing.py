"""Open edges split at the vertices of others that lie on them, so that both hang together."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.mesh import Mesh
from geodesics.topology.junctions import Junctions, junctions


def sewn(mesh: Mesh) -> tuple[Integers, Integers, Floats]:
    """The faces of a mesh with open edges split at the vertices that lie on them (see `junctions`).

    Parameters
    ----------
    mesh : Mesh
        The mesh, of m faces. Positions stay as they are.

    Returns
    -------
    faces : int array of shape (k, 3)
        The first piece of each face is in its place, the others come last.
    face : int array of shape (k,)
        The face of which each is a piece.
    corners : float array of shape (k, 3, 3)
        The corners of each as barycentric coordinates in that face.
    """
    at = junctions(mesh)
    where, sides = _barycentric(at), np.arange(3 * mesh.n_faces).reshape(-1, 3)
    faces, face = mesh.faces.copy(), np.arange(mesh.n_faces)
    corners = np.broadcast_to(np.eye(3), (mesh.n_faces, 3, 3)).copy()
    start, stop = np.searchsorted(at.side, sides), np.searchsorted(at.side, sides, side="right")  # of those on a side
    while len(split := np.flatnonzero((stop > start).any(axis=1))):
        turn = ((stop - start)[split].argmax(axis=1)[:, None] + np.arange(3)) % 3  # the side to split comes first
        turned = split[:, None], turn
        (a, b, c), (ab, bc, ca), (ab_end, bc_end, ca_end) = faces[turned].T, start[turned].T, stop[turned].T
        at_a, at_b, at_c = corners[turned].transpose(1, 0, 2)
        middle, none = (ab + ab_end) // 2, np.zeros_like(ab)
        v, at_v = at.vertex[middle], where[middle]
        faces[split], corners[split] = _columns(a, v, c), _columns(at_a, at_v, at_c)
        start[split], stop[split] = _columns(ab, none, ca), _columns(middle, none, ca_end)
        faces, corners = np.vstack([faces, _columns(v, b, c)]), np.vstack([corners, _columns(at_v, at_b, at_c)])
        start = np.vstack([start, _columns(middle + 1, bc, none)])
        stop, face = np.vstack([stop, _columns(ab_end, bc_end, none)]), np.append(face, face[split])
    return faces, face, corners


def _columns(*three: np.ndarray) -> np.ndarray:
    return np.stack(three, axis=1)


def _barycentric(at: Junctions) -> Floats:
    """Where junctions are in the faces of their edges, (k, 3)."""
    where, row = np.zeros((len(at), 3)), np.arange(len(at))
    where[row, at.side % 3], where[row, (at.side + 1) % 3] = 1 - at.along, at.along
    return where
