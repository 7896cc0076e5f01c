"""Walking straight across triangles: one loop per point, scalars inside."""

from __future__ import annotations

import numpy as np

from geodesics._kernels.jit import njit
from geodesics.arrays import Floats, Integers

NO_NEIGHBOUR = -1  # in `neighbour[f, k]`, where nothing lies across the edge of face f opposite corner k


@njit
def _corner(f: int, k: int, layout: Floats) -> tuple[float, float]:
    """Corner k of face f in the plane: corner 0 at the origin, corner 1 on the x axis, corner 2 above it."""
    if k == 0:
        return 0.0, 0.0
    if k == 1:
        return layout[f, 0], 0.0
    return layout[f, 1], layout[f, 2]


@njit
def _edge(f: int, a: int, b: int, layout: Floats) -> tuple[float, float, float, float]:
    """Unit vector from corner a to corner b of face f, and the unit normal of that edge towards the third corner."""
    ax, ay = _corner(f, a, layout)
    bx, by = _corner(f, b, layout)
    cx, cy = _corner(f, 3 - a - b, layout)
    ex, ey = bx - ax, by - ay
    length = np.sqrt(ex * ex + ey * ey)
    ex, ey = ex / length, ey / length
    nx, ny = -ey, ex
    if nx * (cx - ax) + ny * (cy - ay) < 0.0:
        nx, ny = -nx, -ny
    return ex, ey, nx, ny


@njit
def walk(
    face: Integers, barycentric: Floats, displacement: Floats, neighbour: Integers, layout: Floats, max_crossings: int
) -> tuple[Integers, Floats]:
    """Move every point (p,) by its displacement (p, 2), unfolding the next face into the plane at every edge.

    `neighbour` (m, 3) is 9 g + 3 a + b: across the edge of f opposite corner k lies face g, whose corners a and b are
    corners k + 1 and k + 2 of f. Where there is none the point slides along the edge.
    """
    end_face = face.copy()
    end_barycentric = barycentric.copy()
    b = np.empty(3)
    rate = np.empty(3)
    moved = np.empty(3)
    for p in range(len(face)):
        f = face[p]
        vx, vy = displacement[p, 0], displacement[p, 1]
        for k in range(3):
            b[k] = barycentric[p, k]
        for _ in range(max_crossings + 1):
            rate[2] = vy / layout[f, 2]
            rate[1] = (vx - layout[f, 1] * rate[2]) / layout[f, 0]
            rate[0] = -rate[1] - rate[2]
            largest = max(abs(rate[0]), abs(rate[1]), abs(rate[2]))
            if not 0.0 < largest < np.inf:
                break
            time, exit_edge, outward = 1.0, -1, 0.0
            for k in range(3):
                if rate[k] < -1e-13 * largest and b[k] < -rate[k]:
                    t = b[k] / -rate[k]
                    if t < 1e-15:
                        t = 0.0
                    if t < time or (t == time and t == 0.0):
                        _, _, nx, ny = _edge(f, (k + 1) % 3, (k + 2) % 3, layout)
                        speed = -(vx * nx + vy * ny)
                        if t < time or speed > outward:
                            time, exit_edge, outward = t, k, speed
            for k in range(3):
                b[k] = max(b[k] + time * rate[k], 0.0)
            if exit_edge < 0:
                break
            b[exit_edge] = 0.0
            vx, vy = vx * (1.0 - time), vy * (1.0 - time)
            k1, k2 = (exit_edge + 1) % 3, (exit_edge + 2) % 3
            ex, ey, nx, ny = _edge(f, k1, k2, layout)
            along = vx * ex + vy * ey
            across = -(vx * nx + vy * ny)
            code = neighbour[f, exit_edge]
            if code == NO_NEIGHBOUR:
                vx, vy = along * ex, along * ey
                continue
            g, i, j = code // 9, (code // 3) % 3, code % 3
            moved[i], moved[j], moved[3 - i - j] = b[k1], b[k2], 0.0
            ex, ey, nx, ny = _edge(g, i, j, layout)
            vx, vy = along * ex + across * nx, along * ey + across * ny
            f = g
            for k in range(3):
                b[k] = moved[k]
        total = b[0] + b[1] + b[2]
        end_face[p] = f
        for k in range(3):
            end_barycentric[p, k] = b[k] / total
    return end_face, end_barycentric
