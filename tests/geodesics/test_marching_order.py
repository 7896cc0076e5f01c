"""Distances depend on the surface alone: neither rounding nor the order of faces decides between ways of equal length.

The surfaces are rough, with obtuse angles, and among those on which `benchmarks/fuzzing/metamorphic.py` found that
they did.
"""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import jittered, moved, torus
from matched_shapes import permuted, reflected, shuffled
from numpy.typing import NDArray

from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded, scale_invariant

ROUNDING = 1e-12  # of the longest distance


def rough(seed: int) -> Mesh:
    return jittered(torus(18, 10), 0.05, seed=seed)


def distances(mesh: Mesh, sources: NDArray[np.int64]) -> NDArray[np.float64]:
    return GeodesicDistance(embedded(mesh), threads=1).field(SurfacePoints.at_vertices(mesh, sources))


@pytest.mark.parametrize("seed", [1, 5, 9, 69, 145, 389, 501, 605, 649, 957])
def test_distances_between_all_vertices(seed: int) -> None:
    mesh = rough(seed)
    everywhere = np.arange(mesh.n_vertices)
    before = distances(mesh, everywhere)
    near = ROUNDING * before.max()
    for scale in (1e-6, 1.0, 1e12):
        assert np.abs(distances(moved(mesh, scale, seed=seed), everywhere) / scale - before).max() <= near
    for other in (
        reflected(mesh),
        Mesh(mesh.vertices, mesh.faces[:, ::-1]),
        *(shuffled(mesh, seed + 1000 * k) for k in range(4)),
    ):
        assert np.abs(distances(other, everywhere) - before).max() <= near
    renumbered, place = permuted(mesh, seed)
    assert np.abs(distances(renumbered, place)[:, place] - before).max() <= near


def test_distances_in_another_metric() -> None:
    for seed in range(20):
        mesh = rough(seed)
        points = SurfacePoints.at_vertices(mesh, np.arange(0, mesh.n_vertices, 7))
        before = GeodesicDistance(scale_invariant(mesh)).field(points)
        other = shuffled(mesh, seed)
        after = GeodesicDistance(scale_invariant(other)).field(
            SurfacePoints.at_vertices(other, points.nearest_vertices())
        )
        assert np.abs(after - before).max() <= 1e-9 * before.max()
