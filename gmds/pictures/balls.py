"""Points drawn on a surface: a little ball at each."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats

RADIUS = 0.018  # in square roots of the area: to be seen, and to hide little; set by hand
CORNERS = np.vstack([np.eye(3), -np.eye(3)])  # of an octahedron, which shading makes round
FACES = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])  # likewise


def with_balls(mesh: Mesh, colours: Floats, places: Floats, inks: Floats) -> tuple[Mesh, Floats]:
    """The mesh with a ball at each place (k, 3), and the colours of all its vertices.

    `colours` (n, 3) are those of the surface, `inks` (k, 3) or (3,) those of the balls, sRGB in [0, 1].
    """
    n, k = mesh.n_vertices, len(places)
    corners = CORNERS * RADIUS * np.sqrt(mesh.area)
    shape = Mesh(
        np.vstack([mesh.vertices, (places[:, None] + corners).reshape(-1, 3)]),
        np.vstack([mesh.faces, (n + len(CORNERS) * np.arange(k)[:, None, None] + FACES).reshape(-1, 3)]),
    )
    return shape, np.vstack([colours, np.repeat(np.broadcast_to(inks, (k, 3)), len(CORNERS), axis=0)])
