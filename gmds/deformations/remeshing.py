"""Another triangulation of the same surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Integers
from geodesics.errors import BadArgument, NotManifold
from geodesics.repair.decimation import collapse
from gmds.deformations.noise import mean_edge_length


def remeshing(
    mesh: Mesh,
    n_vertices: int | None = None,
    *,
    adaptive: bool = False,
    remesher: Callable[[Mesh], Mesh] | None = None,
    rng: int = 0,
) -> tuple[Mesh, SurfacePoints]:
    """Another triangulation of the surface; the truth is the point of it closest to each old vertex.

    By default the mesh is subdivided until it has four times as many vertices as wanted, its vertices are shaken along
    the surface, and the shortest edges collapse. New triangles are chords of the old surface, so the truth is off by
    about (edge length)^2 / (8 curvature radius).

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    n_vertices : int, optional
        About how many vertices to make; as many as before by default.
    adaptive : bool
        Whether triangles are small where the surface is thin. Even triangles cut off what is thinner than they are
        wide, such as fingers.
    remesher : callable, optional
        Mesh -> Mesh, for instance ``lambda m: geodesics.repair.remesh(m, 5000)``, in place of all that.
    rng : int
        Seed of the random choices.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    Raises
    ------
    NotManifold
        E110 where sheets meet in an edge or a vertex.
    ValueError
        When fewer than 12 vertices are wanted.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> other, true = gmds.remeshing(animal, 150)
    >>> len(true), true.mesh is other  # a point of the other for each vertex
    (200, True)
    """
    mesh = Mesh.from_object(mesh)
    if remesher is not None:
        result = remesher(mesh)
        return result, SurfacePoints.closest(result, mesh.vertices)
    import igl

    wanted = mesh.n_vertices if n_vertices is None else n_vertices
    if wanted < 12:
        raise BadArgument(f"n_vertices must be at least 12, not {wanted}")
    vertices, faces = mesh.vertices, mesh.faces
    while _manifold(faces) and len(vertices) < 4 * wanted:
        vertices, faces = igl.upsample(vertices, faces, 1)
    if not _manifold(faces):
        raise NotManifold(
            "only a manifold surface can be remeshed; remove the faces or vertices where sheets meet, "
            "or remesh before they are glued"
        )
    fine = Mesh(vertices, faces)
    shaken = fine.vertices + np.random.default_rng(rng).normal(0, 0.2 * mean_edge_length(fine), fine.vertices.shape)
    fine = Mesh(SurfacePoints.closest(mesh, shaken).positions, fine.faces)
    new, faces = collapse(fine, wanted, adaptive=adaptive)
    result = Mesh(new, faces)
    return result, SurfacePoints.closest(result, mesh.vertices)


def _manifold(faces: Integers) -> bool:
    import igl

    return bool(igl.is_edge_manifold(faces)[0] and np.all(igl.is_vertex_manifold(faces)))
