"""A mesh where a metric is expected, vertices where points are; anything else is told what would do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere

import geodesics
from geodesics import SurfacePoints, eigenpairs, embedded, galerkin_mass, lumped_mass, stiffness
from geodesics.errors import IndexOutOfRange, NonIntegralFace
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


def test_a_diffusion_distance_has_a_time_unless_one_is_given() -> None:
    here, there = (geodesics.DiffusionDistance(SPECTRUM, *time).field(3) for time in ((), (3e-3,)))
    assert np.array_equal(here, there)


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


NOT_A_MESH = "a mesh is expected, not list; for example geodesics.Mesh"


@pytest.mark.parametrize("given", [[MESH, MESH], [], None])
@pytest.mark.parametrize(
    "of_a_mesh",
    [
        *(getattr(geodesics, name) for name in ("angle_defect", "gaussian_curvature", "mean_curvature")),
        *(getattr(geodesics, name) for name in ("principal_curvatures", "vertex_normals", "orient_faces")),
        *(
            getattr(geodesics, name)
            for name in ("embedded", "scale_invariant", "min_curvature", "equi_affine", "affine")
        ),
        lambda given: geodesics.conformal(given, np.ones(3)),
        geodesics.plot,
    ],
)
def test_what_is_no_mesh_is_told(of_a_mesh: Any, given: Any) -> None:
    with pytest.raises(TypeError, match=NOT_A_MESH.replace("list", type(given).__name__)):
        of_a_mesh(given)


def test_meshes_of_other_libraries_have_curvature_too() -> None:
    import trimesh

    other = trimesh.Trimesh(MESH.vertices, MESH.faces, process=False)
    assert np.array_equal(geodesics.gaussian_curvature(other), geodesics.gaussian_curvature(MESH))  # type: ignore[arg-type]
    assert np.array_equal(geodesics.scale_invariant(other).mass, geodesics.scale_invariant(MESH).mass)  # type: ignore[arg-type]


@pytest.mark.parametrize("wrong", [1.5, [0, 2.5], float("nan")])
@each_distance
def test_a_vertex_is_a_whole_number(distance: Any, wrong: Any) -> None:
    for call in (distance.field, lambda points: geodesics.distance_matrix(distance, points)):
        with pytest.raises(NonIntegralFace, match="is no whole number"):
            call(wrong)
    with pytest.raises(NonIntegralFace, match=r"sample . = .* is no whole number"):
        geodesics.voronoi_cells(distance, wrong)


@each_distance
def test_no_points_are_told_from_an_empty_list(distance: Any) -> None:
    assert distance.field([]).shape == (0, MESH.n_vertices)
    assert geodesics.distance_matrix(distance, []).shape == (0, 0)
    with pytest.raises(TypeError, match="point indices are expected, not None"):
        distance.field(None)
    with pytest.raises(TypeError, match=r"not Mesh$"):
        distance.field(MESH)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: geodesics.heat_kernel_signature(SPECTRUM, "a"), "times must be an array, not 'a'$"),
        (lambda: geodesics.scale_invariant_heat_kernel_signature(SPECTRUM, None, 2.5), "n_frequencies must be"),
        (lambda: geodesics.DiffusionDistance(SPECTRUM, "a"), "must be a finite number >= 0, not 'a'"),
        (lambda: geodesics.scale_invariant(MESH, exponent="a"), "exponent must be a finite number, not 'a'"),
        (lambda: geodesics.scale_invariant(MESH, smoothing=-1), "smoothing must be a finite number >= 0, not -1"),
        (lambda: geodesics.affine(MESH, regularisation="a"), "regularisation must be a finite number >= 0, not 'a'"),
        (lambda: geodesics.equi_affine(MESH, regularisation=[1]), "regularisation must be a finite number >= 0"),
        (lambda: geodesics.conformal(MESH, np.ones(3)), "factor must be 42 numbers, one for each vertex"),
        (lambda: geodesics.farthest_point_sampling(DISTANCES["commute"], 5.5), "count must be 1 to 42, not 5.5"),
        (
            lambda: geodesics.farthest_point_sampling(DISTANCES["commute"], 5, 1.5),
            "first must be a vertex on the surface, not 1.5",
        ),
    ],
)
def test_numbers_that_are_none_are_refused(call: Any, says: str) -> None:
    with pytest.raises((TypeError, ValueError), match=says):
        call()


def test_the_field_of_one_point_can_be_drawn() -> None:
    field = DISTANCES["geodesic"].field(0)
    one, other = (geodesics.plot(MESH, values) for values in (field, field[0]))
    assert np.array_equal(one.data[0]["intensity"], other.data[0]["intensity"])
