"""How well one surface lies on another after many similarities, and what each of them becomes by closest points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import inlined, njit
from geodesics.arrays import Bools, Floats
from gmds._kernels.rotations import nearest_rotations

Cells = NDArray[np.int32]
# What is known of a surface: points, normals and areas that it is judged by; cells of a box around it, their corner and
# step; vertices, normals, and which of them are at the boundary.
Side = tuple[Floats, Floats, Floats, Cells, Floats, float, Floats, Floats, Bools]


@inlined
def _vertex_near(point: Floats, cells: Cells, low: Floats, step: float) -> int:
    """The vertex that the cell of a point, or the outermost one towards it, names."""
    a = min(max(round((point[0] - low[0]) / step), 0), cells.shape[0] - 1)
    b = min(max(round((point[1] - low[1]) / step), 0), cells.shape[1] - 1)
    c = min(max(round((point[2] - low[2]) / step), 0), cells.shape[2] - 1)
    return cells[a, b, c]


@inlined
def _place(point: Floats, rotation: Floats, size: float, shift: Floats, place: Floats) -> None:
    """Where a similarity sends a point, into `place`."""
    for k in range(3):
        place[k] = point[0] * rotation[k, 0] + point[1] * rotation[k, 1] + point[2] * rotation[k, 2]
        place[k] = size * place[k] + shift[k]


@inlined
def _agreement(normal: Floats, rotation: Floats, direction: Floats) -> float:
    """The cosine of the angle between a rotated normal and another."""
    along = 0.0
    for k in range(3):
        turned = normal[0] * rotation[k, 0] + normal[1] * rotation[k, 1] + normal[2] * rotation[k, 2]
        along += turned * direction[k]
    return along


@inlined
def _squared_gap(place: Floats, other: Floats) -> float:
    """The square of the distance of two places."""
    gap = 0.0
    for k in range(3):
        gap += (place[k] - other[k]) ** 2
    return gap


@inlined
def _shift_back(inverse: Floats, size: float, shift: Floats, back: Floats) -> None:
    """The shift of the inverse of a similarity, of which `inverse` is the rotation, into `back`."""
    for k in range(3):
        back[k] = -(inverse[k, 0] * shift[0] + inverse[k, 1] * shift[1] + inverse[k, 2] * shift[2]) / size


@njit
def _cost(
    one: Side, other: Side, rotation: Floats, size: float, shift: Floats, reach: float, turn: float, missing: float
) -> float:
    points, normals, weights = one[0], one[1], one[2]
    cells, low, step, places, directions, edge = other[3], other[4], other[5], other[6], other[7], other[8]
    total = 0.0
    y = np.empty(3)
    for i in range(len(points)):
        _place(points[i], rotation, size, shift, y)
        near = _vertex_near(y, cells, low, step)
        if edge[near]:
            total += weights[i] * missing
            continue
        gap, along = _squared_gap(y, places[near]), _agreement(normals[i], rotation, directions[near])
        total += weights[i] * min(gap / reach**2 + turn * (1 - along), 1.0)
    return total


@njit
def alignment_costs(
    rotations: Floats,
    sizes: Floats,
    shifts: Floats,
    source: Side,
    target: Side,
    reach: float,
    turn: float,
    missing: float,
) -> Floats:
    """For each of k similarities what the surfaces cost, lying so, per area of both.

    A point costs min(gap^2 / `reach`^2 + `turn` (1 - cosine of the normals), 1) where the closest vertex of the other
    surface is inside it, `missing` where it is on the boundary.
    """
    costs = np.empty(len(rotations))
    back = np.empty(3)
    for j in range(len(rotations)):
        size, inverse = sizes[j], np.ascontiguousarray(rotations[j].T)
        _shift_back(inverse, size, shifts[j], back)
        there = _cost(source, target, rotations[j], size, shifts[j], reach, turn, missing)
        returned = _cost(target, source, inverse, 1 / size, back, reach / size, turn, missing)
        costs[j] = (size**2 * there + returned) / (size**2 + 1)
    return costs


@njit
def _gather(
    one: Side, other: Side, rotation: Floats, size: float, shift: Floats, reach: float, found: Floats, first: int
) -> int:
    """Rows (point, its closest one, weight) from `first` on of what lies within reach and faces the same way."""
    points, normals, weights = one[0], one[1], one[2]
    cells, low, step, places, directions, edge = other[3], other[4], other[5], other[6], other[7], other[8]
    y = np.empty(3)
    for i in range(len(points)):
        _place(points[i], rotation, size, shift, y)
        near = _vertex_near(y, cells, low, step)
        if edge[near]:
            continue
        gap, along = _squared_gap(y, places[near]), _agreement(normals[i], rotation, directions[near])
        if gap < reach**2 and along > 0:
            for k in range(3):
                found[first, k], found[first, 3 + k] = points[i, k], places[near, k]
            found[first, 6] = weights[i] * (1 - gap / reach**2) * along
            first += 1
    return first


@njit
def refined_alignments(
    rotations: Floats,
    sizes: Floats,
    shifts: Floats,
    source: Side,
    target: Side,
    reach: float,
    steps: int,
    least: float,
    most: float,
) -> None:
    """`steps` of closest points both ways for each similarity, in place: those within `reach`, inside either surface.

    Each step takes the similarity of least weighted squares between the pairs of points (Horn 1987), with a size from
    `least` to `most`.
    """
    n, m = len(source[0]), len(target[0])
    ours, theirs = np.empty((n + m, 7)), np.empty((m, 7))
    product, back = np.empty((1, 3, 3)), np.empty(3)
    a, b = np.empty(3), np.empty(3)
    for j in range(len(rotations)):
        for _ in range(steps):
            size, inverse = sizes[j], np.ascontiguousarray(rotations[j].T)
            _shift_back(inverse, size, shifts[j], back)
            count = _gather(source, target, rotations[j], size, shifts[j], reach, ours, 0)
            more = _gather(target, source, inverse, 1 / size, back, reach / size, theirs, 0)
            for i in range(more):
                ours[count, :3], ours[count, 3:6], ours[count, 6] = theirs[i, 3:6], theirs[i, :3], theirs[i, 6]
                count += 1
            if count < 4:
                break
            total, spread = 0.0, 0.0
            a[:], b[:] = 0.0, 0.0
            for i in range(count):
                total += ours[i, 6]
                for k in range(3):
                    a[k] += ours[i, 6] * ours[i, k]
                    b[k] += ours[i, 6] * ours[i, 3 + k]
            if total <= 0:
                break
            a /= total
            b /= total
            product[:] = 0.0
            for i in range(count):
                for k in range(3):
                    x = ours[i, k] - a[k]
                    spread += ours[i, 6] * x * x
                    for c in range(3):
                        product[0, k, c] += ours[i, 6] * x * (ours[i, 3 + c] - b[c])
            turned, sums = nearest_rotations(product)
            if spread <= 0:
                break
            rotations[j] = turned[0]
            sizes[j] = min(max(sums[0] / spread, least), most)
            for k in range(3):
                shifts[j, k] = b[k] - sizes[j] * (
                    rotations[j, k, 0] * a[0] + rotations[j, k, 1] * a[1] + rotations[j, k, 2] * a[2]
                )
