"""The intrinsic Delaunay triangulation: the same surface, cut along better edges."""

from __future__ import annotations

from typing import NamedTuple

import igl
import numpy as np
from numpy.typing import NDArray

from geodesics._memo import memoized
from geodesics.intrinsic import squared_lengths
from geodesics.mesh import Mesh


class IntrinsicTriangulation(NamedTuple):
    """Faces (m, 3) over the mesh's own vertices and their squared edge lengths (m, 3)."""

    faces: NDArray[np.int64]
    l_sq: NDArray[np.float64]


@memoized
def intrinsic_delaunay(mesh: Mesh) -> IntrinsicTriangulation:
    """Edge flips until every edge is intrinsically Delaunay (Fisher et al. 2007)."""
    lengths, faces = igl.intrinsic_delaunay_triangulation(np.sqrt(squared_lengths(mesh.vertices, mesh.faces)), mesh.faces)[:2]
    return IntrinsicTriangulation(np.ascontiguousarray(faces, dtype=np.int64), np.ascontiguousarray(lengths) ** 2)
