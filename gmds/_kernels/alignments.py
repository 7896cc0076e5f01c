"""How well one surface lies on another after many similarities, and what each of them becomes by closest points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics._kernels.jit import inlined, njit
from geodesics.arrays import Bools, Floats
from gmds._kernels.rotations import nearest_rotations

Cells = NDArray[np.int32]


@inlined
def _vertex_near(point: Floats, cells: Cells, low: Floats, step: float) -> int:
    """The vertex that the cell of a point, or the outermost one towards it, names."""
    a = min(max(round((point[0] - low[0]) / step), 0), cells.shape[0] - 1)
    b = min(max(round((point[1] - low[1]) / step), 0), cells.shape[1] - 1)
    c = min(max(round((point[2] - low[2]) / step), 0), cells.shape[2] - 1)
    return cells[a, b, c]


@njit
def _cost(
    points: Floats,
    normals: Floats,
    weights: Floats,
    rotation: Floats,
    size: float,
    shift: Floats,
    cells: Cells,
    low: Floats,
    step: float,
    places: Floats,
    directions: Floats,
    edge: Bools,
    reach: float,
    turn: float,
    missing: float,
) -> float:
    total = 0.0
    y, m = np.empty(3), np.empty(3)
    for i in range(len(points)):
        for k in range(3):
            m[k] = normals[i, 0] * rotation[k, 0] + normals[i, 1] * rotation[k, 1] + normals[i, 2] * rotation[k, 2]
            y[k] = points[i, 0] * rotation[k, 0] + points[i, 1] * rotation[k, 1] + points[i, 2] * rotation[k, 2]
            y[k] = size * y[k] + shift[k]
        near = _vertex_near(y, cells, low, step)
        if edge[near]:
            total += weights[i] * missing
            continue
        gap, along = 0.0, 0.0
        for k in range(3):
            gap += (y[k] - places[near, k]) ** 2
            along += m[k] * directions[near, k]
        total += weights[i] * min(gap / reach**2 + turn * (1 - along), 1.0)
    return total


@njit
def alignment_costs(
    rotations: Floats,
    sizes: Floats,
    shifts: Floats,
    source: tuple[Floats, Floats, Floats, Cells, Floats, float, Floats, Floats, Bools],
    target: tuple[Floats, Floats, Floats, Cells, Floats, float, Floats, Floats, Bools],
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
    xs, ns, ws, cells_s, low_s, step_s, places_s, directions_s, edge_s = source
    xt, nt, wt, cells_t, low_t, step_t, places_t, directions_t, edge_t = target
    for j in range(len(rotations)):
        size, inverse = sizes[j], np.ascontiguousarray(rotations[j].T)
        for k in range(3):
            back[k] = (
                -(inverse[k, 0] * shifts[j, 0] + inverse[k, 1] * shifts[j, 1] + inverse[k, 2] * shifts[j, 2]) / size
            )
        there = _cost(
            xs, ns, ws, rotations[j], size, shifts[j],
            cells_t, low_t, step_t, places_t, directions_t, edge_t, reach, turn, missing,
        )  # fmt: skip
        returned = _cost(
            xt, nt, wt, inverse, 1 / size, back,
            cells_s, low_s, step_s, places_s, directions_s, edge_s, reach / size, turn, missing,
        )  # fmt: skip
        costs[j] = (size**2 * there + returned) / (size**2 + 1)
    return costs


@njit
def _gather(
    points: Floats,
    normals: Floats,
    weights: Floats,
    rotation: Floats,
    size: float,
    shift: Floats,
    cells: Cells,
    low: Floats,
    step: float,
    places: Floats,
    directions: Floats,
    edge: Bools,
    reach: float,
    found: Floats,
    first: int,
) -> int:
    """Rows (point, its closest one, weight) from `first` on of what lies within reach and faces the same way."""
    y = np.empty(3)
    for i in range(len(points)):
        for k in range(3):
            y[k] = points[i, 0] * rotation[k, 0] + points[i, 1] * rotation[k, 1] + points[i, 2] * rotation[k, 2]
            y[k] = size * y[k] + shift[k]
        near = _vertex_near(y, cells, low, step)
        if edge[near]:
            continue
        gap, along = 0.0, 0.0
        for k in range(3):
            m = normals[i, 0] * rotation[k, 0] + normals[i, 1] * rotation[k, 1] + normals[i, 2] * rotation[k, 2]
            along += m * directions[near, k]
            gap += (y[k] - places[near, k]) ** 2
        weight = weights[i] * (1 - gap / reach**2) * along
        if gap < reach**2 and along > 0:
            for k in range(3):
                found[first, k], found[first, 3 + k] = points[i, k], places[near, k]
            found[first, 6] = weight
            first += 1
    return first


@njit
def refined_alignments(
    rotations: Floats,
    sizes: Floats,
    shifts: Floats,
    source: tuple[Floats, Floats, Floats, Cells, Floats, float, Floats, Floats, Bools],
    target: tuple[Floats, Floats, Floats, Cells, Floats, float, Floats, Floats, Bools],
    reach: float,
    steps: int,
    least: float,
    most: float,
) -> None:
    """`steps` of closest points both ways for each similarity, in place: those within `reach`, inside either surface.

    Each step takes the similarity of least weighted squares between the pairs of points (Horn 1987), with a size from
    `least` to `most`.
    """
    xs, ns, ws, cells_s, low_s, step_s, places_s, directions_s, edge_s = source
    xt, nt, wt, cells_t, low_t, step_t, places_t, directions_t, edge_t = target
    ours, theirs = np.empty((len(xs) + len(xt), 7)), np.empty((len(xt), 7))
    product, back = np.empty((1, 3, 3)), np.empty(3)
    a, b = np.empty(3), np.empty(3)
    for j in range(len(rotations)):
        for _ in range(steps):
            size, inverse = sizes[j], np.ascontiguousarray(rotations[j].T)
            for k in range(3):
                back[k] = (
                    -(inverse[k, 0] * shifts[j, 0] + inverse[k, 1] * shifts[j, 1] + inverse[k, 2] * shifts[j, 2]) / size
                )
            count = _gather(
                xs, ns, ws, rotations[j], size, shifts[j],
                cells_t, low_t, step_t, places_t, directions_t, edge_t, reach, ours, 0,
            )  # fmt: skip
            more = _gather(
                xt, nt, wt, inverse, 1 / size, back,
                cells_s, low_s, step_s, places_s, directions_s, edge_s, reach / size, theirs, 0,
            )  # fmt: skip
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
                    for m in range(3):
                        product[0, k, m] += ours[i, 6] * x * (ours[i, 3 + m] - b[m])
            turned, sums = nearest_rotations(product)
            if spread <= 0:
                break
            rotations[j] = turned[0]
            sizes[j] = min(max(sums[0] / spread, least), most)
            for k in range(3):
                shifts[j, k] = b[k] - sizes[j] * (
                    rotations[j, k, 0] * a[0] + rotations[j, k, 1] * a[1] + rotations[j, k, 2] * a[2]
                )
