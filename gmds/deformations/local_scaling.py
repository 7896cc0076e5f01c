"""Parts that grow and shrink: an isotropic, inhomogeneous field of scale."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats
from geodesics.errors import BadShape
from geodesics.one_ring import one_ring_areas
from geodesics.topology.edge_paths import edge_distances
from gmds.deformations.fitting import fit
from gmds.deformations.limbs import extremities
from gmds.deformations.truths import moved


def local_scaling(mesh: Mesh, log_scale: ArrayLike) -> tuple[Mesh, SurfacePoints]:
    r"""Scale the surface differently from place to place: the local scales of the experiments (sec. 5, Fig. 2).

    Edge ij becomes as nearly as possible in space

    .. math:: l_{ij} \exp \frac{u_i + u_j}{2}

    long. In general no surface in space has exactly these lengths: `achieved_log_scale` measures the result. A constant
    u is a similarity, exactly.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    log_scale : array_like of shape (n,)
        u, the natural logarithm of the wanted scale at each vertex.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    Raises
    ------
    BadShape
        E108 when u has another shape or is not finite.

    See Also
    --------
    branch_log_scale : A field u that makes limbs grow.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> import numpy as np
    >>> head = animal.vertices[:, 0] > 0.8
    >>> grown, true = gmds.local_scaling(animal, np.where(head, np.log(2), 0))
    >>> bool(grown.area > animal.area)
    True
    """
    mesh = Mesh.from_object(mesh)
    u = np.asarray(log_scale, dtype=np.float64)
    if u.shape != (mesh.n_vertices,) or not np.isfinite(u).all():
        raise BadShape(f"log_scale must be {mesh.n_vertices} finite numbers, one per vertex; its shape is {u.shape}")
    centre = mesh.vertices.mean(axis=0)
    base = u.mean()  # the uniform part is applied exactly, and only the rest is fitted
    none = np.zeros(0, dtype=np.int64)
    shape = fit(mesh, u - base, none, np.zeros((0, 3)), iterations=200)
    return moved(mesh, centre + np.exp(base) * (shape - centre))


def achieved_log_scale(before: Mesh, after: Mesh) -> Floats:
    """Half the logarithm of the growth of the area around each vertex.

    Parameters
    ----------
    before, after : Mesh
        Two meshes of n vertices with the same faces.

    Returns
    -------
    array of shape (n,)
        The logarithm of the local scale.

    Raises
    ------
    BadShape
        E108 when the faces differ.
    """
    if not np.array_equal(before.faces, after.faces):
        raise BadShape("the two meshes must have the same faces")
    return 0.5 * np.log(one_ring_areas(after) / one_ring_areas(before))


def branch_log_scale(mesh: Mesh, factor: float, *, count: int = 2, reach: float = 0.5, rng: int = 0) -> Floats:
    """A smooth field of scale for `local_scaling`: some limbs grow, every second of them shrinks.

    The field falls from its full value at the tip of a limb to zero over `reach` times the distance to the middle of
    the surface; fields that overlap add up. The limbs are chosen at random.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    factor : float
        Scale at the tips, or its inverse; positive.
    count : int
        Limbs.
    reach : float
        Share of the distance to the middle.
    rng : int
        Seed of the random choices.

    Returns
    -------
    array of shape (n,)
        The natural logarithm of the scale.
    """
    mesh = Mesh.from_object(mesh)
    tips, middle = extremities(mesh)
    chosen = np.random.default_rng(rng).permutation(tips)[:count]
    u = np.zeros(mesh.n_vertices)
    for sign, tip in zip(np.resize([1, -1], len(chosen)), chosen, strict=True):
        distance = edge_distances(mesh, np.array([tip]))[0]
        t = (distance / (reach * distance[middle])).clip(0.5, 1.5) - 0.5
        u += sign * np.log(factor) * (1 - t * t * (3 - 2 * t))
    return u
