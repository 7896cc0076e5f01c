"""Distances on one surface: meshes, metrics, spectra, and the distances they define.

Names are imported when first used, so `import geodesics` costs nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from geodesics.moved_paths import MOVED, keep_old_paths

if TYPE_CHECKING:
    from geodesics.curvature import angle_defect as angle_defect
    from geodesics.curvature import gaussian_curvature as gaussian_curvature
    from geodesics.curvature import mean_curvature as mean_curvature
    from geodesics.curvature import principal_curvatures as principal_curvatures
    from geodesics.curvature import vertex_normals as vertex_normals
    from geodesics.delaunay import intrinsic_delaunay as intrinsic_delaunay
    from geodesics.diffusion import BiharmonicDistance as BiharmonicDistance
    from geodesics.diffusion import CommuteTimeDistance as CommuteTimeDistance
    from geodesics.diffusion import DiffusionDistance as DiffusionDistance
    from geodesics.distance import Distance as Distance
    from geodesics.errors import FormatError as FormatError
    from geodesics.errors import MeshError as MeshError
    from geodesics.errors import Note as Note
    from geodesics.fast_marching.distance import GeodesicDistance as GeodesicDistance
    from geodesics.io import read_mesh as read_mesh
    from geodesics.io import read_with_notes as read_with_notes
    from geodesics.io import write_mesh as write_mesh
    from geodesics.laplacian import galerkin_mass as galerkin_mass
    from geodesics.laplacian import lumped_mass as lumped_mass
    from geodesics.laplacian import stiffness as stiffness
    from geodesics.matrices import distance_matrix as distance_matrix
    from geodesics.mesh import Mesh as Mesh
    from geodesics.mesh import triangulate as triangulate
    from geodesics.metric import Metric as Metric
    from geodesics.metric import conformal as conformal
    from geodesics.metrics.affine import affine as affine
    from geodesics.metrics.embedded import embedded as embedded
    from geodesics.metrics.equi_affine import equi_affine as equi_affine
    from geodesics.metrics.min_curvature import min_curvature as min_curvature
    from geodesics.metrics.scale_invariant import scale_invariant as scale_invariant
    from geodesics.plotting import plot as plot
    from geodesics.points import SurfacePoints as SurfacePoints
    from geodesics.sampling import farthest_point_sampling as farthest_point_sampling
    from geodesics.sampling import voronoi_cells as voronoi_cells
    from geodesics.signatures import heat_kernel as heat_kernel
    from geodesics.signatures import heat_kernel_signature as heat_kernel_signature
    from geodesics.signatures import scale_invariant_heat_kernel_signature as scale_invariant_heat_kernel_signature
    from geodesics.signatures import scaled_heat_kernel_signature as scaled_heat_kernel_signature
    from geodesics.spectrum import Spectrum as Spectrum
    from geodesics.spectrum import eigenpairs as eigenpairs
    from geodesics.topology.orientation import orient_faces as orient_faces
    from geodesics.wave_signature import wave_kernel_signature as wave_kernel_signature

# every public name, by the module it lives in
_NAMES = {
    "curvature": (
        "angle_defect",
        "gaussian_curvature",
        "mean_curvature",
        "principal_curvatures",
        "vertex_normals",
    ),
    "delaunay": ("intrinsic_delaunay",),
    "diffusion": (
        "BiharmonicDistance",
        "CommuteTimeDistance",
        "DiffusionDistance",
    ),
    "distance": ("Distance",),
    "matrices": ("distance_matrix",),
    "errors": (
        "FormatError",
        "MeshError",
        "Note",
    ),
    "fast_marching.distance": ("GeodesicDistance",),
    "io": (
        "read_mesh",
        "read_with_notes",
        "write_mesh",
    ),
    "laplacian": (
        "galerkin_mass",
        "lumped_mass",
        "stiffness",
    ),
    "mesh": (
        "Mesh",
        "triangulate",
    ),
    "metric": (
        "Metric",
        "conformal",
    ),
    "metrics.affine": ("affine",),
    "metrics.embedded": ("embedded",),
    "metrics.equi_affine": ("equi_affine",),
    "metrics.min_curvature": ("min_curvature",),
    "metrics.scale_invariant": ("scale_invariant",),
    "plotting": ("plot",),
    "points": ("SurfacePoints",),
    "sampling": (
        "farthest_point_sampling",
        "voronoi_cells",
    ),
    "signatures": (
        "heat_kernel",
        "heat_kernel_signature",
        "scale_invariant_heat_kernel_signature",
        "scaled_heat_kernel_signature",
    ),
    "spectrum": (
        "Spectrum",
        "eigenpairs",
    ),
    "topology.orientation": ("orient_faces",),
    "wave_signature": ("wave_kernel_signature",),
}
_SUBMODULES = ("check", "intrinsic", "metrics", "repair", "topology", "tracing")
_HOME = {name: module for module, names in _NAMES.items() for name in names}

__all__ = sorted(_HOME)

keep_old_paths(MOVED)


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(importlib.import_module(f"geodesics.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    if name in _SUBMODULES or name in _NAMES:
        return importlib.import_module(f"geodesics.{name}")
    raise AttributeError(f"module 'geodesics' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
