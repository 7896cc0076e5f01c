"""The whole surface larger or smaller."""

from __future__ import annotations

from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument
from gmds.deformations.truths import moved


def global_scale(mesh: Mesh, factor: float) -> tuple[Mesh, SurfacePoints]:
    """Scale the whole surface about the origin.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    factor : float
        Positive.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    Raises
    ------
    ValueError
        When the factor is not positive.

    See Also
    --------
    similarity : With a rotation and a translation.
    local_scaling : From place to place differently.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> larger, true = gmds.global_scale(animal, 2.0)
    >>> float(round(larger.area / animal.area, 6))
    4.0
    """
    mesh = Mesh.from_object(mesh)
    if not factor > 0:
        raise BadArgument(f"factor must be positive, not {factor}")
    return moved(mesh, factor * mesh.vertices)
