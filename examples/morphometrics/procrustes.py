"""Generalised Procrustes superposition: configurations of landmarks but for place, size and rotation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUNDS = 100  # a bound
STILL = 1e-12  # change of the mean, whose size is 1, at which it has converged


def centroid_size(configuration: Array) -> float:
    """The root of the summed squared distances of landmarks (k, 3) from their centroid (Bookstein 1991)."""
    return float(np.linalg.norm(configuration - configuration.mean(axis=0)))


def fitted(configuration: Array, onto: Array) -> Array:
    """Landmarks (k, 3) moved, turned (never mirrored) and resized so that they lie closest to `onto` (k, 3).

    Rows of `configuration` that are NaN are missing: they have no say and stay NaN.
    """
    there = np.isfinite(configuration).all(axis=1)
    x, y = configuration[there], onto[there]
    x0, y0 = x.mean(axis=0), y.mean(axis=0)
    u, stretch, vt = np.linalg.svd((x - x0).T @ (y - y0))
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    scale = (stretch * sign).sum() / ((x - x0) ** 2).sum()
    return np.asarray(scale * (configuration - x0) @ (u * sign) @ vt + y0, dtype=np.float64)


def superimposed(configurations: Array) -> tuple[Array, Array]:
    """Configurations (s, k, 3) superimposed, and their mean (k, 3), of centroid size 1 (Gower 1975; Rohlf, Slice 1990).

    Each is brought to centroid size 1 and turned onto the mean, in turn with the mean, until that rests. Configurations
    with missing landmarks (NaN) have no say in the mean, and are fitted to it by those they have. Raises `ValueError`
    when fewer than two are complete.
    """
    whole = np.isfinite(configurations).all(axis=(1, 2))
    if whole.sum() < 2:
        raise ValueError("fewer than two specimens have all landmarks; there is no mean shape")
    aligned = np.stack([(one - one.mean(axis=0)) / centroid_size(one) for one in configurations[whole]])
    mean = aligned[0]
    for _ in range(ROUNDS):
        aligned = np.stack([_unit(fitted(one, mean)) for one in aligned])
        before, mean = mean, _unit(aligned.mean(axis=0))
        if np.abs(mean - before).max() < STILL:
            break
    result = np.stack([fitted(one, mean) for one in configurations])
    result[whole] = aligned
    return result, mean


def distances(aligned: Array, mean: Array) -> Array:
    """Procrustes distance (s,) of each superimposed configuration from the mean: root of the mean square, times root k.

    Of those with missing landmarks, by what they have.
    """
    return np.asarray(np.sqrt(np.nanmean(((aligned - mean) ** 2).sum(axis=2), axis=1) * mean.shape[0]))


def _unit(configuration: Array) -> Array:
    centred = configuration - configuration.mean(axis=0)
    return np.asarray(centred / np.linalg.norm(centred), dtype=np.float64)
