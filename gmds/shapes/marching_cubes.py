"""The undeformed body as a fine mesh: marching cubes on a grid turned and shifted by the seed."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from geodesics.arrays import Floats, Integers
from gmds.shapes.implicit import blend
from gmds.shapes.skeleton import Body

_COARSE = (
    4  # fine cells along a cell of the first, coarse evaluation; saves time; values near the surface are exact with any
)


@lru_cache(maxsize=8)
def fine_surface(body: Body, spacing: float, seed: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) on the body's surface to rounding, and faces (m, 3); closed, oriented outwards.

    Another seed turns and shifts the grid: another triangulation of the same surface.
    """
    import igl

    rng = np.random.default_rng([seed, 51])
    turn = Rotation.from_rotvec(rng.uniform(-0.5, 0.5, 3))
    corners = turn.apply(_corners(body))
    low = corners.min(axis=0) - spacing * (4 + rng.uniform(0, 1, 3))
    cells = np.ceil((corners.max(axis=0) + 4 * spacing - low) / (_COARSE * spacing)).astype(int)
    shape = cells * _COARSE
    steps = np.stack(np.meshgrid(*(np.arange(k) for k in shape), indexing="ij"), axis=-1)
    points = turn.apply((low + spacing * steps).reshape(-1, 3), inverse=True)
    values = _values(body, points.reshape(*shape, 3), _COARSE * spacing)
    order = np.arange(len(points)).reshape(shape).transpose(2, 1, 0).ravel()  # igl runs through x first
    grid = [int(k) for k in shape]
    vertices, faces, _ = igl.marching_cubes(values.ravel()[order], np.ascontiguousarray(points[order]), *grid)
    vertices = body.project(vertices)
    vertices.setflags(write=False)
    faces.setflags(write=False)
    return vertices, faces


def _corners(body: Body) -> Floats:
    """Corners of the boxes of all parts, shape (8 * parts, 3)."""
    pick = np.array([[i >> k & 1 for k in range(3)] for i in range(8)])
    boxes = np.array([part.box() for part in body.parts])
    return boxes[:, pick, np.arange(3)].reshape(-1, 3)


def _values(body: Body, points: Floats, reach: float) -> Floats:
    """The blended distance at grid points (x, y, z, 3), exact only where a coarse evaluation says that the surface is
    near.
    """
    half = _COARSE // 2
    coarse = points[half::_COARSE, half::_COARSE, half::_COARSE]
    look = blend(body.parts, coarse.reshape(-1, 3), body.blend_width).reshape(coarse.shape[:3])
    values = look.repeat(_COARSE, 0).repeat(_COARSE, 1).repeat(_COARSE, 2)
    near = np.abs(values) < 1.8 * reach
    values[near] = blend(body.parts, points[near], body.blend_width)
    return values
