"""Functional maps: a map of points as a small matrix between eigenfunctions, and back."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.threads import side_by_side

_BLOCK = 1 << 22  # entries of a distance matrix that a thread holds at a time: 16 MB in single precision
_NONE = np.empty(0, dtype=np.int64)


def functional_map(source_rows: Floats, target_rows: Floats) -> Floats:
    """The matrix C (k, l) with source_rows C = target_rows in the least-squares sense (Ovsjanikov et al. 2012).

    Rows are eigenfunctions at corresponding points, (p, k) of the source and (p, l) of the target: column j of C writes
    target function j, pulled back by the map, in source functions. A source point with row x is sent to the target
    point whose row y makes C y nearest to x, as in ZoomOut; y nearest to C^T x does much worse unless C is orthogonal.
    """
    return np.asarray(np.linalg.lstsq(source_rows, target_rows, rcond=None)[0], dtype=np.float64)


def nearest_rows(queries: Floats, rows: Floats, dtype: type[np.floating[Any]] = np.float32) -> Integers:
    """For each query (p, k) the index of the nearest row (n, k), by blocked matrix products.

    Single precision, the default, is twice as fast and now and then takes a row that is farther by a millionth of the
    largest norm: the other side of an ear.
    """
    r = rows.astype(dtype)
    q = np.hstack([queries, np.ones((len(queries), 1))]).astype(dtype)
    lifted = np.vstack([-r.T, 0.5 * np.einsum("ik,ik->i", r, r)])  # |r|^2 / 2 - q . r in one product
    step = max(1, _BLOCK // len(r))
    blocks = [slice(start, start + step) for start in range(0, len(q), step)]
    return np.concatenate([*side_by_side(lambda block: (q[block] @ lifted).argmin(axis=1), blocks), _NONE])


def spectral_upsampling(
    source_rows: Floats, target_functions: Floats, images: Integers, sizes: Iterable[int], goals: Integers
) -> tuple[Floats, Integers]:
    """Refine the images (p,) of p points with ever more eigenfunctions (ZoomOut; Melzi et al. 2019).

    `source_rows` (p, k) are eigenfunctions at the points, `target_functions` (n, k) at all target vertices, of which
    `goals` are those that points may be sent to. Returns the last functional map and the images it gives.
    """
    matrix, rows = np.empty((0, 0)), target_functions[goals]
    for k in sizes:
        matrix = functional_map(source_rows[:, :k], target_functions[images, :k])
        images = goals[nearest_rows(source_rows[:, :k], rows[:, :k] @ matrix.T)]
    return matrix, images
