"""Which of two mirrored answers: what changes sign under a reflection, and nothing else does."""

from __future__ import annotations

import itertools

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.curvature import vertex_normals
from gmds.surface.view import View

FUNCTIONS = 5  # first eigenfunctions, without the constant, whose forms are compared: those whose signs are tried
_PAIRS = np.array(list(itertools.combinations(range(FUNCTIONS), 2)))


def orientation_score(source: Mesh, target: Mesh, images: Floats, normals: Floats) -> float:
    """Signed share in [-1, 1] of the image of a map whose triangles keep their orientation.

    `images` (n, 3) are the positions of the source vertices on the target, `normals` (n, 3) the target's there.
    Every source triangle is pushed through the map; its area counts with the cosine between its normal and the
    target's.
    """
    a, b, c = source.faces.T
    area = np.cross(images[b] - images[a], images[c] - images[a])
    normal = normals[a] + normals[b] + normals[c]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    total = np.linalg.norm(area, axis=1).sum()
    return float((area * normal).sum() / total) if total > 0 else 0.0


def vertex_map_orientation(source: Mesh, target: Mesh, images: Integers) -> float:
    """The orientation score of a map to target vertices, `images` (n,)."""
    return orientation_score(source, target, target.vertices[images], vertex_normals(target)[images])


def orientation_forms(view: View, points: Integers) -> Floats:
    """The 2-forms d phi_i ^ d phi_j, 1 <= i < j <= 5, per area of the metric, at vertices `points`: (p, 10).

    They do not depend on the metric but for the area, keep their value under a map that preserves orientation, and
    change their sign under one that reverses it.
    """
    corner = view.functions[:, 1 : FUNCTIONS + 1][view.mesh.faces]
    first, second = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    i, j = _PAIRS.T
    wedge = 0.5 * (first[:, i] * second[:, j] - first[:, j] * second[:, i])  # integral over each face
    total = np.zeros((view.mesh.n_vertices, len(_PAIRS)))
    for k in range(3):
        np.add.at(total, view.mesh.faces[:, k], wedge / 3)
    return total[points] / view.spectrum.mass[points, None]
