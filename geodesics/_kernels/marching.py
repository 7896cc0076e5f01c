"""The marching front. Arrays leave their tuples before the loops, as counting references is slow."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from geodesics._kernels.jit import inlined, njit, uncounted
from geodesics.arrays import Bools, Floats, Integers

Pair = tuple[float, float]
Table = tuple[Integers, Integers, Floats]
Triple = tuple[float, float, float]

UNSEEN, ACCEPTED = -1, -2  # in place of a position in the heap
HALF_GAP = 500.0  # radians: directions further apart belong to different fans; half of `flips.FAN_GAP`
ALONG = -math.inf  # in place of a direction: along the edge from a neighbour, computed when it is needed
VISITS = 20  # times that a vertex may be accepted: a bound that ends the loop; on published meshes there were at most 8


class Corners(NamedTuple):
    """The corners of all faces, grouped by vertex: those of v are rows start[v] to start[v + 1].

    In a row, `ends` are the next and the previous vertex of the face, `shape` the lengths of the edges to them, cosine
    and sine of the angle between, the directions at v of next and previous, and the directions of v at each of them;
    `slowness` is that of the face.
    """

    start: Integers
    ends: Integers
    shape: Floats
    slowness: Floats


class Front(NamedTuple):
    """A moving front; row v of `state` (n, 6) is distance, direction back, and offset of the source at vertex v,
    then three constants: whole angle, slowness, and how far beyond `nearest` the front may go.

    `position` (n,) is the place in the heap, `visits` (n,) how often a vertex was accepted, `heap` and `keys` (n,) are
    a binary heap, `touched` (n,) lists the vertices ever reached, and `sizes` (2,) counts the last two.
    """

    state: Floats
    position: Integers
    visits: Integers
    heap: Integers
    keys: Floats
    touched: Integers
    sizes: Integers


class Until(NamedTuple):
    """Where a front stops: at vertices farther than nearest (n,) by more than their margin, at distance `limit`, or
    `margin` after the last of the `missing` vertices marked in wanted (n,)."""

    nearest: Floats
    wanted: Bools
    missing: int
    limit: float
    margin: float


@inlined
def _rise(heap: Integers, keys: Floats, position: Integers, i: int, v: int, key: float) -> None:
    """Put v into the heap at place i or nearer the top."""
    while i > 0:
        parent = (i - 1) >> 1
        if keys[parent] <= key:
            break
        heap[i], keys[i] = heap[parent], keys[parent]
        position[heap[i]] = i
        i = parent
    heap[i], keys[i], position[v] = v, key, i


@inlined
def _sink(heap: Integers, keys: Floats, position: Integers, size: int) -> None:
    """Put the last of size + 1 entries in the place of the first, and down from there."""
    v, key, i = heap[size], keys[size], 0
    while 2 * i + 1 < size:
        child = 2 * i + 1
        if child + 1 < size and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        heap[i], keys[i] = heap[child], keys[child]
        position[heap[i]] = i
        i = child
    heap[i], keys[i], position[v] = v, key, i


@njit
def _turn(arrival: float, along: float, whole: float) -> float:
    """The angle from direction `along` to `arrival`, positive anticlockwise, nan where it is not known."""
    turn = arrival - along
    if abs(turn) > 0.5 * whole:
        turn -= math.copysign(whole, turn)
    return turn if abs(turn) < HALF_GAP else math.nan


@njit
def _alone(d: float, p: float, length: float, x: float, y: float) -> Pair:
    """As `_cross`, from the distance d and slope p at the near end of the edge alone."""
    if not abs(p) < 1.0:
        return math.inf, 0.0
    xs, ys = -p * d, d * math.sqrt(1.0 - p * p)
    at = xs + (x - xs) * (ys / (ys + y))
    return (math.sqrt((x - xs) * (x - xs) + (y + ys) * (y + ys)), at) if 0.0 < at < length else (math.inf, 0.0)


@njit
def _cross(ends: Pair, slopes: Pair, weights: Pair, length: float, x: float, y: float) -> Pair:
    """Distance at (x, y), y > 0, behind the edge from (0, 0) to (length, 0), and where on the edge its path crosses;
    inf where the path misses the edge, or the edge is longer than a way over the source.

    `ends` are the distances d0, d1 at the ends of the edge, `slopes` their derivatives along it (nan: not known), and
    `weights` the cost per length of the path from either end to (x, y), near 1. The source is unfolded into the plane
    at those distances (Novotni, Klein 2002). The cubic that corrects its slopes at the ends is added to the distance
    along the edge, to fourth order, and the crossing moved by one Newton step.
    """
    (d0, d1), (p0, p1), (w0, w1) = ends, slopes, weights
    xs = 0.5 * (length + (d0 - d1) * (d0 + d1) / length)
    ys = math.sqrt(max((d0 - xs) * (d0 + xs), 0.0))
    m0 = p0 + xs / d0 if d0 > 0.0 and p0 == p0 else 0.0
    m1 = p1 - (length - xs) / d1 if d1 > 0.0 and p1 == p1 else 0.0
    if m0 - m1 > 0.5:  # two waves meet on the edge
        near, far = _alone(d0, p0, length, x, y), _alone(d1, -p1, length, length - x, y)
        return near if near[0] < far[0] else (far[0], length - far[1])
    at = xs + (x - xs) * (ys / (ys + y))
    if not 0.0 < at < length or d0 + d1 < length * (1.0 - 1e-9):
        return math.inf, 0.0
    t, w = at / length, w0 + (w1 - w0) * at / length
    if ys > 0.0:  # else the source is on the edge
        r0, r1 = math.sqrt((at - xs) * (at - xs) + ys * ys), math.sqrt((at - x) * (at - x) + y * y)
        tilt = (at - xs) / r0 + w * (at - x) / r1 + r1 * (w1 - w0) / length
        tilt += m0 * (1.0 - t) * (1.0 - 3.0 * t) + m1 * t * (3.0 * t - 2.0)
        plain = ys * ys / (r0 * r0 * r0) + w * y * y / (r1 * r1 * r1)
        bend = max(plain + (m0 * (6.0 * t - 4.0) + m1 * (6.0 * t - 2.0)) / length, 0.2 * plain)
        at -= tilt / bend
        if not 0.0 < at < length:  # round an end of the edge, which is as long as along the other edge from there
            return math.inf, 0.0
    t, w = at / length, w0 + (w1 - w0) * at / length
    r0, r1 = math.sqrt((at - xs) * (at - xs) + ys * ys), math.sqrt((at - x) * (at - x) + y * y)
    return r0 + w * r1 + length * t * (1.0 - t) * (m0 * (1.0 - t) - m1 * t), at


@inlined
def _inward(table: Table, state: Floats, v: int, u: int, along: float, sign: int) -> float:
    """The angle at v from the edge to u, of direction `along`, to the way back: positive on the side of the face.

    When the path arrived by a fan of faces without this edge it passes through the vertex, which counts as pi; when
    the edge has more than two faces, and the path came by another of them, the angle is found there.
    """
    arrival, whole = state[v, 1], state[v, 3]
    turn = _turn(arrival, along, whole)
    if turn == turn or arrival != arrival:
        return sign * turn
    turn = math.pi
    start, ends, shape = table
    for q in range(start[v], start[v + 1]):
        for side in range(2):
            if ends[q, side] == u and abs(arrival - shape[q, 4 + side]) < HALF_GAP:
                turn = min(turn, abs(arrival - shape[q, 4 + side]))
    return -turn


@inlined
def _through(table: Table, state: Floats, slow: float, q: int, side: int, v: int, a: int, c: int) -> Triple:
    """Distance, direction back and offset of the source at c, over the face of corner q and its edge from v to a."""
    shape = table[2]
    along, across = slow * shape[q, side], slow * shape[q, 1 - side]
    x, y = across * shape[q, 2], across * shape[q, 3]
    ratio = 1.0 / slow
    s0, s1, s2 = ratio * state[v, 4], ratio * state[a, 4], ratio * state[c, 4]
    offset = min(state[v, 2], state[a, 2])
    ends = (state[v, 0] - offset, state[a, 0] - offset)
    t0 = _inward(table, state, v, a, shape[q, 4 + side], 1 - 2 * side)
    t1 = _inward(table, state, a, v, shape[q, 6 + side], 2 * side - 1)
    if (0.0 < t0 < math.pi and 0.0 < t1 < math.pi) or v == a:  # both are reached from this side of the edge
        return math.inf, 0.0, 0.0
    p0, p1 = -s0 * math.cos(min(abs(t0), math.pi)), s1 * math.cos(min(abs(t1), math.pi))
    reach, at = _cross(ends, (p0, p1), (0.5 * (s0 + s2), 0.5 * (s1 + s2)), along, x, y)
    if not reach + offset < state[c, 0]:
        return math.inf, 0.0, 0.0
    angle = math.atan2(y * at, x * (x - at) + y * y)
    if s0 != s1 or s0 != s2:  # rays turn towards the slow side: half of it falls behind the middle of the path
        sx = (s1 - s0) / along
        sy = (s2 - s0 - sx * x) / y
        angle += 0.5 * (sy * (x - at) - sx * y) / s2
    return reach + offset, shape[q, 7 - side] + (1 - 2 * side) * angle, offset


@njit
def _modulo(direction: float, whole: float) -> float:
    """A direction taken into [0, whole)."""
    if direction < 0.0 and whole < HALF_GAP:
        return direction + whole
    return direction - whole if direction >= whole else direction


@inlined
def _behind(shape: Floats, q: int, side: int, edge: float, distance: float) -> bool:
    """True when the far vertex of corner q's face, nearer than v, cannot be lowered through the edge on this `side`.

    That edge and the source must lie on v's side of the middle between v and the far vertex: an acute angle there
    is enough for a source at infinity, and near ones are excluded by their distance.
    """
    along, across = shape[q, side], shape[q, 1 - side]
    return 2.0 * (across - along * shape[q, 2]) * (distance - edge) >= edge * (along + across)


@inlined
def _beside(table: Table, state: Floats, v: int) -> float:
    """The direction back from v, reached along an edge, to the source as seen from the start of that edge.

    It is the edge's own for a path that goes straight on, or past a saddle or border. Otherwise a shorter path that is
    found later runs beside the edge, and this is its direction.
    """
    start, ends, shape = table
    for q in range(start[v], start[v + 1]):
        for side in range(2):
            u = ends[q, side]
            edge = 0.5 * (state[u, 4] + state[v, 4]) * shape[q, side]
            if state[u, 0] + edge == state[v, 0]:
                turn, distance = _turn(state[u, 1], shape[q, 6 + side], state[u, 3]), state[u, 0] - state[u, 2]
                if not abs(turn) < math.pi or not distance > 0.0:
                    return shape[q, 4 + side]
                angle = math.atan2(distance * math.sin(abs(turn)), edge - distance * math.cos(turn))
                return _modulo(shape[q, 4 + side] - math.copysign(angle, turn), state[v, 3])
    return math.nan


@uncounted
def march(corners: Corners, front: Front, until: Until) -> None:
    """Accept the vertices of the heap in order of distance, each advancing the front over the faces around it.

    A vertex accepted too soon, which happens behind obtuse angles, is lowered and accepted again.
    """
    start, ends, shape, slowness = corners.start, corners.ends, corners.shape, corners.slowness
    table = (start, ends, shape)
    state, position, visits, heap, keys = front.state, front.position, front.visits, front.heap, front.keys
    touched, sizes, nearest, wanted = front.touched, front.sizes, until.nearest, until.wanted
    size, reached, missing, limit = sizes[0], sizes[1], until.missing, until.limit
    while size > 0 and keys[0] <= limit:
        v = heap[0]
        size -= 1
        _sink(heap, keys, position, size)
        position[v] = ACCEPTED
        visits[v] += 1
        dv = state[v, 0]
        if state[v, 1] == ALONG:
            state[v, 1] = _beside(table, state, v)
        if wanted[v] and visits[v] == 1:
            missing -= 1
            limit = min(limit, dv + until.margin) if missing == 0 else limit
        if dv > nearest[v] + state[v, 5]:
            continue
        late = False
        for again in range(2):  # accepted vertices are lowered last, so that the order of faces does not matter
            if again and not late:
                break
            for q in range(start[v], start[v + 1]):
                for side in range(2):
                    a, c = ends[q, side], ends[q, 1 - side]
                    place = position[c]
                    edge = 0.5 * (state[v, 4] + state[c, 4]) * shape[q, 1 - side]
                    if place == ACCEPTED and state[c, 0] <= dv and _behind(shape, q, side, edge, dv - state[v, 2]):
                        continue
                    if again and visits[c] == 0:
                        continue
                    if place == ACCEPTED and not again:
                        late = True
                        continue
                    new, direction, offset = dv + edge, ALONG, state[v, 2]
                    if position[a] == ACCEPTED:
                        other, turned, source = _through(table, state, slowness[q], q, side, v, a, c)
                        if other < new:
                            new, direction, offset = other, _modulo(turned, state[c, 3]), source
                    gain = state[c, 0] - new
                    if not gain > 0.0 or (place == ACCEPTED and (visits[c] >= VISITS or gain < 1e-7 * edge)):
                        continue
                    state[c, 0], state[c, 1], state[c, 2] = new, direction, offset
                    if place == UNSEEN:
                        touched[reached] = c
                        reached += 1
                    if place < 0:
                        place = size
                        size += 1
                    _rise(heap, keys, position, place, c, new)
    sizes[0], sizes[1] = size, reached


@njit
def begin(front: Front, vertices: Integers, spokes: Floats, offset: float) -> None:
    """Put the vertices (k,) around a source on the front; spokes (k, 2) are distance and direction back to it."""
    state, position, heap, keys = front.state, front.position, front.heap, front.keys
    touched, sizes = front.touched, front.sizes
    for i in range(vertices.shape[0]):
        v, distance = vertices[i], offset + spokes[i, 0]
        if distance < state[v, 0]:
            state[v, 0], state[v, 1], state[v, 2] = distance, spokes[i, 1], offset
            place = position[v]
            if place < 0:
                place = sizes[0]
                sizes[0] += 1
                touched[sizes[1]] = v
                sizes[1] += 1
            _rise(heap, keys, position, place, v, distance)


@njit
def _wipe(front: Front) -> None:
    """Forget what was reached."""
    for i in range(front.sizes[1]):
        v = front.touched[i]
        front.state[v, 0], front.position[v], front.visits[v] = math.inf, UNSEEN, 0
    front.sizes[:] = 0


@njit
def finish(front: Front, out: Floats) -> None:
    """Copy the distances of accepted vertices to out (n,), and wipe the front."""
    for i in range(front.sizes[1]):
        v = front.touched[i]
        if front.position[v] == ACCEPTED:
            out[v] = front.state[v, 0]
    _wipe(front)


@njit
def finish_closer(front: Front, nearest: Floats) -> tuple[Integers, Floats]:
    """The accepted vertices that are closer than nearest (n,), and their distances; and wipe the front."""
    closer, distances = np.empty(front.sizes[1], dtype=np.int64), np.empty(front.sizes[1])
    count = 0
    for i in range(front.sizes[1]):
        v = front.touched[i]
        if front.position[v] == ACCEPTED and front.state[v, 0] < nearest[v]:
            closer[count], distances[count] = v, front.state[v, 0]
            count += 1
    _wipe(front)
    return closer[:count].copy(), distances[:count].copy()
