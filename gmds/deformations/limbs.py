"""Tips of limbs, for choosing what to bend or to scale; distances along edges are accurate enough for that."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Integers
from geodesics.topology.edge_paths import edge_distances


def extremities(mesh: Mesh, samples: int = 60) -> tuple[Integers, int]:
    """Vertices at the tips of limbs, most remote first, and the most central vertex.

    Remoteness is the mean distance to `samples` far-apart vertices; tips are its local maxima among these samples,
    each the most remote one within a quarter of the largest distance between samples.
    """
    used = np.unique(mesh.faces)
    chosen = [int(used[((mesh.vertices[used] - mesh.vertices[used].mean(axis=0)) ** 2).sum(axis=1).argmax()])]
    distances = edge_distances(mesh, np.array(chosen))
    for _ in range(min(samples, mesh.n_vertices) - 1):
        nearest = np.where(np.isfinite(distances), distances, -1).min(axis=0)
        chosen.append(int(nearest.argmax()))
        distances = np.vstack([distances, edge_distances(mesh, np.array(chosen[-1:]))])
    remote = np.where(np.isfinite(distances), distances, 0).mean(axis=0)
    among = distances[:, chosen]
    radius = 0.25 * among[np.isfinite(among)].max()
    rivals = (among < radius) & (remote[chosen][None, :] > remote[chosen][:, None])
    tips = np.array(chosen)[~rivals.any(axis=1)]
    tips = tips[remote[tips] > np.median(remote)]
    return tips[np.argsort(-remote[tips], kind="stable")], int(np.where(remote > 0, remote, np.inf).argmin())
