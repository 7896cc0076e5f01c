"""The marching front: arrays in, arrays out."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import njit

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

UNSEEN, ACCEPTED = -1, -2  # positions in the heap of vertices that are not in it
FAN_GAP = 1000.0  # directions further apart lie in fans that meet only in the vertex
HALF_GAP = 500.0


class Corners(NamedTuple):
    """The corners of all faces, grouped by vertex: those of v are rows start[v] to start[v + 1].

    In a row, `ends` are the next and the previous vertex of the face, `shape` the lengths of the edges to them, cosine
    and sine of the angle between, the directions at v of next and previous, and the directions of v at each of them;
    `slowness` is that of the face. `vertex` (n, 2) is the whole angle and the slowness at each vertex.
    """

    start: Integers
    ends: Integers
    shape: Floats
    slowness: Floats
    vertex: Floats


class Front(NamedTuple):
    """Distance, direction of arrival and offset of the source per vertex (n, 3); position in the heap (n,); heap (n,);
    touched (n,), the vertices ever reached in order; visits (n,), how often each was accepted; size (2,) of heap and touched."""

    state: Floats
    position: Integers
    heap: Integers
    touched: Integers
    visits: Integers
    size: Integers


@njit
def _rise(front: Front, i: int, v: int) -> None:
    """Put v into the heap at i or nearer the top."""
    key = front.state[v, 0]
    while i > 0:
        parent = (i - 1) >> 1
        u = front.heap[parent]
        if front.state[u, 0] <= key:
            break
        front.heap[i] = u
        front.position[u] = i
        i = parent
    front.heap[i] = v
    front.position[v] = i


@njit
def _pop(front: Front) -> int:
    """Take the nearest vertex from the heap."""
    top = front.heap[0]
    front.position[top] = ACCEPTED
    front.visits[top] += 1
    front.size[0] -= 1
    size = front.size[0]
    if size > 0:
        v = front.heap[size]
        key = front.state[v, 0]
        i = 0
        while 2 * i + 1 < size:
            child = 2 * i + 1
            if child + 1 < size and front.state[front.heap[child + 1], 0] < front.state[front.heap[child], 0]:
                child += 1
            u = front.heap[child]
            if front.state[u, 0] >= key:
                break
            front.heap[i] = u
            front.position[u] = i
            i = child
        front.heap[i] = v
        front.position[v] = i
    return top


@njit
def _lower(front: Front, v: int, distance: float, direction: float, offset: float) -> None:
    """Give v a shorter distance, and a place in the heap."""
    front.state[v, 0], front.state[v, 1], front.state[v, 2] = distance, direction, offset
    place = front.position[v]
    if place == UNSEEN:
        front.touched[front.size[1]] = v
        front.size[1] += 1
    if place < 0:
        place = front.size[0]
        front.size[0] += 1
    _rise(front, place, v)


@njit
def _slope(arrival: float, along: float, whole: float) -> float:
    """Derivative of the distance along an edge, -cos of the angle to the way back; 2 where that is not known."""
    turn = abs(arrival - along)
    if turn > 0.5 * whole:
        turn = abs(whole - turn)
    if not turn < HALF_GAP:
        return 2.0
    return -math.cos(turn) if turn < math.pi else 1.0


@njit
def _cross(d0: float, d1: float, length: float, x: float, y: float, p0: float, p1: float) -> tuple[float, float]:
    """Distance at (x, y), y > 0, behind the edge from (0, 0) to (length, 0), and where on the edge its path crosses.

    d0, d1 are the distances at the ends and p0, p1 their derivatives along the edge (2: not known). The source is
    unfolded into the plane, at distances d0 and d1 from the ends; the cubic that corrects its slopes at the ends is
    added to the distance along the edge, and the crossing found by one Newton step from the straight line.
    """
    xs = 0.5 * (length + (d0 - d1) * (d0 + d1) / length)
    ys = math.sqrt(max((d0 - xs) * (d0 + xs), 0.0))
    at = xs + (x - xs) * (ys / (ys + y))
    if not at > 0.0:
        return d0 + math.hypot(x, y), 0.0
    if at >= length:
        return d1 + math.hypot(x - length, y), length
    value = math.sqrt((x - xs) * (x - xs) + (y + ys) * (y + ys))
    m0 = p0 + xs / d0 if p0 < 2.0 and d0 > 0.0 else 0.0
    m1 = p1 - (length - xs) / d1 if p1 < 2.0 and d1 > 0.0 else 0.0
    if abs(m0) + abs(m1) > 0.5:
        return value, at
    t = at / length
    u = 1.0 - t
    rise = m0 * u * (u - 2.0 * t) + m1 * t * (t - 2.0 * u)  # derivative of the cubic
    value += length * t * u * (m0 * u - m1 * t)
    depth = ys + y
    flat = (
        value * value * value * ys * y / (depth * depth * depth * depth)
    )  # 1 / second derivative of the straight path
    step = rise * flat
    return value - 0.5 * rise * step, min(max(at - step, 0.0), length)


@njit
def _try_edge(front: Front, v: int, u: int, length: float, direction: float) -> None:
    """Reach u from v along their edge."""
    reached = front.state[v, 0] + length
    if reached < front.state[u, 0] and _may_lower(front, u, reached, length):
        _lower(front, u, reached, direction, front.state[v, 2])


@njit
def _may_lower(front: Front, u: int, reached: float, length: float) -> bool:
    """An accepted vertex is taken back only for a real gain, and not for ever."""
    if front.position[u] != ACCEPTED:
        return True
    return front.visits[u] < 20 and reached < front.state[u, 0] - 1e-7 * length


@njit
def _expand(corners: Corners, front: Front, v: int, q: int) -> None:
    """Carry the distance of v, just accepted, over the face of its corner q."""
    a, b = corners.ends[q, 0], corners.ends[q, 1]
    slowness = corners.slowness[q]
    la, lb = slowness * corners.shape[q, 0], slowness * corners.shape[q, 1]
    va, vb, av, bv = corners.shape[q, 4], corners.shape[q, 5], corners.shape[q, 6], corners.shape[q, 7]
    _try_edge(front, v, a, la, av)
    _try_edge(front, v, b, lb, bv)
    cosine, sine = corners.shape[q, 2], corners.shape[q, 3]
    if sine <= 0.0:
        return
    if front.position[a] == ACCEPTED and (front.position[b] != ACCEPTED or lb < la * cosine):
        _try_face(corners, front, v, a, b, slowness, la, lb * cosine, lb * sine, va, av, bv, 1.0)
    if front.position[b] == ACCEPTED and (front.position[a] != ACCEPTED or la < lb * cosine):
        _try_face(corners, front, v, b, a, slowness, lb, la * cosine, la * sine, vb, bv, av, -1.0)


@njit
def _try_face(
    corners: Corners,
    front: Front,
    v: int,
    a: int,
    c: int,
    slowness: float,
    length: float,
    x: float,
    y: float,
    va: float,
    av: float,
    cv: float,
    turn: float,
) -> None:
    """Reach c through the edge from v to a; `turn` is +1 where the face runs v, a, c."""
    state, vertex = front.state, corners.vertex
    offset = min(state[v, 2], state[a, 2])
    d0, d1 = state[v, 0] - offset, state[a, 0] - offset
    p0 = _slope(state[v, 1], va, vertex[v, 0])
    p1 = -_slope(state[a, 1], av, vertex[a, 0])
    if abs(p0) < 2.0:
        p0 *= vertex[v, 1] / slowness
    p1 = p1 * vertex[a, 1] / slowness if abs(p1) < 2.0 else 2.0
    reached, at = _cross(d0, d1, length, x, y, p0, p1)
    reached += offset
    if not reached < state[c, 0]:
        return
    if not _may_lower(front, c, reached, length):
        return
    dot, cross = x * (x - at) + y * y, y * at
    direction = cv + turn * math.atan2(cross, dot)
    _lower(front, c, reached, _wrap(direction, vertex[c, 0]), offset)


@njit
def _wrap(direction: float, whole: float) -> float:
    """A direction taken into [0, whole)."""
    if direction < 0.0:
        return direction + whole if whole < HALF_GAP else direction
    return direction - whole if direction >= whole else direction


@njit
def march(corners: Corners, front: Front, bound: Floats, limit: float) -> None:
    """Accept the vertices of the heap in order of distance, none beyond `limit`, crossing none beyond its `bound` (n,)."""
    while front.size[0] > 0:
        v = _pop(front)
        if front.state[v, 0] > limit:
            break
        if front.state[v, 0] > bound[v]:
            continue
        for q in range(corners.start[v], corners.start[v + 1]):
            _expand(corners, front, v, q)


@njit
def start_at(corners: Corners, front: Front, v: int, distance: float, direction: float, offset: float) -> None:
    """Put a first vertex on the front."""
    if distance < front.state[v, 0]:
        _lower(front, v, distance, direction, offset)


@njit
def clear(front: Front) -> None:
    """Take back everything the last march did."""
    for i in range(front.size[1]):
        v = front.touched[i]
        front.state[v, 0] = np.inf
        front.position[v] = UNSEEN
        front.visits[v] = 0
    front.size[:] = 0


@njit
def run(
    corners: Corners,
    front: Front,
    vertices: Integers,
    distances: Floats,
    directions: Floats,
    bound: Floats,
    limit: float,
) -> None:
    """March from the vertices (k,) around a point."""
    for i in range(vertices.shape[0]):
        start_at(corners, front, vertices[i], distances[i], directions[i], 0.0)
    march(corners, front, bound, limit)
