"""What is made for many samples grows with their number, gives the same numbers, or is refused with advice."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import generated_shapes as shapes
import numpy as np
import pytest
from scipy.optimize import linprog
from test_problem import DISTANCES, inner_points
from test_solver import apart, samples, shaken

import gmds
from geodesics import CommuteTimeDistance, GeodesicDistance, Mesh, SurfacePoints, eigenpairs, memory
from geodesics.errors import WouldExceedMemory
from geodesics.points import joined
from gmds.mds import field_pairs, multiresolution, prolongation
from gmds.mds.certificate import certified, of_all_pairs
from gmds.mds.descent import CERTIFIED
from gmds.mds.losses import LeastSquares, Loss, Minimax
from gmds.mds.many_samples import pairs_suffice, solve_many
from gmds.mds.pair_distances import distances_to, lengths_between, pairwise
from gmds.mds.prolongation import relocated
from gmds.mds.solver import solve

MESH = shapes.bumpy_sphere(3)
COMMUTE = DISTANCES["commute time"](MESH)
BENT = CommuteTimeDistance(eigenpairs(Mesh(MESH.vertices * [1, 1.3, 0.8], MESH.faces), 30))


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forty samples are many, and ten of them the first."""
    for name, value in {"MANY": 40, "HEADS": 10}.items():
        monkeypatch.setattr(multiresolution, name, value)


@pytest.mark.usefixtures("few")
def test_multiresolution_of_many_samples_looks_at_pairs_with_the_first() -> None:
    points = samples(COMMUTE, 120)
    for pairs in (None, 10):
        problem = gmds.Problem(COMMUTE, points, COMMUTE, pairs=pairs)
        found = gmds.solve_multiresolution(problem, shaken(points[:10], 0.1))
        assert apart(found.points, points).max() < 1e-3
        assert len(found.residuals) == len(problem.first)


def test_multiresolution_by_the_first_ends_about_as_low_as_by_all(monkeypatch: pytest.MonkeyPatch) -> None:
    points = samples(COMMUTE, 150)
    problem = gmds.Problem(COMMUTE, points, BENT)
    start = SurfacePoints(BENT.mesh, points.face, points.barycentric)[:40]
    every = gmds.solve_multiresolution(problem, start)
    for name in ("MANY", "HEADS"):
        monkeypatch.setattr(multiresolution, name, 50)
    assert gmds.solve_multiresolution(problem, start).stress < 1.15 * every.stress


@pytest.mark.usefixtures("few")
def test_memory_of_multiresolution_grows_with_samples_and_not_with_their_square(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A table of 2,000 by 2,000 samples alone would take 32 MB."""
    monkeypatch.setattr(prolongation, "ROWS", 16)
    mesh = shapes.icosphere(4)
    distance, peaks = CommuteTimeDistance(eigenpairs(mesh, 12)), []
    order = np.random.default_rng(0).permutation(mesh.n_vertices)
    for count in (10, 1000, 2000):  # the first leaves nothing to compute once
        problem = gmds.Problem(distance, order[:count], distance, pairs=10)
        tracemalloc.start()
        gmds.solve_multiresolution(problem, order[: min(count, 500)], max_iterations=2)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[2] < 2.2 * peaks[1] and peaks[2] < 16e6


def test_samples_are_moved_where_they_fare_best_by_the_first() -> None:
    points = samples(COMMUTE, 40)
    problem = gmds.Problem(COMMUTE, points, COMMUTE, pairs=15)
    lost = points.nearest_vertices()
    lost[[17, 33]] = lost[[30, 5]]
    helped = relocated(problem.at(lost), rounds=6, heads=15)
    assert apart(SurfacePoints.at_vertices(MESH, lost), points).max() > 0.5
    assert apart(helped.points, points).max() < 1e-12


def test_samples_are_sent_all_over_a_surface_of_many_vertices(monkeypatch: pytest.MonkeyPatch) -> None:
    points = samples(COMMUTE, 40)
    problem = gmds.Problem(COMMUTE, points, COMMUTE)
    lost = points.nearest_vertices()
    lost[[3, 17]] = lost[[30, 5]]
    monkeypatch.setattr(prolongation, "GOALS", 300)
    helped = relocated(problem.at(lost), rounds=6)
    assert 0 < apart(helped.points, points).max() < 0.2  # the vertex itself may not be among them


def test_fields_made_from_some_points_at_a_time_are_those_of_all(monkeypatch: pytest.MonkeyPatch) -> None:
    two = shapes.joined(shapes.bumpy_sphere(2), shapes.torus(24, 12))
    distance, points = GeodesicDistance(two), inner_points(two, 30)
    first, second = np.triu_indices(30, 1)
    table = pairwise(distance, points).distances()
    assert np.isinf(table).any() and np.isfinite(table[first, second]).any()
    monkeypatch.setattr(field_pairs, "FIELDS", 7 * two.n_vertices)
    np.testing.assert_array_equal(lengths_between(distance, points, first, second), table[first, second])


@pytest.mark.parametrize("name", ["geodesic", "commute time", "tabulated geodesic"])
def test_what_cannot_be_reached_is_infinitely_far(name: str) -> None:
    two = shapes.joined(shapes.bumpy_sphere(2), shapes.torus(24, 12))
    points, half = inner_points(two, 30), shapes.bumpy_sphere(2).n_faces
    first, second = np.triu_indices(30, 1)
    apart_ = (points.face[first] < half) != (points.face[second] < half)
    for some in (slice(None), slice(0, 40)):  # by products, and one by one
        lengths = pairwise(DISTANCES[name](two), points).lengths(first[some], second[some])
        np.testing.assert_array_equal(np.isinf(lengths), apart_[some])
    assert np.array_equal(np.isinf(pairwise(DISTANCES[name](two), points).distances()[first, second]), apart_)


def test_what_does_not_fit_is_refused_with_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = shapes.icosphere(5)
    vertices, marched = np.arange(3000), GeodesicDistance(mesh)
    commute = CommuteTimeDistance(eigenpairs(mesh, 4))
    monkeypatch.setattr(memory, "available", lambda: 1.1e8)
    with pytest.raises(WouldExceedMemory, match=r"E501.*all pairs of 3000 samples need 0\.1 GB.*`pairs=250`"):
        gmds.Problem(commute, vertices, commute)
    problem = gmds.Problem(commute, vertices, marched, pairs=3)
    with pytest.raises(WouldExceedMemory, match=r"E501.*fields of all samples.*`gmds\.TabulatedDistance`"):
        gmds.solve(problem, vertices)


@pytest.mark.parametrize("name", ["geodesic", "commute time", "tabulated geodesic"])
def test_distances_to_some_vertices_are_those_of_fields(name: str) -> None:
    two = shapes.joined(shapes.bumpy_sphere(2), shapes.torus(24, 12))
    distance, points = DISTANCES[name](two), inner_points(two, 30)
    vertices = np.arange(0, two.n_vertices, 7)
    there = SurfacePoints.at_vertices(two, vertices)
    expected = pairwise(distance, joined(points, there)).distances()[:30, 30:]
    if name == "geodesic":  # which is the mean of both fields there
        expected = distance.field(points)[:, vertices]
    found = distances_to(distance, points, vertices)
    assert np.array_equal(np.isinf(found), np.isinf(expected)) and np.isinf(found).any()
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_samples_that_know_nothing_of_each_other_wait_for_others() -> None:
    """The first two lie in two components: there is nothing to solve before the next ones come."""
    two = shapes.joined(shapes.bumpy_sphere(2), shapes.bumpy_sphere(2))
    distance, half = GeodesicDistance(two), two.n_vertices // 2
    vertices = np.array([0, half, 40, half + 40, 90, half + 90, 120, half + 120])
    found = gmds.solve_multiresolution(gmds.Problem(distance, vertices, distance), vertices[:2])
    assert np.isfinite(found.stress) and found.stress < 0.01


def test_chosen_pairs_that_pass_the_first_by_are_solved_at_once() -> None:
    """Each sample with its neighbours in the list: those with the first ten know nothing of the others."""
    points = samples(COMMUTE, 60)
    ring = [(i, (i + step) % 60) for i in range(60) for step in range(1, 9)]
    problem, start = gmds.Problem(COMMUTE, points, COMMUTE, pairs=ring), shaken(points, 0.05)
    assert (
        not pairs_suffice(problem, 10) and solve_many(problem, start, heads=10).stress == solve(problem, start).stress
    )
    assert pairs_suffice(gmds.Problem(COMMUTE, points, COMMUTE), 10)
    assert pairs_suffice(gmds.Problem(COMMUTE, points, COMMUTE, pairs=10), 10)


@pytest.mark.parametrize("loss", [LeastSquares(), Minimax()], ids=repr)
def test_a_certificate_of_some_pairs_bounds_that_of_all(loss: Loss) -> None:
    """Whatever the linearised problem of all pairs can do, the bound by some of them allows."""
    points = samples(COMMUTE, 40)
    problem = gmds.Problem(COMMUTE, points, BENT)
    start = SurfacePoints(BENT.mesh, points.face, points.barycentric)
    for steps in (1, 5, 40):
        found = solve(problem.anchored(15), start, loss, max_iterations=steps)
        told = of_all_pairs(problem, problem.anchored(15), found, loss)
        known = certified(problem, replace(told, certificate=np.inf), loss)
        assert 0 <= known.certificate <= told.certificate + 1e-9 <= 1
        assert told.stress == loss.value(told.residuals) and len(told.residuals) == 40 * 39 / 2


def test_a_certificate_at_the_iteration_limit_is_what_a_linear_program_leaves() -> None:
    points = SurfacePoints(MESH, samples(COMMUTE, 12).face, np.full((12, 3), 1 / 3))
    problem = gmds.Problem(COMMUTE, points, BENT)
    start = SurfacePoints(BENT.mesh, points.face, points.barycentric)
    found = solve(problem, start, Minimax(), max_iterations=0)
    assert found.certificate == np.inf and "no certificate" in repr(found)
    told = certified(problem, found, Minimax())
    here = problem.at(start)
    jacobian = here.walled_jacobian
    rows = jacobian.rows(np.arange(len(problem.first))).toarray()
    weight, slope = here.points.barycentric, jacobian.walls[1]  # type: ignore[index]
    sides = np.zeros((36, 24))
    for point in range(12):
        sides[3 * point : 3 * point + 3, 2 * point : 2 * point + 2] = -slope[point]
    above = np.hstack([np.vstack([rows, -rows]), -np.ones((2 * len(rows), 1))])
    matrix = np.vstack([above, np.hstack([sides, np.zeros((36, 1))])])
    bound = np.concatenate([-here.residuals, here.residuals, weight.ravel()])
    answer = linprog(np.append(np.zeros(24), 1.0), matrix, bound, bounds=[(-CERTIFIED, CERTIFIED)] * 24 + [(0, None)])
    assert told.certificate_radius == CERTIFIED
    assert told.certificate == pytest.approx(1 - answer.fun / found.stress, rel=0.02)  # IDLE_COST gives some away


def test_the_ladder_has_a_certificate_at_the_iteration_limit() -> None:
    points = samples(COMMUTE, 30)
    problem = gmds.Problem(COMMUTE, points, BENT)
    start = shaken(SurfacePoints(BENT.mesh, points.face, points.barycentric), 0.1)
    for loss in (LeastSquares(), Minimax()):
        assert 0 <= gmds.solve_by_ladder(problem, start, loss, max_iterations=2).certificate < 1
