"""Starts from eigenfunctions: alike up to sign and order on near-isometric surfaces."""

from __future__ import annotations

import itertools

import numpy as np

from geodesics.arrays import Integers
from gmds.spectral.sample_maps import SampledPair

FUNCTIONS = 5  # whose signs are tried: 32 starts an order; set by hand
CLOSE_VALUES = 0.25  # relative gap below which two eigenvalues may have changed places; set by hand
MOST_ORDERS = 4  # a bound on the time


def eigenfunction_signs(pair: SampledPair) -> list[Integers]:
    """One sample map for every choice of signs of the first five eigenfunctions, and of order where they are close.

    The functional map of an isometry is a signed permutation where eigenvalues are simple.

    Parameters
    ----------
    pair : SampledPair
        Both surfaces in one metric, p samples of the source and q of the target.

    Returns
    -------
    list of int64 arrays of shape (p,)
        Indices into the samples of the target: 32 for each of at most 4 orders; none where there are fewer than five
        eigenfunctions.

    References
    ----------
    Mateus, Horaud, Knossow, Cuzzolin, Boyer: Articulated shape matching using Laplacian eigenfunctions (2008).

    See Also
    --------
    extremities : The other start that needs nothing but the two surfaces.
    """
    count = min(FUNCTIONS, pair.source_rows.shape[1] - 1, pair.target_rows.shape[1] - 1)
    if count < FUNCTIONS:
        return []
    starts = []
    for order in _orders(pair, count):
        for signs in itertools.product((1.0, -1.0), repeat=count):
            matrix = np.zeros((count + 1, count + 1))
            matrix[0, 0] = np.sign(pair.source_rows[0, 0] * pair.target_rows[0, 0])
            matrix[np.arange(1, count + 1), np.array(order) + 1] = signs
            starts.append(pair.images(matrix))
    return starts


def _orders(pair: SampledPair, count: int) -> list[list[int]]:
    """The identity, and neighbours exchanged where eigenvalues of either surface are close: at most four orders."""
    orders = [list(range(count))]
    for i in range(count - 1):
        values = np.stack([pair.source.eigenvalues[i + 1 : i + 3], pair.target.eigenvalues[i + 1 : i + 3]])
        if ((values[:, 1] - values[:, 0]) < CLOSE_VALUES * values[:, 1]).any():
            for order in list(orders)[: MOST_ORDERS - len(orders)]:
                swapped = order.copy()
                swapped[i], swapped[i + 1] = swapped[i + 1], swapped[i]
                orders.append(swapped)
    return orders
