"""Vertices where points are expected, a loss or a problem that is none: taken, or told in one sentence."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

import geodesics
import gmds
from geodesics import SurfacePoints
from geodesics.errors import IndexOutOfRange, NonIntegralFace
from gmds.deformations import caricature

MESH = bumpy_sphere(1)
DISTANCE = geodesics.CommuteTimeDistance(MESH)
VERTICES = [0, 5, 9, 20]
POINTS = SurfacePoints.at_vertices(MESH, VERTICES)
PROBLEM = gmds.Problem(DISTANCE, POINTS, DISTANCE)
SOLVERS = (
    lambda start: gmds.solve(PROBLEM, start),
    lambda start: gmds.solve_by_ladder(PROBLEM, start, gmds.Minimax()),
    lambda start: gmds.solve_multiresolution(PROBLEM, start),
    lambda start: gmds.solve_partial(DISTANCE, VERTICES, DISTANCE, start, share=0.9).solution,
)


@pytest.mark.parametrize("solver", SOLVERS)
def test_vertices_stand_for_points(solver: Any) -> None:
    places = [solver(start).points.positions for start in (VERTICES, np.array(VERTICES), POINTS)]
    assert np.array_equal(places[0], places[2]) and np.array_equal(places[1], places[2])
    with pytest.raises(IndexOutOfRange, match="E105: point 1 = 999"):
        solver([0, 999, 9, 20])
    with pytest.raises(NonIntegralFace, match=r"point 3 = 2\.5 is no whole number"):
        solver([0, 5, 9, 2.5])


def test_a_problem_of_vertices() -> None:
    assert np.array_equal(gmds.Problem(DISTANCE, VERTICES, DISTANCE).source_distances, PROBLEM.source_distances)
    with pytest.raises(NonIntegralFace, match="is no whole number"):
        gmds.Problem(DISTANCE, [0, 1.5], DISTANCE)
    with pytest.raises(ValueError, match="needs at least two samples"):
        gmds.Problem(DISTANCE, [], DISTANCE)


def test_what_came_out_is_told_in_a_line() -> None:
    found = gmds.solve_partial(DISTANCE, VERTICES, DISTANCE, VERTICES, share=0.9)
    for one in (PROBLEM, found, found.solution, gmds.TabulatedDistance(DISTANCE), gmds.canonical_form(DISTANCE)):
        assert repr(one).startswith(type(one).__name__) and len(repr(one)) < 160 and "\n" not in repr(one)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: gmds.solve([], POINTS), "a problem is expected, not list; make one with gmds.Problem"),
        (lambda: gmds.solve(PROBLEM, POINTS, "huber"), "loss must be one of LeastSquares.*, not 'huber'"),
        (lambda: gmds.solve_by_ladder(PROBLEM, POINTS, gmds.Minimax), "loss must be one of LeastSquares"),
        (lambda: gmds.solve(PROBLEM, [0]), "4 samples need 4 target points, not 1"),
        (lambda: gmds.solve(PROBLEM, POINTS, max_iterations=-1), "max_iterations must be at least 0"),
        (lambda: gmds.solve(PROBLEM, POINTS, max_iterations=2.5), "max_iterations must be at least 0"),  # type: ignore
        (lambda: gmds.solve(PROBLEM, POINTS, tolerance=np.nan), "tolerance must be a finite number >= 0"),
        (lambda: gmds.solve_by_ladder(PROBLEM, POINTS, tolerance=-1), "tolerance must be a finite number >= 0"),
        (lambda: gmds.solve_multiresolution(PROBLEM, VERTICES[:2], growth=np.inf), "growth must be a finite number"),
        (lambda: gmds.solve_multiresolution(PROBLEM, VERTICES[:2], growth="2"), "growth must be a finite number"),  # type: ignore
        (lambda: gmds.solve_multiresolution(PROBLEM, VERTICES, growth=1), "growth, of the .* must be above 1, not 1"),
        (lambda: gmds.solve_multiresolution(PROBLEM, [0]), "start places 1 of 4 samples: .* first 2 or more"),
        (lambda: gmds.Problem(DISTANCE, VERTICES, DISTANCE, weights=[-1] * 4), "weights must be finite, not negative"),
        (lambda: gmds.Problem(DISTANCE, VERTICES, DISTANCE, weights="area"), "weights must be an array, not 'area'"),
        (lambda: gmds.Huber("a"), "threshold of Huber's loss must be a finite number"),  # type: ignore[arg-type]
        (lambda: gmds.Power("a"), "exponent must be a finite number"),  # type: ignore[arg-type]
        (lambda: caricature(MESH, 1e6), "exponent 1e.06 is too large"),
        (lambda: gmds.TabulatedDistance(MESH), "a distance is expected, not Mesh"),
        (lambda: gmds.TabulatedDistance([DISTANCE]), "a distance is expected, not list"),
        (lambda: gmds.TabulatedDistance(DISTANCE, 10.5), "a table needs 2 landmarks and rank 1 at least, not 10.5"),
        (lambda: gmds.TabulatedDistance(DISTANCE, rank=0), "a table needs 2 landmarks and rank 1 at least"),
        (lambda: gmds.canonical_form([MESH]), "a distance is expected, not list"),
        (lambda: gmds.functional_map([MESH], MESH), "a spectrum is expected, not list"),
        (lambda: gmds.spectral_gmds(MESH, DISTANCE, VERTICES), "a distance is expected, not Mesh"),
        (lambda: gmds.spectral_gmds(DISTANCE, DISTANCE, range(42), count=99), "count must be from 2 to 42, the eigenf"),
        (lambda: gmds.self_functional_map([MESH]), "a mesh is expected, not list"),
        (lambda: gmds.gromov_hausdorff_bounds(MESH, MESH), "distances must be an array, not Mesh$"),
        (lambda: gmds.gromov_wasserstein_bounds(DISTANCE, DISTANCE), "distances must be an array, not CommuteTime"),
        (
            lambda: gmds.gromov_wasserstein_bounds(np.eye(2) * 0, np.eye(2) * 0, order=3),
            "order must be one of 1, 2, not 3",
        ),
        (lambda: gmds.gromov_wasserstein_bounds([[0]], np.eye(2) * 0), "as many samples are needed of both surfaces"),
        (lambda: gmds.gromov_hausdorff_bounds([[0]], np.ones((1, 2))), r"a square matrix, not of shape \(1, 2\)"),
        (lambda: gmds.gromov_hausdorff_bounds([[0]], [[np.inf]]), "distances must be finite: take samples of one comp"),
        (
            lambda: gmds.geodesic_error(gmds.functional_map(MESH, MESH, count=5), POINTS),
            "are expected, not FunctionalMap",
        ),
        (lambda: geodesics.write_mesh("mesh.ply", MESH), "a path is expected after the mesh, not Mesh"),  # type: ignore
        (lambda: gmds.distance_profile([MESH]), "a mesh is expected, not list"),
        (lambda: gmds.least_distortion(MESH, MESH), "must be an array, not Mesh$"),
        (lambda: gmds.least_distortion(np.zeros((2, 3)), np.zeros((2, 3))), "profiles must be of one shape"),
        (lambda: gmds.Correspondence.from_points([MESH], POINTS), "a mesh is expected, not list"),
        (lambda: caricature(MESH, "a"), "exponent must be a finite number, not 'a'"),
        (lambda: gmds.match([], MESH), "a mesh is expected, not list"),
    ],
)
def test_what_would_do_is_told(call: Any, says: str) -> None:
    with pytest.raises((TypeError, ValueError), match=says):
        call()


def test_points_in_one_place_are_no_answer() -> None:
    solution = gmds.solve(PROBLEM, [5, 5, 5, 5])
    assert solution.status is gmds.Status.STALLED and np.isinf(solution.certificate) and solution.stress > 1


def test_a_diffusion_distance_says_its_time() -> None:
    assert "coordinates at time 0.25 on Mesh(42 vertices" in repr(geodesics.DiffusionDistance(MESH, 0.25))
