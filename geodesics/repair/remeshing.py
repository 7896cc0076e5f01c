"""New triangulations through pymeshlab: even ones, and holes closed."""

from __future__ import annotations

import numpy as np

from geodesics.errors import MeshError
from geodesics.mesh import Mesh
from geodesics.repair._meshlab import apply_filter
from geodesics.repair.decimation import center_and_size, refuse_branching
from geodesics.repair.repairing import repair


def remesh(mesh: Mesh, target_vertices: int, *, iterations: int = 10) -> Mesh:
    """A new triangulation of the same surface with nearly equilateral triangles and about `target_vertices` vertices.

    Isotropic explicit remeshing through pymeshlab; boundaries are kept, vertices are new ones. Raises `MissingExtra`
    when pymeshlab is not installed and `MeshError` when it fails.
    """
    if target_vertices < 4:
        raise ValueError(f"target_vertices must be at least 4, not {target_vertices}")
    center, size = center_and_size(mesh)
    unit = (mesh.vertices - center) / size
    a, b, c = unit[mesh.faces.T]
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    best, miss = (unit, mesh.faces), np.inf
    for near in (True, False):  # that it stays near the surface can keep the mesh finer than asked: then without
        length = np.sqrt(area / target_vertices * 2 / np.sqrt(3))  # an equilateral tiling has sqrt(3)/2 l^2 a vertex
        for _ in range(4):  # edges come out somewhat longer or shorter than asked: correct the length and start again
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
    """The mesh with every boundary loop of at most `max_edges` edges closed by new faces, through pymeshlab.

    Vertices and existing faces stay as they are; the new faces come last. Raises `MissingExtra`, and `NotManifold`
    (E110) for edges of more than two faces.
    """
    refuse_branching(mesh)
    center, size = center_and_size(mesh)
    unit = (mesh.vertices - center) / size
    below = int(max_edges) + 1  # meshlab closes holes of fewer edges than that
    v, f = apply_filter("meshing_close_holes", unit, mesh.faces, maxholesize=below, selfintersection=False)
    if len(v) != mesh.n_vertices or not np.array_equal(f[: mesh.n_faces], mesh.faces):
        raise MeshError("closing holes changed the vertices; repair the mesh first")
    return Mesh(mesh.vertices, f)
