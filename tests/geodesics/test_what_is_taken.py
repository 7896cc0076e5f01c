"""A mesh where a metric is expected, vertices where points are; anything else is told what would do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere

import geodesics
from geodesics import SurfacePoints, eigenpairs, embedded, galerkin_mass, lumped_mass, stiffness
from geodesics.errors import IndexOutOfRange
from geodesics.signatures import resolved_times

MESH = bumpy_sphere(1)
SPECTRUM = eigenpairs(embedded(MESH), 12)
DISTANCES = {
    "geodesic": geodesics.GeodesicDistance(embedded(MESH)),
    "diffusion": geodesics.DiffusionDistance(SPECTRUM, 0.1),
    "commute": geodesics.CommuteTimeDistance(SPECTRUM),
    "biharmonic": geodesics.BiharmonicDistance(SPECTRUM),
}
SIGNATURES = (
    geodesics.heat_kernel_signature,
    geodesics.scaled_heat_kernel_signature,
    geodesics.scale_invariant_heat_kernel_signature,
    geodesics.wave_kernel_signature,
)
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


def test_a_mesh_or_a_metric_stands_for_its_first_eigenpairs() -> None:
    spectrum = eigenpairs(MESH)
    assert len(spectrum.eigenvalues) == min(100, MESH.n_vertices)
    for surface in (MESH, embedded(MESH)):
        for signature in SIGNATURES:
            assert np.array_equal(signature(surface), signature(spectrum)), signature
        assert np.array_equal(geodesics.heat_kernel(surface, 0.1, 3), geodesics.heat_kernel(spectrum, 0.1, 3))
        for made, expected in (
            (geodesics.CommuteTimeDistance(surface), geodesics.CommuteTimeDistance(spectrum)),
            (geodesics.DiffusionDistance(surface, 0.1), geodesics.DiffusionDistance(spectrum, 0.1)),
        ):
            assert np.array_equal(made.field([0, 5]), expected.field([0, 5]))
    assert geodesics.CommuteTimeDistance(MESH).spectrum is geodesics.BiharmonicDistance(MESH).spectrum  # computed once


def test_times_are_those_that_the_spectrum_resolves_unless_given() -> None:
    times = resolved_times(SPECTRUM, 64)
    assert np.array_equal(geodesics.heat_kernel_signature(SPECTRUM), geodesics.heat_kernel_signature(SPECTRUM, times))
    assert geodesics.scaled_heat_kernel_signature(SPECTRUM).shape == (MESH.n_vertices, 64)


@pytest.mark.parametrize("one", [MESH, embedded(MESH), SPECTRUM, *DISTANCES.values()])
def test_what_is_there_is_told_in_a_line(one: Any) -> None:
    assert len(repr(one)) < 160 and "\n" not in repr(one)
    assert repr(one).startswith(type(one).__name__) and repr(MESH) in repr(one)


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
        (lambda: geodesics.DiffusionDistance(DISTANCES["geodesic"], 0.1), "a spectrum is expected, not GeodesicDist"),
        (lambda: geodesics.CommuteTimeDistance(None), "a spectrum is expected, not NoneType; for example"),
        (lambda: geodesics.BiharmonicDistance(3), "a spectrum is expected"),
        (lambda: geodesics.heat_kernel(np.zeros(3), 1, 0), "a spectrum is expected"),
        (lambda: geodesics.heat_kernel_signature("cat.off", [1]), "a spectrum is expected"),
        (lambda: geodesics.scaled_heat_kernel_signature(None, [1]), "a spectrum is expected"),
        (lambda: geodesics.scale_invariant_heat_kernel_signature(None), "a spectrum is expected"),
        (lambda: geodesics.wave_kernel_signature(None), "a spectrum is expected"),
        (lambda: geodesics.farthest_point_sampling(MESH, 3), "a distance is expected, not Mesh; for example"),
        (lambda: geodesics.voronoi_cells(embedded(MESH), [0]), "a distance is expected, not Metric"),
    ],
)
def test_what_would_do_is_told(call: Any, says: str) -> None:
    with pytest.raises(TypeError, match=says):
        call()
