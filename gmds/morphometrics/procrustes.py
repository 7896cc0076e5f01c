"""Generalised Procrustes superposition: configurations but for place, rotation and size; points may be missing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Bools, Floats
from geodesics.errors import BadArgument, BadShape

ROUNDS = 200  # a bound: 4 to 20 are needed
STILL = 1e-10  # change of the mean, over its centroid size, at which it has converged: near rounding
FEWEST = 3  # points that settle a rotation


class Similarity(NamedTuple):
    """x -> scale * x @ rotation + shift, rotation (3, 3) proper unless a reflection was allowed, shift (3,)."""

    scale: float
    rotation: Floats
    shift: Floats

    def __call__(self, points: Floats) -> Floats:
        """Points (p, 3) moved."""
        return np.asarray(self.scale * points @ self.rotation + self.shift, dtype=np.float64)

    @property
    def inverse(self) -> Similarity:
        """The way back."""
        return Similarity(1 / self.scale, self.rotation.T, -self.shift @ self.rotation.T / self.scale)


@dataclass(frozen=True, eq=False)
class Superposition:
    """Configurations laid upon each other.

    Attributes
    ----------
    aligned : float64 array of shape (k, n, 3)
        The configurations, moved; missing points are those of the mean.
    mean : float64 array of shape (n, 3)
        Their mean, of centroid size 1 where size was taken out, else of the mean centroid size.
    sizes : float64 array of shape (k,)
        Centroid sizes: the root of the summed squared distances from the centroid, in the units of the configurations;
        where points miss, of what is there, times what these are short of in the mean.
    distances : float64 array of shape (k,)
        From the mean: the root of the summed squared distances of the points, in the units of `aligned`.
    moves : tuple of Similarity
        What moves each.
    rounds : int
        How many it took.
    change : float
        Of the mean in the last round, over its centroid size.
    """

    aligned: Floats
    mean: Floats
    sizes: Floats
    distances: Floats
    moves: tuple[Similarity, ...]
    rounds: int
    change: float


def superimposed(
    configurations: ArrayLike, valid: ArrayLike | None = None, *, scale: bool = True, reflect: bool = False
) -> Superposition:
    """Configurations superimposed by generalised Procrustes analysis, and their mean (Gower 1975; Rohlf, Slice 1990).

    Each is turned onto the mean, in turn with the mean, until that rests. A missing point of a configuration has no
    say, neither in its place nor in the mean.

    Parameters
    ----------
    configurations : array_like of shape (k, n, 3)
        k configurations of n corresponding points.
    valid : array_like of bool, shape (k, n), optional
        False where a point is missing; all that are finite unless given.
    scale : bool
        Whether size is taken out; else only place and rotation.
    reflect : bool
        Whether a configuration may be mirrored.

    Returns
    -------
    Superposition
        The aligned configurations and their mean.

    Raises
    ------
    BadShape
        E108 for arrays of another shape.
    BadArgument
        E604 when a configuration has fewer than 3 points, or a point is in none of them.
    """
    x, there = _checked(configurations, valid)
    k = len(x)
    first = int(there.sum(axis=1).argmax())
    mean = x[first] - x[first][there[first]].mean(axis=0)
    mean = mean / (np.linalg.norm(mean[there[first]]) if scale else 1.0)
    known = there[first].copy()
    change = np.inf
    moves: list[Similarity] = []
    count = 0
    while change >= STILL and count < ROUNDS:
        count += 1
        moves = [fitted(x[i], mean, there[i] & known, scale=scale, reflect=reflect) for i in range(k)]
        aligned = np.stack([move(one) for move, one in zip(moves, x, strict=True)])
        new = (aligned * there[:, :, None]).sum(axis=0) / there.sum(axis=0)[:, None]
        new = new - new.mean(axis=0)
        if scale:
            new = new / np.linalg.norm(new)
        change = float(np.linalg.norm((new - mean)[known]) / np.linalg.norm(new)) if known.all() else np.inf
        mean, known = new, np.ones(len(new), dtype=bool)
    moves = [fitted(x[i], mean, there[i], scale=scale, reflect=reflect) for i in range(k)]
    aligned = np.stack([move(one) for move, one in zip(moves, x, strict=True)])
    aligned = np.where(there[:, :, None], aligned, mean)
    sizes = np.array([centroid_size(one, mask, mean) for one, mask in zip(x, there, strict=True)])
    distances = np.sqrt(((aligned - mean) ** 2).sum(axis=(1, 2)))
    return Superposition(aligned, mean, sizes, distances, tuple(moves), count, change)


def fitted(points: Floats, onto: Floats, used: Bools, *, scale: bool = True, reflect: bool = False) -> Similarity:
    """The similarity that brings the `used` (n,) of points (n, 3) closest to `onto` (n, 3) (Kabsch, Umeyama)."""
    x, y = points[used], onto[used]
    x0, y0 = x.mean(axis=0), y.mean(axis=0)
    u, stretch, vt = np.linalg.svd((x - x0).T @ (y - y0))
    sign = np.array([1.0, 1.0, 1.0 if reflect else (np.sign(np.linalg.det(u @ vt)) or 1.0)])
    rotation = (u * sign) @ vt
    spread = ((x - x0) ** 2).sum()
    factor = float((stretch * sign).sum() / spread) if scale and spread > 0 else 1.0
    return Similarity(factor, rotation, y0 - factor * x0 @ rotation)


def centroid_size(points: Floats, used: Bools, mean: Floats) -> float:
    """The centroid size of points (n, 3); where only some are `used` (n,), that of all as the mean has them."""
    size = float(np.linalg.norm(points[used] - points[used].mean(axis=0)))
    if used.all():
        return size
    share = np.linalg.norm(mean[used] - mean[used].mean(axis=0)) / np.linalg.norm(mean - mean.mean(axis=0))
    return size / float(share)


def _checked(configurations: ArrayLike, valid: ArrayLike | None) -> tuple[Floats, Bools]:
    """Configurations with 0 where nothing is, and where something is."""
    x = np.asarray(configurations, dtype=np.float64)
    if x.ndim != 3 or x.shape[2] != 3 or len(x) == 0:
        raise BadShape(f"configurations must have shape (k, n, 3), not {x.shape}")
    finite: Bools = np.asarray(np.isfinite(x).all(axis=2), dtype=np.bool_)
    there: Bools = finite if valid is None else finite & np.asarray(valid, dtype=np.bool_)
    few = np.flatnonzero(there.sum(axis=1) < FEWEST)
    if len(few):
        raise BadArgument(f"configuration {few[0]} has {there[few[0]].sum()} points; a rotation takes {FEWEST}")
    nowhere = np.flatnonzero(~there.any(axis=0))
    if len(nowhere):
        raise BadArgument(f"point {nowhere[0]} is missing in all configurations ({len(nowhere)} such); leave it out")
    return np.where(there[:, :, None], x, 0.0), there
