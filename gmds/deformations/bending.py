"""Another pose: limbs bent with as little stretching as possible."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from geodesics import Mesh, SurfacePoints
from geodesics.topology.edge_paths import edge_distances
from gmds.deformations.fitting import fit
from gmds.deformations.limbs import extremities
from gmds.deformations.truths import moved


def bending(mesh: Mesh, angle: float = 30.0, *, count: int = 3, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Turn some limbs, with as little stretching as possible.

    The outer part of each limb is rotated about the limb's middle by a random axis; the rest follows so that edge
    lengths change as little as possible (see `gmds.deformations.fitting.fit`).

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    angle : float
        Degrees.
    count : int
        Limbs that are turned, at most.
    rng : int
        Seed of the random choices.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    See Also
    --------
    local_scaling : Limbs that grow.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> bent, true = gmds.bending(animal, 20.0)
    >>> bent.n_vertices, len(true)
    (200, 200)
    """
    mesh = Mesh.from_object(mesh)
    random = np.random.default_rng(rng)
    tips, middle = extremities(mesh)
    chosen = random.permutation(tips)[:count]
    from_middle = edge_distances(mesh, np.array([middle]))[0]
    reach = from_middle[tips].min() if len(tips) else 0.0
    handles = [np.flatnonzero(from_middle <= 0.3 * reach)]
    places = [mesh.vertices[handles[0]]]
    for tip, distance in zip(chosen, edge_distances(mesh, chosen), strict=True):
        length = distance[middle]
        outer = np.flatnonzero(distance <= 0.25 * length)
        band = np.flatnonzero(np.abs(distance / length - 0.45) < 0.05)
        pivot = mesh.vertices[band if len(band) else [tip]].mean(axis=0)
        axis = random.standard_normal(3)
        turn = Rotation.from_rotvec(np.radians(angle) * axis / np.linalg.norm(axis))
        handles.append(outer)
        places.append(pivot + turn.apply(mesh.vertices[outer] - pivot))
    everyone, first = np.unique(np.concatenate(handles), return_index=True)
    return moved(mesh, fit(mesh, np.zeros(mesh.n_vertices), everyone, np.concatenate(places)[first], iterations=60))
