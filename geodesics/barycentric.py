"""The barycentric combination: what is given at three corners, at a point of the triangle."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats


def combination(weights: Floats, corners: Floats) -> Floats:
    """Values w_1 c_1 + w_2 c_2 + w_3 c_3 (p, ...) of weights (p, 3) and values at the corners (p, 3, ...)."""
    return np.einsum("pk,pk...->p...", weights, corners)
