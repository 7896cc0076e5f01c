"""Edge flips towards a Delaunay triangulation in space."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.topology.edges import edge_keys


def flip_towards_delaunay(v: Floats, f: Integers, passes: int = 12) -> Integers:
    """The faces after flipping edges whose opposite angles add to more than a half-turn, keeping a manifold."""
    for _ in range(passes):
        flipped = _flip_once(v, f)
        if flipped is None:
            break
        f = flipped
    return f


def _flip_once(v: Floats, f: Integers) -> Integers | None:
    """One round of flips, no two in one triangle, worst edges first; None where there is nothing to flip."""
    n = len(v)
    start, end, apex = (np.roll(f, -k, axis=1).ravel() for k in (1, 2, 0))  # half-edge opposite corner k of face
    face = np.repeat(np.arange(len(f)), 3)
    key, twin_key = start * n + end, end * n + start
    order = np.argsort(key)
    slot = np.searchsorted(key[order], twin_key).clip(max=len(key) - 1)
    twin = np.where(key[order][slot] == twin_key, order[slot], -1)
    a, b, c, d = v[start], v[end], v[apex], v[apex[twin]]
    excess = _angle(c, a, b) + _angle(d, a, b) - np.pi
    new_key = edge_keys(apex, apex[twin], n)
    fold = (np.cross(d - c, b - c) * np.cross(a - c, d - c)).sum(axis=1)  # both new triangles face the same way
    good = (twin >= 0) & (start < end) & (excess > 1e-6) & (fold > 0) & ~np.isin(new_key, edge_keys(start, end, n))
    candidates = np.flatnonzero(good)
    candidates = candidates[np.argsort(-excess[candidates], kind="stable")]
    candidates = candidates[np.sort(np.unique(new_key[candidates], return_index=True)[1])]
    best = np.full(len(f), len(candidates))
    rank = np.arange(len(candidates))
    np.minimum.at(best, face[candidates], rank)
    np.minimum.at(best, face[twin[candidates]], rank)
    chosen = candidates[(best[face[candidates]] == rank) & (best[face[twin[candidates]]] == rank)]
    if len(chosen) == 0:
        return None
    other = twin[chosen]
    flipped = f.copy()
    flipped[face[chosen]] = np.stack([apex[chosen], start[chosen], apex[other]], axis=1)
    flipped[face[other]] = np.stack([apex[other], end[chosen], apex[chosen]], axis=1)
    return flipped


def _angle(at: Floats, p: Floats, q: Floats) -> Floats:
    u, w = p - at, q - at
    return np.arctan2(np.linalg.norm(np.cross(u, w), axis=1), (u * w).sum(axis=1))
