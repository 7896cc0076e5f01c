"""Surfaces that few meet: one-sided, of any genus, pointed, crowded; each function returns a `Mesh`."""

from __future__ import annotations

import numpy as np
from generated_shapes import grid, subdivided

from geodesics import Mesh


def strip(n: int = 40, klein: bool = False) -> Mesh:
    """A Moebius strip, or the figure-eight Klein bottle: one-sided."""
    u, v, faces = grid(n, 8, wrap_x=True, wrap_y=klein)
    rows = 8 if klein else 9
    i, j = faces // rows, faces % rows
    seam = (i.max(axis=1) == n - 1) & (i.min(axis=1) == 0)
    j = np.where(seam[:, None] & (i == 0), (j + 4) % 8 if klein else 8 - j, j)
    angle, w = 2 * np.pi * u, 2 * np.pi * v if klein else v - 0.5
    x, z = (np.sin(w), np.sin(2 * w)) if klein else (w, 0 * w)
    r = 3 + np.cos(angle / 2) * x - np.sin(angle / 2) * z
    up = np.sin(angle / 2) * x + np.cos(angle / 2) * z
    return Mesh(np.stack([r * np.cos(angle), r * np.sin(angle), up], axis=1), rows * i + j)


def plate(holes: int) -> Mesh:
    """The surface of a plate with holes in a row: genus `holes`."""
    solid = np.zeros((5, 2 * holes + 3, 3), dtype=bool)
    solid[1:4, 1:-1, 1] = True
    solid[2, 2:-2:2, 1] = False
    corners, faces = [], []
    for axis in range(3):
        for x in np.argwhere(np.diff(solid.astype(int), axis=axis)):
            at = x + np.eye(3, dtype=int)[axis]
            b, c = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
            quad = [at, at + b, at + b + c, at + c]
            corners += quad if solid[tuple(x)] else quad[::-1]
            k = len(corners) - 4
            faces += [[k, k + 1, k + 2], [k, k + 2, k + 3]]
    points, place = np.unique(np.array(corners), axis=0, return_inverse=True)
    return subdivided(Mesh(points, place.reshape(-1)[np.array(faces)]))


def cone() -> Mesh:
    """A cone without its base."""
    u, v, faces = grid(24, 10, wrap_x=True)
    r = 0.05 + v
    return Mesh(np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), 2 * v], axis=1), faces)


def crowded(mesh: Mesh) -> Mesh:
    """Some faces split into many by their middles."""
    v, f = mesh.vertices, mesh.faces
    for _ in range(6):
        chosen, rest = f[:8], f[8:]
        middle = len(v) + np.arange(8)
        v = np.concatenate([v, v[chosen].mean(axis=1)])
        a, b, c = chosen.T
        f = np.concatenate(
            [np.stack([a, b, middle], 1), np.stack([b, c, middle], 1), np.stack([c, a, middle], 1), rest]
        )
    return Mesh(v, f)
