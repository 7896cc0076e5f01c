"""A coarser mesh of any mesh, whatever its defects: vertices of one grid cell become one."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.mesh import Mesh


def clustered(mesh: Mesh, n_vertices: int) -> Mesh:
    """One vertex for all those in a cell of a grid, whatever defects the mesh has: at most about `n_vertices`."""
    used = np.unique(mesh.faces)
    v = mesh.vertices[used] - mesh.vertices[used].min(axis=0)
    v /= v.max() or 1.0
    coarse, fine = 2, 2048
    while fine - coarse > max(1, coarse // 20):
        middle = (coarse + fine) // 2
        few = len(np.unique(_cells(v, middle))) <= n_vertices
        coarse, fine = (middle, fine) if few else (coarse, middle)
    _, first, member = np.unique(_cells(v, coarse), return_index=True, return_inverse=True)
    new = np.empty(mesh.n_vertices, dtype=np.int64)
    new[used] = member.reshape(-1)
    faces = new[mesh.faces]
    proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Mesh(mesh.vertices[used[first]], np.unique(faces[proper], axis=0) if proper.any() else faces[:1])


def _cells(v: Floats, finer: int) -> Integers:
    """The number of the cell of each of the points (n, 3) in [0, 1], in a grid of `finer` cells a side."""
    return np.minimum((v * finer).astype(np.int64), finer - 1) @ [1, finer, finer * finer]
