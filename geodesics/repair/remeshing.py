"""New triangulations through pymeshlab: even ones, and holes closed."""

from __future__ import annotations

import numpy as np

from geodesics.errors import BadArgument, MeshError
from geodesics.mesh import Mesh
from geodesics.repair._meshlab import apply_filter
from geodesics.repair.decimation import center_and_size, refuse_branching
from geodesics.repair.repairing import repair


def remesh(mesh: Mesh, target_vertices: int, *, iterations: int = 10) -> Mesh:
    """A new triangulation of the same surface with nearly equilateral triangles.

    Isotropic explicit remeshing through pymeshlab; boundaries are kept, all vertices are new.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    target_vertices : int
        About how many vertices to make, at least 4.
    iterations : int
        Rounds of splitting, collapsing, flipping and smoothing.

    Returns
    -------
    Mesh
        The new mesh, repaired.

    Raises
    ------
    MissingExtra
        E602 when pymeshlab is not installed.
    MeshError
        When it fails.
    ValueError
        When `target_vertices` is less than 4.

    See Also
    --------
    decimate : Coarser without new positions for what stays, and with index arrays.
    """
    if target_vertices < 4:
        raise BadArgument(f"target_vertices must be at least 4, not {target_vertices}")
    center, size = center_and_size(mesh)
    unit = (mesh.vertices - center) / size
    a, b, c = unit[mesh.faces.T]
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    best, miss = (unit, mesh.faces), np.inf
    for near in (True, False):  # to stay near the surface can keep the mesh finer than wanted; then without
        length = np.sqrt(area / target_vertices * 2 / np.sqrt(3))  # an equilateral tiling has sqrt(3)/2 l^2 a vertex
        for _ in range(4):  # edges come out longer or shorter than the target: correct it and start again
            v, f = apply_filter(
                "meshing_isotropic_explicit_remeshing",
                unit,
                mesh.faces,
                targetlen=float(length),
                iterations=iterations,
                checksurfdist=near,
            )
            if abs(np.log(len(v) / target_vertices)) < miss:
                best, miss = (v, f), abs(np.log(len(v) / target_vertices))
            if miss < 0.05:
                break
            length *= np.sqrt(len(v) / target_vertices)
        if miss < 0.2:
            break
    v, f = best
    return repair(Mesh(v * size + center, f)).mesh


def fill_holes(mesh: Mesh, max_edges: int = 1000) -> Mesh:
    """The mesh with its holes closed by new faces, through pymeshlab.

    Vertices and existing faces stay as they are; the new faces come last.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    max_edges : int
        Boundary loops of more edges stay open.

    Returns
    -------
    Mesh
        The mesh with the new faces.

    Raises
    ------
    MissingExtra
        E602 when pymeshlab is not installed.
    NotManifold
        E110 for edges of more than two faces.
    MeshError
        When pymeshlab fails.
    """
    refuse_branching(mesh)
    center, size = center_and_size(mesh)
    unit = (mesh.vertices - center) / size
    below = int(max_edges) + 1  # meshlab closes holes of fewer edges than that
    v, f = apply_filter("meshing_close_holes", unit, mesh.faces, maxholesize=below, selfintersection=False)
    if len(v) != mesh.n_vertices or not np.array_equal(f[: mesh.n_faces], mesh.faces):
        raise MeshError("closing holes changed the vertices; repair the mesh first")
    return Mesh(mesh.vertices, f)
