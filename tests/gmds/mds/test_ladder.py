"""The maximum through powers: lower than without, never below what is certified, and optimal on small problems."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from scipy.optimize import minimize

from geodesics import CommuteTimeDistance, Mesh, SurfacePoints, distance_matrix, eigenpairs, farthest_point_sampling
from geodesics.tracing import walk
from gmds.mds.ladder import EXPONENTS, STEPS, rungs_below, solve_by_ladder
from gmds.mds.losses import Huber, LeastSquares, Minimax, Power
from gmds.mds.problem import Problem
from gmds.mds.solver import Solution, solve

MESH = shapes.bumpy_sphere(3)
BENT = Mesh(MESH.vertices * [1, 1.3, 0.8], MESH.faces)
SOURCE, TARGET = (CommuteTimeDistance(eigenpairs(mesh, 30)) for mesh in (MESH, BENT))


def problem(count: int) -> tuple[Problem, SurfacePoints]:
    """Samples of the one surface, and a start on the other some way off."""
    points = SurfacePoints.at_vertices(MESH, farthest_point_sampling(SOURCE, count))
    there = SurfacePoints(BENT, points.face, points.barycentric)
    return Problem(SOURCE, points, TARGET), walk(there, 0.15 * np.random.default_rng(0).normal(size=(count, 2)))


@pytest.fixture(scope="module")
def found() -> tuple[Problem, SurfacePoints, Solution]:
    asked, start = problem(30)
    return asked, start, solve_by_ladder(asked, start, Minimax(), max_iterations=100)


def test_the_ladder_ends_lower_than_the_maximum_alone(found: tuple[Problem, SurfacePoints, Solution]) -> None:
    asked, start, most = found
    assert most.certificate <= 0.01
    alone = solve(asked, start, Minimax(), max_iterations=100)
    least = solve(asked, start, LeastSquares(), max_iterations=100)
    assert most.stress < alone.stress and most.stress < 0.8 * np.abs(least.residuals).max()


def test_a_maximum_is_never_below_what_every_map_must_have(found: tuple[Problem, SurfacePoints, Solution]) -> None:
    """Each distance from a sample is, within the maximum, one from its image to a point of the target."""
    asked, _, most = found
    ours = distance_matrix(SOURCE, asked.source_points)
    theirs = np.sort(distance_matrix(TARGET, np.arange(BENT.n_vertices)), axis=1)
    nearest = np.array([[nearest_gap(row, other) for other in theirs] for row in ours])
    certified = nearest.min(axis=1).max()
    between = np.diff(theirs, axis=1).max()  # images lie inside faces, and not at vertices
    assert certified > 0 and most.stress * asked.unit > certified - between


def test_of_maps_with_the_same_maximum_the_one_with_less_squares_is_taken() -> None:
    """Beside the maximum alone, from where the ladder ended."""
    asked, start = problem(60)
    most = solve_by_ladder(asked, start, Minimax(), max_iterations=100)
    loose = start
    for power in (2.0, *EXPONENTS):
        loose = solve(asked, loose, Power(power), max_iterations=100 if power == 2 else STEPS).points
    alone = solve(asked, loose, Minimax(), max_iterations=100)
    assert most.stress <= 1.01 * alone.stress and most.certificate <= 0.01
    assert np.mean(most.residuals**2) < 0.98 * np.mean(alone.residuals**2)


def nearest_gap(values: np.ndarray, ascending: np.ndarray) -> float:
    """How far the farthest of some values is from its nearest of others."""
    place = np.searchsorted(ascending, values).clip(1, len(ascending) - 1)
    return float(np.minimum(abs(ascending[place] - values), abs(ascending[place - 1] - values)).max())


def test_a_small_maximum_is_that_of_a_general_nonlinear_program() -> None:
    """Of few samples, each held in its face: SLSQP on the epigraph form finds nothing lower."""
    asked, start = problem(7)
    most = solve_by_ladder(asked, start, Minimax(), max_iterations=200, tolerance=1e-5)
    face = most.points.face

    def residuals(x: np.ndarray) -> np.ndarray:
        b = np.clip(np.column_stack([x[:-1].reshape(-1, 2), 1 - x[:-1].reshape(-1, 2).sum(axis=1)]), 0, 1)
        return asked.at(SurfacePoints(BENT, face, b / b.sum(axis=1, keepdims=True))).residuals

    x0 = np.append(most.points.barycentric[:, :2].ravel(), most.stress)
    inside = {"type": "ineq", "fun": lambda x: 1 - x[:-1].reshape(-1, 2).sum(axis=1)}
    above = {"type": "ineq", "fun": lambda x: np.concatenate([x[-1] - residuals(x), x[-1] + residuals(x)])}
    bounds = [(0, 1)] * 14 + [(0, None)]
    answer = minimize(lambda x: x[-1], x0, method="SLSQP", bounds=bounds, constraints=[inside, above])
    assert np.abs(residuals(answer.x)).max() > 0.98 * most.stress


@pytest.mark.parametrize("loss", [LeastSquares(), Huber(), Power(1.5)])
def test_smooth_losses_are_left_to_the_solver(loss: object) -> None:
    asked, start = problem(12)
    one, other = solve_by_ladder(asked, start, loss), solve(asked, start, loss)  # type: ignore[arg-type]
    assert one.stress == other.stress and np.array_equal(one.points.barycentric, other.points.barycentric)


def test_rungs() -> None:
    assert tuple(rungs_below(Minimax())) == EXPONENTS
    assert rungs_below(Power(16.0)) == [4.0, 8.0] and rungs_below(Power(4.0)) == [] == rungs_below(Huber())
