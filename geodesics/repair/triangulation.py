"""Even triangulations by edge collapse and edge flips."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.topology.components import boundary_vertices


def collapse(mesh: Mesh, n_vertices: int, *, adaptive: bool = False) -> tuple[Floats, Integers]:
    """Vertices (about n_vertices, 3) and faces of an even triangulation near the mesh, shortest edges collapsed first.

    `adaptive` collapses first what changes the surface least (quadric error, Garland and Heckbert 1997): triangles stay
    small where the surface is thin or sharply bent. Exactly `n_vertices` on a closed surface of genus 0. Afterwards
    edges are flipped towards Delaunay and vertices moved to the middle of their neighbours; they lie near the surface,
    not on it.
    """
    import igl

    closed_faces = mesh.n_faces - 2 * (mesh.n_vertices - n_vertices)
    vertices, faces = np.asfortranarray(mesh.vertices), np.asfortranarray(mesh.faces.astype(np.int32))
    if adaptive:
        size = np.ptp(vertices, axis=0).max()  # a surface of any size: quadrics are compared with absolute numbers
        v, f = igl.qslim(np.asfortranarray(vertices / size), faces, int(closed_faces))[:2]
        v = size * v
    else:
        v, f = igl.decimate(vertices, faces, int(closed_faces))[:2]
    v, f = np.ascontiguousarray(v), np.ascontiguousarray(f, dtype=np.int64)
    inside = ~boundary_vertices(Mesh(v, f))
    for _ in range(3):
        f = flip_towards_delaunay(v, f)
        v[inside] = SurfacePoints.closest(mesh, _towards_neighbours(v, f)[inside]).positions
    return v, flip_towards_delaunay(v, f)


def _towards_neighbours(v: Floats, f: Integers) -> Floats:
    """Vertices moved half way to the mean of the centres of their faces."""
    centres, count = np.zeros_like(v), np.bincount(f.ravel(), minlength=len(v))
    np.add.at(centres, f.ravel(), np.repeat(v[f].mean(axis=1), 3, axis=0))
    return 0.5 * (v + centres / np.maximum(count, 1)[:, None])


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
    known = np.concatenate([key, twin_key])
    new_key = np.minimum(apex, apex[twin]) * n + np.maximum(apex, apex[twin])
    fold = (np.cross(d - c, b - c) * np.cross(a - c, d - c)).sum(axis=1)  # both new triangles face the same way
    good = (twin >= 0) & (start < end) & (excess > 1e-6) & (fold > 0) & ~np.isin(new_key, known)
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
