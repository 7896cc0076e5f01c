"""Finding a point of the mesh in its intrinsic triangulation, by walking straight from the nearest vertex."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from geodesics._kernels.jit import njit
from geodesics.arrays import Floats, Integers


class Net(NamedTuple):
    """Triangles (see `GluedTriangulation`), and their corners 3 * face + k grouped by vertex, from start[v] on."""

    start: Integers
    corner: Integers
    lengths: Floats
    twin: Integers
    direction: Floats
    whole: Floats


@njit
def _corner_angle(lengths: Floats, f: int, k: int) -> float:
    """The angle at corner k of face f."""
    a, b, c = lengths[f, k], lengths[f, (k + 1) % 3], lengths[f, (k + 2) % 3]
    return math.acos(min(1.0, max(-1.0, (b * b + c * c - a * a) / (2.0 * b * c))))


@njit
def _first_corner(net: Net, v: int, way: float) -> tuple[int, float]:
    """The corner 3 * face + k at vertex v that direction `way` points into, and the angle there; -1 where none is."""
    for q in range(net.start[v], net.start[v + 1]):
        h = net.corner[q]
        inside = way - net.direction[h // 3, h % 3]
        if net.whole[v] < np.inf:
            inside = (inside + 1e-9) % net.whole[v] - 1e-9
        if -1e-9 <= inside <= _corner_angle(net.lengths, h // 3, h % 3) + 1e-9:
            return h, inside
    return -1, 0.0


@njit
def _walk(lengths: Floats, twin: Integers, h: int, angle: float, distance: float, weights: Floats) -> int:
    """Go straight from corner h, at `angle` from its first edge; returns the face reached, -1 if the boundary was met.

    The triangle is kept as its corners in the plane of the first face; weights (3,) receives the barycentric place.
    """
    f, k = h // 3, h % 3
    px, py = distance * math.cos(angle), distance * math.sin(angle)
    x, y = np.zeros(3), np.zeros(3)
    j, i = (k + 1) % 3, (k + 2) % 3
    apex = _corner_angle(lengths, f, k)
    x[j] = lengths[f, i]
    x[i], y[i] = lengths[f, j] * math.cos(apex), lengths[f, j] * math.sin(apex)
    entered = -1
    for _ in range(10000):
        area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
        worst, leave = -1e-12, -1
        for c in range(3):
            c1, c2 = (c + 1) % 3, (c + 2) % 3
            part = (x[c1] - px) * (y[c2] - py) - (x[c2] - px) * (y[c1] - py)
            weights[c] = part / area if area > 0.0 else 1.0 / 3.0
            if weights[c] < worst and c != entered and (entered >= 0 or c == k):
                worst, leave = weights[c], c
        if leave < 0:
            return f
        t = twin[3 * f + leave]
        if t < 0:
            return -1
        ax, ay = x[(leave + 1) % 3], y[(leave + 1) % 3]
        bx, by = x[(leave + 2) % 3], y[(leave + 2) % 3]
        f, entered = t // 3, t % 3
        far, near = lengths[f, (entered + 1) % 3], lengths[f, (entered + 2) % 3]
        base = lengths[f, entered]
        along = 0.5 * (base + (near - far) * (near + far) / base)
        high = math.sqrt(max((near - along) * (near + along), 0.0))
        # the new face runs from b to a on this edge, with the old one on its other side
        ux, uy = (ax - bx) / base, (ay - by) / base
        x[entered], y[entered] = bx + along * ux - high * uy, by + along * uy + high * ux
        x[(entered + 1) % 3], y[(entered + 1) % 3] = bx, by
        x[(entered + 2) % 3], y[(entered + 2) % 3] = ax, ay
    return -1


@njit
def locate(net: Net, rays: Floats) -> tuple[Integers, Floats]:
    """Faces (p,), -1 where lost, and weights (p, 3) of the ends of rays (p, 3): vertex, direction, length."""
    face, weights = np.full(rays.shape[0], -1, dtype=np.int64), np.zeros((rays.shape[0], 3))
    for p in range(rays.shape[0]):
        h, angle = _first_corner(net, int(rays[p, 0]), rays[p, 1])
        if h >= 0:
            face[p] = _walk(net.lengths, net.twin, h, angle, rays[p, 2], weights[p])
    return face, weights
