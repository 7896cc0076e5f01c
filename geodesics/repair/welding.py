"""Vertices that stand for one point of the surface: along open edges that lie on each other."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from geodesics.arrays import Floats, Integers
from geodesics.mesh import Mesh
from geodesics.topology.components import boundary_vertices
from geodesics.topology.edges import components, edges

# Vertices nearer than this to each other, in units of the extent of the mesh, differ by the rounding of a file in
# single precision (6e-8) or with six or seven digits; but never farther than this share of the median open edge.
ROUNDING = 1e-6
SHARE_OF_EDGE = 0.01
NEIGHBOURS = 4  # that are looked at around each position, itself among them: positions are many, copies of one few


def seam_welds(mesh: Mesh) -> Integers:
    """The vertex that stands for each one (n,), the first of those that open edges have at one position.

    Vertices on no open edge stand for themselves: two closed surfaces that touch are not joined. So meshes cut into
    charts along the seams of a texture, and triangles with corners of their own, become one surface.
    """
    stand = np.arange(mesh.n_vertices)
    open_ends = np.flatnonzero(boundary_vertices(mesh))
    if len(open_ends) == 0:
        return stand
    place = mesh.vertices[open_ends]
    site, member = np.unique(place, axis=0, return_inverse=True)
    group = _joined(site, _reach(mesh))[member.reshape(-1)]
    _, first, inverse = np.unique(group, return_index=True, return_inverse=True)
    stand[open_ends] = open_ends[first[inverse.reshape(-1)]]
    return stand


def _reach(mesh: Mesh) -> float:
    """The distance up to which open ends are at one position."""
    table = edges(mesh)
    a, b = mesh.vertices[table.ends[table.n_faces == 1]].transpose(1, 0, 2)
    lengths = np.linalg.norm(a - b, axis=1)
    extent = float(np.ptp(mesh.vertices[np.unique(mesh.faces)], axis=0).max())
    typical = float(np.median(lengths)) if len(lengths) else 0.0
    return min(ROUNDING * extent, SHARE_OF_EDGE * typical)


def _joined(site: Floats, reach: float) -> Integers:
    """Labels (k,) of different positions (k, 3), equal where they are within reach, one after the other."""
    if len(site) < NEIGHBOURS or reach <= 0:
        return np.arange(len(site))
    distance, near = cKDTree(site).query(site, k=NEIGHBOURS)
    row, column = np.nonzero(distance <= reach)
    return components(row, near[row, column], len(site))
