"""Parts of built-in animals, with truth."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Integers
from gmds.shapes import Figure, quadruped, truth

FRONT, REAR = -0.6, 0.7  # along the body: behind that one the hind legs and tail, before this one the head


class Cut(NamedTuple):
    """A `part`, the vertices `kept` (p,) of a body; the `whole` in another pose; where the part is on it."""

    part: Mesh
    whole: Figure
    kept: Integers
    true: SurfacePoints


def cut(mesh: Mesh, vertices: Bools) -> tuple[Mesh, Integers]:
    """The faces of which all corners are among the vertices (n,), and the vertices (p,) that are on them."""
    kept, rows = np.unique(mesh.faces[vertices[mesh.faces].all(axis=1)], return_inverse=True)
    return Mesh(mesh.vertices[kept], rows.reshape(-1, 3)), kept


@functools.cache
def half_animal(n: int = 500) -> Cut:
    """The front of a standing animal, and all of a walking one that is triangulated in another way."""
    body, whole = quadruped(n_vertices=n), quadruped("walk", n_vertices=n, seed=1)
    part, kept = cut(body, body.vertices[:, 0] > -0.1)
    return Cut(part, whole, kept, truth(body, whole)[kept])


@functools.cache
def animal_on_half(n: int = 500) -> tuple[Integers, SurfacePoints]:
    """The vertices (q,) of the whole that lie on the part of `half_animal`, and where they are on it."""
    body, (part, whole, kept, _) = quadruped(n_vertices=n), half_animal(n)
    row = np.full(body.n_vertices, -1)
    row[kept] = np.arange(len(kept))
    true = truth(whole, body)
    there = np.flatnonzero((row[body.faces[true.face]] >= 0).all(axis=1))
    return there, SurfacePoints.closest(part, true[there].positions)


class TwoCuts(NamedTuple):
    """The `front` of an animal and the `rear` of another pose; vertices (k,) of the front and where they are there."""

    front: Mesh
    rear: Mesh
    there: Integers
    true: SurfacePoints


@functools.cache
def two_cuts(n: int = 500) -> TwoCuts:
    """The front of one and the rear of the other, in another pose: they have the trunk and its legs in common."""
    standing, walking = quadruped(n_vertices=n), quadruped("walk", n_vertices=n, seed=1)
    front, kept = cut(standing, standing.vertices[:, 0] > FRONT)
    rear, kept_rear = cut(walking, walking.vertices[:, 0] < REAR)
    row = np.full(walking.n_vertices, -1)
    row[kept_rear] = np.arange(len(kept_rear))
    true = truth(standing, walking)[kept]
    there = np.flatnonzero((row[walking.faces[true.face]] >= 0).all(axis=1))
    return TwoCuts(front, rear, there, SurfacePoints.closest(rear, true[there].positions))
