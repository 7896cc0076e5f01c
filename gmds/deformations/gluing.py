"""A change of topology: parts that touch become one."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.topology.edge_paths import edge_distances


def gluing(mesh: Mesh, count: int = 1, *, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Join pairs of vertices that are near in space and far along the surface.

    Pairs are those with the least ratio of distance in space to distance along edges, among 200 random vertices and all
    others of their component. The two vertices of a pair meet half way; the later one leaves the numbering.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    count : int
        Pairs that are joined, at most.
    rng : int
        Seed of the random choices.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.
    """
    mesh = Mesh.from_object(mesh)
    random = np.random.default_rng(rng)
    some = random.permutation(mesh.n_vertices)[:200]
    along = edge_distances(mesh, some)
    across = np.linalg.norm(mesh.vertices[some][:, None] - mesh.vertices[None], axis=2)
    limit = 0.25 * along[np.isfinite(along)].max()
    apart = (along > limit) & np.isfinite(along) & (across > 0)
    ratio = np.where(apart, across / np.where(apart, along, 1), np.inf)
    vertices, partner = mesh.vertices.copy(), np.arange(mesh.n_vertices)
    for row in ratio.min(axis=1).argsort(kind="stable"):
        a, b = int(some[row]), int(ratio[row].argmin())
        if (partner != np.arange(len(partner))).sum() >= count or not np.isfinite(ratio[row, b]):
            break
        if partner[a] == a and partner[b] == b and a not in partner[partner != np.arange(len(partner))]:
            partner[max(a, b)] = min(a, b)
            vertices[min(a, b)] = (vertices[a] + vertices[b]) / 2
    kept, renumbered = np.unique(partner, return_inverse=True)
    result = Mesh(vertices[kept], renumbered[mesh.faces])
    return result, SurfacePoints.at_vertices(result, renumbered)
