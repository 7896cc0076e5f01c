"""Principal components of deviations from a mean."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats

ALIKE = 1e-24  # share of the squares by which shapes differ that are one but for rounding: a bound, far above it
LEAST_VARIANCE = 1e-14  # share of the whole, below which a component is rounding: a bound


def principal_components(deviations: Floats, count: int | None = None) -> tuple[Floats, Floats]:
    """Variances (c,) and orthonormal components (c, d) of deviations (k, d) from their mean, c at most k - 1."""
    _, spread, axes = np.linalg.svd(deviations, full_matrices=False)
    variance = spread**2 / max(len(deviations) - 1, 1)
    kept = int((variance > LEAST_VARIANCE * max(variance.sum(), 1e-300)).sum())
    kept = min(kept, len(deviations) - 1, kept if count is None else count)
    axes = axes[:kept]
    axes *= np.sign(axes[np.arange(kept), np.abs(axes).argmax(axis=1)])[:, None]
    return variance[:kept], axes
