"""One surface at 5 thousand to a million vertices, made once and kept: a TOSCA horse, remeshed and subdivided."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, read_mesh

DATA = Path(os.environ.get("GMDS_DATA", "."))
SIZES = {"5k": 5_000, "44k": 44_000, "132k": 132_000, "528k": 528_000, "1M": 1_000_000}
"""Vertices aimed at. 5k is a published mesh of slivers (tosca_5k/cat0); the last two are the finer of two remeshed ones
after one Loop subdivision."""

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]


def mesh_path(size: str, folder: Path) -> Path:
    """The file of a mesh, made if it is not there."""
    if size == "5k":
        return DATA / "tosca_5k" / "cat0.off"
    path = folder / f"{size}.npz"
    if not path.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        vertices, faces = _subdivided(SIZES[size]) if SIZES[size] > 200_000 else remeshed(SIZES[size])
        np.savez(path, vertices=vertices, faces=faces)
    return path


def load(path: Path) -> Mesh:
    """The mesh of a file."""
    if path.suffix != ".npz":
        return read_mesh(path)
    with np.load(path) as arrays:
        return Mesh(arrays["vertices"], arrays["faces"])


def remeshed(target: int) -> Arrays:
    """About `target` vertices: the horse, subdivided at its midpoints and remeshed isotropically."""
    import pymeshlab

    original = read_mesh(DATA / "tosca_hires" / "horse0.off")
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(original.vertices, original.faces))
    halvings = 1 if target < 60_000 else 2
    meshes.meshing_surface_subdivision_midpoint(iterations=halvings, threshold=pymeshlab.PercentageValue(0))
    area = meshes.get_geometric_measures()["surface_area"]
    length = np.sqrt(area / target * 2 / np.sqrt(3))  # the edge of that many equilateral triangle pairs
    meshes.meshing_isotropic_explicit_remeshing(iterations=8, targetlen=pymeshlab.PureValue(float(length)))
    meshes.meshing_remove_connected_component_by_face_number(mincomponentsize=1000)
    meshes.meshing_remove_unreferenced_vertices()
    result = meshes.current_mesh()
    return result.vertex_matrix(), result.face_matrix().astype(np.int64)


def _subdivided(target: int) -> Arrays:
    import igl

    vertices, faces = igl.loop(*remeshed(target // 4))
    return vertices, faces.astype(np.int64)
