"""Compiled loops over half-edges 3 * face + k: the edge opposite corner k, from corner k + 1 to corner k + 2."""

from __future__ import annotations

import math

import numpy as np

from geodesics._kernels.jit import njit
from geodesics.arrays import Bools, Floats, Integers

FAN_GAP = 1000.0  # radians between two fans of faces that meet only in a vertex: a bound, more than any sum of angles


@njit
def orientation(faces: Integers, twin: Integers) -> Bools:
    """Faces (m,) to turn over so that neighbours agree; pairs of twins (3 m,) that cannot agree are set to -1."""
    m = faces.shape[0]
    sign = np.zeros(m, dtype=np.int64)
    stack = np.empty(m, dtype=np.int64)
    for seed in range(m):
        if sign[seed] != 0:
            continue
        sign[seed] = 1
        stack[0], size = seed, 1
        while size > 0:
            size -= 1
            f = stack[size]
            for k in range(3):
                t = twin[3 * f + k]
                if t < 0:
                    continue
                g = t // 3
                opposed = faces[f, (k + 1) % 3] == faces[g, (t + 2) % 3]
                wanted = sign[f] if opposed else -sign[f]
                if sign[g] == 0:
                    sign[g] = wanted
                    stack[size] = g
                    size += 1
                elif sign[g] != wanted:
                    twin[3 * f + k] = -1
                    twin[t] = -1
    return sign < 0


@njit
def corner_angle(opposite: float, b: float, c: float) -> float:
    """The angle between edges b and c of a triangle; exact to rounding on needles (Kahan)."""
    if b < c:
        b, c = c, b
    mu = c - (b - opposite) if c <= opposite else opposite - (b - c)
    top = ((b - c) + opposite) * max(mu, 0.0)
    bottom = (b + (c + opposite)) * max((b - opposite) + c, 0.0)
    return 2.0 * math.atan2(math.sqrt(max(top, 0.0)), math.sqrt(bottom))


@njit
def signposts(faces: Integers, lengths: Floats, twin: Integers, phi: Floats, total: Floats) -> None:
    """Direction phi (m, 3) of the edge leaving each corner for the next one, in angles summed round its vertex.

    total (n,) is the whole angle of a vertex ringed by one closed fan, else inf. Further fans start at multiples
    of `FAN_GAP`.
    """
    m = faces.shape[0]
    seen = np.zeros((m, 3), dtype=np.bool_)
    fans = np.zeros(total.shape[0], dtype=np.int64)
    total[:] = np.inf
    for f0 in range(m):
        for k0 in range(3):
            if seen[f0, k0]:
                continue
            f, k = f0, k0
            while True:  # clockwise to the first face of the fan
                t = twin[3 * f + (k + 2) % 3]
                if t < 0:
                    break
                f, k = t // 3, (t + 2) % 3
                if f == f0 and k == k0:
                    break
            v = faces[f, k]
            angle = FAN_GAP * fans[v]
            fans[v] += 1
            closed = False
            while not seen[f, k]:
                seen[f, k] = True
                phi[f, k] = angle
                angle += corner_angle(lengths[f, k], lengths[f, (k + 1) % 3], lengths[f, (k + 2) % 3])
                t = twin[3 * f + (k + 1) % 3]
                if t < 0:
                    break
                f, k = t // 3, (t + 1) % 3
                closed = seen[f, k]
            if closed and fans[v] == 1:
                total[v] = angle
            elif fans[v] > 1:
                total[v] = np.inf
    return


@njit
def _above(lengths: Floats, h: int) -> tuple[float, float]:
    """The corner opposite half-edge h, seen from the edge laid along the x axis from 0."""
    f, k = h // 3, h % 3
    base, far, near = lengths[f, k], lengths[f, (k + 1) % 3], lengths[f, (k + 2) % 3]
    angle = corner_angle(far, base, near)
    return near * math.cos(angle), near * math.sin(angle)


@njit
def _flip(faces: Integers, lengths: Floats, twin: Integers, phi: Floats, h: int) -> tuple[int, int, int, int]:
    """Replace the edge h by the other diagonal of its two faces; returns the four edges around them."""
    t = twin[h]
    f, g, k, j = h // 3, t // 3, h % 3, t % 3
    k1, k2, j1, j2 = (k + 1) % 3, (k + 2) % 3, (j + 1) % 3, (j + 2) % 3
    xc, yc = _above(lengths, h)
    xd, yd = _above(lengths, t)
    length = math.hypot(xc - (lengths[f, k] - xd), yc + yd)
    a, b, c, d = faces[f, k1], faces[f, k2], faces[f, k], faces[g, j]
    ca, bc, ad, db = lengths[f, k2], lengths[f, k1], lengths[g, j1], lengths[g, j2]
    phi_c, phi_b, phi_d, phi_a = phi[f, k], phi[f, k2], phi[g, j], phi[g, j2]
    ends = (twin[3 * g + j1], twin[3 * f + k2], twin[3 * f + k1], twin[3 * g + j2])
    # f becomes (c, a, d) and g becomes (d, b, c)
    faces[f, 0], faces[f, 1], faces[f, 2] = c, a, d
    faces[g, 0], faces[g, 1], faces[g, 2] = d, b, c
    lengths[f, 0], lengths[f, 1], lengths[f, 2] = ad, length, ca
    lengths[g, 0], lengths[g, 1], lengths[g, 2] = bc, length, db
    phi[f, 0], phi[f, 1], phi[f, 2] = phi_c, phi_a, phi_d + corner_angle(bc, db, length)
    phi[g, 0], phi[g, 1], phi[g, 2] = phi_d, phi_b, phi_c + corner_angle(ad, ca, length)
    old = (3 * g + j1, 3 * f + k2, 3 * f + k1, 3 * g + j2)
    new = (3 * f, 3 * f + 2, 3 * g, 3 * g + 2)
    for i in range(4):
        end = ends[i]
        for q in range(4):  # the four may be glued to one another
            if ends[i] == old[q]:
                end = new[q]
        twin[new[i]] = end
        if end >= 0:
            twin[end] = new[i]
    twin[3 * f + 1], twin[3 * g + 1] = 3 * g + 1, 3 * f + 1
    return new


@njit
def flip_to_delaunay(faces: Integers, lengths: Floats, twin: Integers, phi: Floats, budget: int) -> int:
    """Flip in place until no edge has opposite angles above pi in sum, at most `budget` flips; returns their number."""
    count = twin.shape[0]
    stack, waiting = np.empty(count, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    size, flips = 0, 0
    for h in range(count):
        if twin[h] > h:
            stack[size], waiting[h] = h, True
            size += 1
    while size > 0 and flips < budget:
        size -= 1
        h = stack[size]
        waiting[h] = False
        f, g, k, j = h // 3, twin[h] // 3, h % 3, twin[h] % 3
        if twin[h] < 0 or f == g:
            continue
        opposite = corner_angle(lengths[f, k], lengths[f, (k + 1) % 3], lengths[f, (k + 2) % 3])
        opposite += corner_angle(lengths[g, j], lengths[g, (j + 1) % 3], lengths[g, (j + 2) % 3])
        if opposite <= math.pi + 1e-9:
            continue
        flips += 1
        for e in _flip(faces, lengths, twin, phi, h):
            first = min(e, twin[e])
            if first >= 0 and not waiting[first]:
                stack[size], waiting[first] = first, True
                size += 1
    return flips
