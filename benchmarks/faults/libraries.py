"""What each library is asked in the fault table, one function for each entry point; `child.py` runs them.

Arrays go in as the case has them: what a library makes of them is what is measured.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Given = tuple[Any, Any, int]  # vertices, faces, the vertex from which distances are measured


def gmds_distance(v: Any, f: Any, source: int) -> Any:
    """Fast marching of this project."""
    from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded

    mesh = Mesh(v, f)
    return GeodesicDistance(embedded(mesh)).field(SurfacePoints.at_vertices(mesh, [source]))[0]


def igl_exact(v: Any, f: Any, source: int) -> Any:
    """Exact geodesics of libigl."""
    import igl

    return igl.exact_geodesic(v, f, VS=np.array([source]), VT=np.arange(len(v)))


def igl_heat(v: Any, f: Any, source: int) -> Any:
    """Heat method of libigl."""
    import igl

    data = igl.HeatGeodesicsData()
    igl.heat_geodesics_precompute(v, f, data)
    return igl.heat_geodesics_solve(data, np.array([source]))


def potpourri_heat(v: Any, f: Any, source: int) -> Any:
    """Heat method of potpourri3d (geometry-central)."""
    import potpourri3d

    return potpourri3d.MeshHeatMethodDistanceSolver(v, f).compute_distance(source)


def potpourri_marching(v: Any, f: Any, source: int) -> Any:
    """Fast marching of potpourri3d (geometry-central)."""
    import potpourri3d

    return potpourri3d.MeshFastMarchingDistanceSolver(v, f).compute_distance([[(source, [])]])


def pygeodesic_exact(v: Any, f: Any, source: int) -> Any:
    """Exact geodesics of pygeodesic."""
    from pygeodesic.geodesic import PyGeodesicAlgorithmExact

    return PyGeodesicAlgorithmExact(v, f).geodesicDistances(np.array([source]))[0]


def pymeshlab_distance(v: Any, f: Any, source: int) -> Any:
    """Approximate geodesics of pymeshlab."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(v, f))
    meshes.compute_scalar_by_geodesic_distance_from_given_point_per_vertex(startpoint=np.asarray(v)[source])
    return meshes.current_mesh().vertex_scalar_array()


def pyfm_distance(v: Any, f: Any, source: int) -> Any:
    """Heat method of pyFM."""
    from pyFM.mesh import TriMesh

    return TriMesh(v, f).geod_from(source)


def gmds_laplacian(v: Any, f: Any, _: int) -> Any:
    """Stiffness of this project."""
    from geodesics import Mesh, embedded, stiffness

    return stiffness(embedded(Mesh(v, f)))


def igl_laplacian(v: Any, f: Any, _: int) -> Any:
    """Cotangent matrix of libigl."""
    import igl

    return -igl.cotmatrix(v, f)


def potpourri_laplacian(v: Any, f: Any, _: int) -> Any:
    """Cotangent matrix of potpourri3d."""
    import potpourri3d

    return potpourri3d.cotan_laplacian(v, f)


def robust_laplacian(v: Any, f: Any, _: int) -> Any:
    """Tufted intrinsic Delaunay Laplacian."""
    import robust_laplacian

    return robust_laplacian.mesh_laplacian(v, f)[0]


def pyfm_laplacian(v: Any, f: Any, _: int) -> Any:
    """Cotangent matrix of pyFM."""
    from pyFM.mesh import TriMesh

    mesh = TriMesh(v, f)
    mesh.process(k=0, intrinsic=False)
    return mesh.W


def gmds_read(path: Path) -> Any:
    """Reader of this project."""
    from geodesics import read_mesh

    mesh = read_mesh(path)
    return mesh.vertices, mesh.faces


def gmds_check(path: Path) -> Any:
    """The command `gmds check`: its exit code and what it says on stderr."""
    from click.testing import CliRunner

    from gmds.cli import main

    done = CliRunner().invoke(main, ["check", "--", str(path)])
    if done.exit_code not in (0, 1):
        raise AssertionError(f"exit code {done.exit_code}")
    if done.exit_code == 1:
        code, message = done.stderr.removeprefix("gmds: ").split(": ", 1)
        raise type("Refused", (Exception,), {"code": code})(f"{code}: {message}")
    return gmds_read(path)


def trimesh_read(path: Path) -> Any:
    """Reader of trimesh, as told to leave the vertices alone."""
    import trimesh

    mesh = trimesh.load_mesh(path, process=False, maintain_order=True)
    return mesh.vertices, mesh.faces


def igl_read(path: Path) -> Any:
    """Reader of libigl."""
    import igl

    return igl.read_triangle_mesh(str(path))[:2]


def potpourri_read(path: Path) -> Any:
    """Reader of potpourri3d."""
    import potpourri3d

    return potpourri3d.read_mesh(str(path))


def pymeshlab_read(path: Path) -> Any:
    """Reader of pymeshlab."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def pyfm_read(path: Path) -> Any:
    """Reader of pyFM."""
    from pyFM.mesh import TriMesh

    mesh = TriMesh(str(path))
    return mesh.vertlist, mesh.facelist


LIBRARIES: dict[str, list[Callable[..., Any]]] = {
    "gmds": [gmds_distance, gmds_laplacian, gmds_read, gmds_check],
    "trimesh": [trimesh_read],
    "libigl": [igl_exact, igl_heat, igl_laplacian, igl_read],
    "potpourri3d": [potpourri_heat, potpourri_marching, potpourri_laplacian, potpourri_read],
    "pygeodesic": [pygeodesic_exact],
    "robust_laplacian": [robust_laplacian],
    "pyFM": [pyfm_distance, pyfm_laplacian, pyfm_read],
    "pymeshlab": [pymeshlab_distance, pymeshlab_read],
}
