"""Maps that are known exactly."""

from __future__ import annotations

import numpy as np
from shapes import bumpy_sphere, subdivided

from geodesics import Mesh, SurfacePoints
from geodesics.closest import closest_on_triangles
from gmds.correspondence import Correspondence


def identity(mesh: Mesh) -> Correspondence:
    return Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))


def subvertex_map(coarse: int = 2) -> tuple[Correspondence, Mesh, Mesh]:
    """The exact map from a subdivided surface to the surface it was cut from: points at vertices and edge midpoints."""
    target = bumpy_sphere(coarse)
    source = subdivided(target)
    face, weights, gap = closest_on_triangles(source.vertices, target.vertices, target.faces)
    assert gap.max() < 1e-12
    return Correspondence.from_points(source, SurfacePoints(target, face, weights)), source, target
