"""A skeleton moved into another body: each bone as the map moves the surface around it.

A joint keeps its place within the ring of surface around it, and a bone turns as the surface turns that it holds. Both
are similarities in the sense of least squares, of the surface where the map sends it to where it is. So a body that was
moved, turned or resized gets the skeleton moved, turned and resized, and the same body gets the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.arrays import Floats
from geodesics.io.gltf_nodes import local_matrix, world_matrices
from gmds.characters.scene import Scene

FAINT = 0.05  # of a vertex, that a bone must hold for the vertex to be asked about it; set by hand
NEAR = 0.1  # of the extent of what a bone holds: the least width of the ring around its joint; set by hand
PRIOR = 0.1  # how much the rotation of the bone above counts beside the surface, which counts 1; set by hand


@dataclass(frozen=True, eq=False)
class Similarity:
    """y = here + size * turn (x - there)."""

    there: Floats
    here: Floats
    turn: Floats
    size: float

    def __call__(self, place: Floats) -> Floats:
        """Where a place (3,) goes."""
        return np.asarray(self.here + self.size * self.turn @ (place - self.there), dtype=np.float64)


def similarity(there: Floats, here: Floats, mass: Floats, prior: Floats | None = None) -> Similarity:
    """The rotation and the size that bring points (p, 3) onto others, with masses (p,); near `prior`."""
    mass = mass / mass.sum()
    a, b = mass @ there, mass @ here
    x, y = there - a, here - b
    spread = float(mass @ (x**2).sum(axis=1)), float(mass @ (y**2).sum(axis=1))
    if min(spread) <= 0:
        return Similarity(a, b, np.eye(3) if prior is None else prior, 1.0)
    cross = np.einsum("p,pi,pj->ij", mass, y, x) / np.sqrt(spread[0] * spread[1])
    if prior is not None:
        cross += PRIOR * prior
    u, _, v = np.linalg.svd(cross)
    u[:, 2] *= np.linalg.det(u @ v)
    return Similarity(a, b, u @ v, float(np.sqrt(spread[1] / spread[0])))


def fitted(scene: Scene, weights: Floats, there: Floats, here: Floats, mass: Floats) -> dict[int, Floats]:
    """The transforms (4, 4) to the scene of all nodes, bones moved from the surface of the scene into another one.

    Parameters
    ----------
    scene : Scene
        Of b bones.
    weights : array of shape (p, b)
        How much each bone holds of points.
    there, here : array of shape (p, 3)
        The points on the surface of the scene, and on the other.
    mass : array of shape (p,)
        How much each point counts.

    Returns
    -------
    dict of int to float64 array of shape (4, 4)
        By node.
    """
    worlds = world_matrices(scene.gltf)
    above = {child: node for node in worlds for child in scene.gltf.item("nodes", node).get("children", [])}
    column = {bone: number for number, bone in enumerate(scene.bones)}
    whole = similarity(there, here, mass)
    moves: dict[int | None, Similarity] = {}
    result: dict[int, Floats] = {}
    for node, world in worlds.items():  # those above come first
        parent = above.get(node)
        if node not in column and parent not in moves:
            below = result[parent] @ local_matrix(scene.gltf.item("nodes", node)) if parent in result else world
            result[node] = below
            continue
        start = moves.get(parent, whole)
        family = [column[one] for one in (node, parent) if one in column]
        held = weights[:, family].sum(axis=1) if node in column else np.zeros(len(weights))
        moves[node] = start
        if node in column and (weights[:, column[node]] > FAINT).sum() >= 3:
            own = similarity(there, here, mass * weights[:, column[node]], start.turn)
            ring = _ring(there, world[:3, 3], mass * (held > FAINT))
            around = similarity(there, here, ring, own.turn)
            joint = world[:3, 3]
            moves[node] = Similarity(joint, around(joint), own.turn, own.size)
        moved = np.eye(4)
        moved[:3, :3] = moves[node].turn @ world[:3, :3]
        moved[:3, 3] = moves[node](world[:3, 3])
        result[node] = moved
    return result


def _ring(points: Floats, joint: Floats, mass: Floats) -> Floats:
    """Masses of points that fall with their distance from the joint, as wide as the nearest one is far."""
    used = np.flatnonzero(mass > 0)
    squares = ((points[used] - joint) ** 2).sum(axis=1)
    width = max(float(squares.min()), float((NEAR * np.ptp(points[used], axis=0).max()) ** 2))
    result = np.zeros(len(points))
    result[used] = mass[used] * np.exp((squares.min() - squares) / (2 * width))
    return result
