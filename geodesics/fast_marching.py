"""Geodesic distance in any metric, by fast marching."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geodesics._front import corners, fresh_front, seeds
from geodesics._kernels import marching
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.points import SurfacePoints

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GeodesicDistance:
    """Geodesic distance in any metric, marched over the surface: the scale invariant geodesics of the abstract.

    A conformal metric is marched over the intrinsic Delaunay triangulation of the embedded one, whose angles it
    shares; any other metric over the mesh's own faces. `threads` bounds how many sources are marched at once; the
    result does not depend on it.
    """

    metric: Metric
    threads: int = 2

    @property
    def mesh(self) -> Mesh:
        """The mesh whose vertices distances are given at."""
        return self.metric.mesh

    def field(self, points: SurfacePoints, *, limit: float = np.inf) -> Floats:
        """Distances (p, n) from each of p points to every vertex; +inf where unreachable or beyond `limit`."""
        table, start, n = corners(self.metric), seeds(self.metric, points), self.mesh.n_vertices
        bound, out = np.full(n, np.inf), np.empty((len(points), n))

        def rows(chunk: range) -> None:
            front = fresh_front(n)
            for i in chunk:
                marching.run(table, front, *(part[i] for part in start), bound, limit)
                out[i] = front.state[:, 0]
                marching.clear(front)

        workers = max(1, min(self.threads, os.cpu_count() or 1, len(points)))
        chunks = [range(k, len(points), workers) for k in range(workers)]
        if workers == 1:
            rows(chunks[0])
        else:
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(rows, chunks))
        return out
