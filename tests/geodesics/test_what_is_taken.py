"""A mesh where a metric is expected, vertices where points are; anything else is told what would do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere

import geodesics
from geodesics import SurfacePoints, eigenpairs, embedded, galerkin_mass, lumped_mass, stiffness
from geodesics.errors import IndexOutOfRange

MESH = bumpy_sphere(1)
SPECTRUM = eigenpairs(embedded(MESH), 12)
DISTANCES = {
    "geodesic": geodesics.GeodesicDistance(embedded(MESH)),
    "diffusion": geodesics.DiffusionDistance(SPECTRUM, 0.1),
    "commute": geodesics.CommuteTimeDistance(SPECTRUM),
    "biharmonic": geodesics.BiharmonicDistance(SPECTRUM),
}
each_distance = pytest.mark.parametrize("distance", DISTANCES.values(), ids=DISTANCES.keys())


def test_a_mesh_stands_for_its_embedded_metric() -> None:
    metric = embedded(MESH)
    for operator in (stiffness, lumped_mass, galerkin_mass):
        assert np.array_equal(operator(MESH).toarray(), operator(metric).toarray())
    assert np.array_equal(eigenpairs(MESH, 5).eigenvalues, eigenpairs(metric, 5).eigenvalues)
    points = SurfacePoints.at_vertices(MESH, [3])
    assert np.array_equal(geodesics.GeodesicDistance(MESH).field(points), DISTANCES["geodesic"].field(points))  # type: ignore[arg-type]


@each_distance
@pytest.mark.parametrize("vertices", [[3, 7], (3, 7), np.array([3, 7], dtype=np.int32), 3])
def test_vertices_stand_for_points(distance: Any, vertices: Any) -> None:
    expected = distance.field(SurfacePoints.at_vertices(MESH, vertices))
    assert np.array_equal(distance.field(vertices), expected)


def test_vertices_in_other_places() -> None:
    points = SurfacePoints.at_vertices(MESH, [3])
    assert np.array_equal(DISTANCES["geodesic"].to_set([3]), DISTANCES["geodesic"].to_set(points))  # type: ignore[attr-defined]
    assert np.array_equal(geodesics.heat_kernel(SPECTRUM, 0.1, 3), geodesics.heat_kernel(SPECTRUM, 0.1, points))


@each_distance
def test_points_that_are_none_are_refused(distance: Any) -> None:
    with pytest.raises(IndexOutOfRange, match="E105: point 0 = 9999"):
        distance.field([9999])
    with pytest.raises(IndexOutOfRange, match="the points lie on another mesh"):
        distance.field(SurfacePoints.at_vertices(icosphere(0), [0]))
    with pytest.raises(TypeError, match="must be an array"):
        distance.field("0")


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: eigenpairs(3, 5), "a metric or a mesh is expected, not int; for example geodesics.embedded"),
        (lambda: stiffness(SPECTRUM), "a metric or a mesh is expected, not Spectrum"),
        (lambda: geodesics.GeodesicDistance(None), "a metric or a mesh is expected, not NoneType"),
        (lambda: geodesics.DiffusionDistance(MESH, 0.1), "a spectrum is expected, not Mesh; for example"),
        (lambda: geodesics.CommuteTimeDistance(embedded(MESH)), "a spectrum is expected, not Metric"),
        (lambda: geodesics.BiharmonicDistance(MESH), "a spectrum is expected"),
        (lambda: geodesics.heat_kernel(MESH, 1, 0), "a spectrum is expected"),
        (lambda: geodesics.heat_kernel_signature(MESH, [1]), "a spectrum is expected"),
        (lambda: geodesics.scaled_heat_kernel_signature(MESH, [1]), "a spectrum is expected"),
        (lambda: geodesics.scale_invariant_heat_kernel_signature(MESH), "a spectrum is expected"),
        (lambda: geodesics.wave_kernel_signature(MESH), "a spectrum is expected"),
        (lambda: geodesics.farthest_point_sampling(MESH, 3), "a distance is expected, not Mesh; for example"),
        (lambda: geodesics.voronoi_cells(embedded(MESH), [0]), "a distance is expected, not Metric"),
    ],
)
def test_what_would_do_is_told(call: Any, says: str) -> None:
    with pytest.raises(TypeError, match=says):
        call()
