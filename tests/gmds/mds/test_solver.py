"""Every loss with every distance, on problems whose answer is known."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from test_problem import DISTANCES

from geodesics import (
    CommuteTimeDistance,
    Distance,
    GeodesicDistance,
    Mesh,
    SurfacePoints,
    eigenpairs,
    embedded,
    farthest_point_sampling,
    scale_invariant,
)
from geodesics.tracing import walk
from gmds.errors import SolverError
from gmds.mds.descent import SHORTEST
from gmds.mds.ladder import solve_by_ladder
from gmds.mds.losses import ALL, Huber, LeastSquares, Loss, Minimax
from gmds.mds.many_samples import MANY, solve_many
from gmds.mds.multiresolution import solve_multiresolution
from gmds.mds.problem import Problem
from gmds.mds.prolongation import prolonged, relocated
from gmds.mds.solver import solve
from gmds.mds.status import Status


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return shapes.bumpy_sphere(3)


@pytest.fixture(scope="module", params=DISTANCES, ids=str)
def distance(request: pytest.FixtureRequest, mesh: Mesh) -> Distance:
    return DISTANCES[request.param](mesh)


@pytest.fixture(scope="module")
def commute(mesh: Mesh) -> Distance:
    return DISTANCES["commute time"](mesh)


def samples(distance: Distance, count: int) -> SurfacePoints:
    return SurfacePoints.at_vertices(distance.mesh, farthest_point_sampling(distance, count))


def shaken(points: SurfacePoints, size: float, seed: int = 0) -> SurfacePoints:
    return walk(points, size * np.random.default_rng(seed).normal(size=(len(points), 2)))


def apart(a: SurfacePoints, b: SurfacePoints) -> np.ndarray:
    return np.linalg.norm(a.positions - b.positions, axis=1)


@pytest.mark.parametrize("loss", [make() for make in ALL], ids=repr)
def test_a_shaken_surface_returns_to_itself(loss: Loss, distance: Distance) -> None:
    points = samples(distance, 30)
    start = shaken(points, 0.08)
    problem = Problem(distance, points, distance)
    found = solve(problem, start, loss, max_iterations=150)
    assert loss.value(problem.at(start).residuals) > found.stress >= 0
    assert np.abs(found.residuals).max() < 2e-3
    assert apart(found.points, points).max() < 0.03 * apart(start, points).max() + 1e-3
    assert found.stress == loss.value(found.residuals)
    assert found.points.barycentric.min() >= 0


@pytest.mark.parametrize("loss", [make() for make in ALL], ids=repr)
def test_stress_never_rises(loss: Loss, commute: Distance, mesh: Mesh) -> None:
    other = CommuteTimeDistance(eigenpairs(embedded(shapes.jittered(mesh, 0.3)), 30))
    points = samples(commute, 25)
    start = SurfacePoints(other.mesh, points.face, points.barycentric)
    problem = Problem(commute, points, other)
    stresses = [solve(problem, start, loss, max_iterations=k).stress for k in (1, 2, 3, 5, 8, 13, 30)]
    assert (np.diff([loss.value(problem.at(start).residuals), *stresses]) <= 0).all()
    assert stresses[-1] < 0.7 * stresses[0] or stresses[0] < 1e-3


def test_the_scaled_surface_is_the_same_in_the_scale_invariant_metric(mesh: Mesh) -> None:
    big = shapes.moved(mesh, 137.0)
    a, b = (CommuteTimeDistance(eigenpairs(scale_invariant(m), 25)) for m in (mesh, big))
    points = samples(a, 40)
    truth = SurfacePoints(big, points.face, points.barycentric)
    found = solve(Problem(a, points, b), shaken(truth, 137 * 0.08))
    assert found.status is Status.CONVERGED
    assert apart(found.points, truth).max() < 137 * 1e-3


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_answer_does_not_depend_on_the_size_of_the_surface(scale: float, mesh: Mesh) -> None:
    found = []
    for size in (1.0, scale):
        m = shapes.moved(mesh, size, seed=None)
        d = GeodesicDistance(embedded(m))
        points = SurfacePoints.at_vertices(m, np.arange(0, 600, 25))
        found.append(solve(Problem(d, points, d), shaken(points, 0.1 * size), max_iterations=20))
    assert found[0].stress == pytest.approx(found[1].stress, rel=1e-3, abs=1e-9)
    np.testing.assert_allclose(found[0].points.positions, found[1].points.positions / scale, atol=1e-3)


def test_a_sphere_may_turn() -> None:
    """A start turned by 0.3 stays turned: all rotations are isometries, so only the shaking is undone."""
    sphere = shapes.icosphere(3)
    distance = CommuteTimeDistance(eigenpairs(embedded(sphere), 16))
    points = samples(distance, 40)
    found = solve(Problem(distance, points, distance), shaken(points, 0.1), max_iterations=100)
    a, b = points.positions, found.points.positions
    u, _, vt = np.linalg.svd(a.T @ b)
    assert np.linalg.det(u @ vt) > 0
    assert np.linalg.norm(a @ (u @ vt) - b, axis=1).max() < 0.05
    assert found.stress < 1e-4


def bent(mesh: Mesh) -> Distance:
    """Another surface than `mesh`, with the same faces: no placement without residuals."""
    return CommuteTimeDistance(eigenpairs(embedded(Mesh(mesh.vertices * [1, 1.3, 0.8], mesh.faces)), 30))


def test_minimax_has_the_smaller_maximum_and_a_certificate(commute: Distance, mesh: Mesh) -> None:
    points, target = samples(commute, 40), bent(mesh)
    problem = Problem(commute, points, target)
    least = solve(problem, SurfacePoints(target.mesh, points.face, points.barycentric), max_iterations=100)
    most = solve(problem, least.points, Minimax(), max_iterations=200)
    assert np.abs(most.residuals).max() < 0.95 * np.abs(least.residuals).max()
    assert np.mean(most.residuals**2) > np.mean(least.residuals**2)
    assert most.status is Status.CONVERGED
    assert 0 <= most.certificate <= 0.01
    assert most.certificate_radius > 100 * SHORTEST
    rng = np.random.default_rng(0)
    for size in (1e-4, 1e-3, 1e-2):  # no luck around it either
        for _ in range(100):
            there = problem.at(walk(most.points, size * rng.normal(size=(40, 2))))
            assert np.abs(there.residuals).max() > (1 - 0.01) * most.stress


def test_minimax_of_geodesics_has_a_certificate(mesh: Mesh) -> None:
    source, target = GeodesicDistance(embedded(mesh)), GeodesicDistance(embedded(bent(mesh).mesh))
    points = samples(source, 25)
    problem = Problem(source, points, target)
    start = SurfacePoints(target.mesh, points.face, points.barycentric)
    least = solve(problem, start, max_iterations=100)
    most = solve(problem, least.points, Minimax(), max_iterations=300)
    assert most.stress < np.abs(least.residuals).max()
    assert most.certificate <= 0.01


def test_huber_forgives_a_few_wrong_distances(commute: Distance) -> None:
    points = samples(commute, 40)
    start = shaken(points, 0.03)
    torn = SurfacePoints(points.mesh, start.face, start.barycentric)
    weights = np.ones((40, 40))
    problem = Problem(commute, points, commute, weights)
    wrong = problem.source_distances.copy()
    wrong[::25] *= 1.8
    object.__setattr__(problem, "source_distances", wrong)
    errors = [apart(solve(problem, torn, loss).points, points).mean() for loss in (Huber(0.02), LeastSquares())]
    assert errors[0] < 0.3 * errors[1]


def test_sparse_pairs_find_the_same_answer(commute: Distance) -> None:
    points = samples(commute, 60)
    rng = np.random.default_rng(1)
    pairs = [(i, j) for i in range(60) for j in rng.choice(60, 12, replace=False) if i != j]
    found = solve(Problem(commute, points, commute, pairs=pairs), shaken(points, 0.05))
    assert apart(found.points, points).max() < 1e-3


def test_multiresolution_places_all_samples_from_a_few(commute: Distance) -> None:
    points = samples(commute, 80)
    seen: list[float] = []
    found = solve_multiresolution(
        Problem(commute, points, commute), shaken(points[:8], 0.1), progress=lambda stage, f: seen.append(f)
    )
    assert apart(found.points, points).max() < 1e-3
    assert seen == sorted(seen) and seen[-1] == 1
    with pytest.raises(ValueError, match="0 of 80"):
        solve_multiresolution(Problem(commute, points, commute), points[:0])


@pytest.mark.parametrize("loss", [LeastSquares(), Huber()])
def test_many_samples_are_placed_by_the_first(commute: Distance, loss: Loss) -> None:
    points = samples(commute, 200)
    problem, start = Problem(commute, points, commute), shaken(points, 0.1)
    found = solve_many(problem, start, loss, heads=40)
    assert apart(found.points, points).max() < 1e-3
    assert len(found.residuals) == 200 * 199 / 2


def test_many_samples_end_about_as_low_as_all_at_once(commute: Distance, mesh: Mesh) -> None:
    bent = Mesh(mesh.vertices * [1, 1.3, 0.8], mesh.faces)
    there, points = CommuteTimeDistance(eigenpairs(bent, 30)), samples(commute, 150)
    problem = Problem(commute, points, there)
    start = shaken(SurfacePoints(bent, points.face, points.barycentric), 0.1)
    assert solve_many(problem, start, heads=50).stress < 1.15 * solve(problem, start).stress


def test_many_samples_asked_for_by_the_first_alone_end_as_low_in_all_pairs(commute: Distance, mesh: Mesh) -> None:
    """The problem has no pair but those to the first; the stress of all pairs is a fiftieth above at the most."""
    bent = Mesh(mesh.vertices * [1, 1.3, 0.8], mesh.faces)
    there, points = CommuteTimeDistance(eigenpairs(bent, 30)), samples(commute, 150)
    start = shaken(SurfacePoints(bent, points.face, points.barycentric), 0.1)
    every, few = Problem(commute, points, there), Problem(commute, points, there, pairs=50)
    found, known = solve_many(few, start, heads=50), solve_many(every, start, heads=50)
    assert len(found.residuals) == 50 * 49 / 2 + 50 * 100
    assert LeastSquares().value(every.at(found.points).residuals) < 1.02 * known.stress


def test_samples_that_the_first_do_not_reach_stay_where_they_started() -> None:
    both = shapes.joined(shapes.bumpy_sphere(2), shapes.torus(24, 12))
    distance = GeodesicDistance(embedded(both))
    sphere = np.arange(shapes.bumpy_sphere(2).n_vertices)
    chosen = np.concatenate([sphere[:20], [sphere[-1] + 1, sphere[-1] + 30]])
    points = SurfacePoints.at_vertices(both, chosen)
    found = solve_many(Problem(distance, points, distance), points, heads=20)
    assert apart(found.points, points).max() < 1e-6


def test_the_ladder_takes_many_samples_by_the_first(commute: Distance, monkeypatch: pytest.MonkeyPatch) -> None:
    points = samples(commute, 60)
    problem, start = Problem(commute, points, commute), shaken(points, 0.05)
    monkeypatch.setattr("gmds.mds.ladder.MANY", 59)
    found = solve_by_ladder(problem, start, LeastSquares())
    assert found.stress == solve_many(problem, start).stress and MANY > 500


def test_prolongation_finds_vertices_by_their_distances(distance: Distance) -> None:
    placed, new = samples(distance, 20), SurfacePoints.at_vertices(distance.mesh, [5, 77, 300])
    found = prolonged(distance.field(placed)[:, [5, 77, 300]].T, distance, placed)
    np.testing.assert_allclose(found.positions, new.positions)


def test_relocation_brings_back_lost_samples(commute: Distance) -> None:
    points = samples(commute, 40)
    problem = Problem(commute, points, commute)
    face = points.face.copy()
    face[[3, 17]] = face[[30, 5]]
    lost = SurfacePoints(
        points.mesh, face, np.where(np.isin(np.arange(40), [3, 17])[:, None], 1 / 3, points.barycentric)
    )
    helped = relocated(problem.at(lost), rounds=6)
    assert apart(lost, points).max() > 0.5
    assert apart(helped.points, points).max() < 1e-12
    untouched = problem.at(points)
    assert relocated(untouched) is untouched


def test_boundaries_and_components(mesh: Mesh) -> None:
    for m in (shapes.cylinder(), shapes.joined(shapes.bumpy_sphere(2), shapes.torus(24, 12))):
        d = GeodesicDistance(embedded(m))
        points = samples(d, 30)
        found = solve(Problem(d, points, d), shaken(points, 0.05), Huber())
        assert np.isfinite(found.residuals).all() and found.stress < 1e-3


def test_progress_is_told_and_may_stop_the_solver(commute: Distance) -> None:
    points = samples(commute, 20)
    problem, start = Problem(commute, points, commute), shaken(points, 0.1)
    told: list[tuple[str, float]] = []
    solve(problem, start, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert {stage for stage, _ in told} == {"embedding"}
    assert all(0 < fraction <= 1 for _, fraction in told)

    def stop(stage: str, fraction: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solve(problem, start, progress=stop)


def test_iteration_limit_is_told(commute: Distance) -> None:
    points = samples(commute, 20)
    found = solve(Problem(commute, points, commute), shaken(points, 0.1), max_iterations=1)
    assert found.status is Status.ITERATION_LIMIT
    assert found.iterations == 1 and found.certificate == np.inf
    assert all(" " in status.value for status in Status)
    assert repr(found).startswith("Solution(20 points, stress ") and "\n" not in repr(Problem(commute, points, commute))


class Broken:
    """A distance that is not a number near the last vertex."""

    def __init__(self, distance: Distance, bad: int) -> None:
        self.mesh, self.embedding = distance.mesh, distance.embedding.copy()  # type: ignore[attr-defined]
        self.embedding[bad] = np.nan

    def field(self, points: SurfacePoints) -> np.ndarray:
        raise NotImplementedError


def test_distances_that_are_not_numbers(commute: Distance) -> None:
    points = samples(commute, 20)
    with pytest.raises(SolverError, match="E403"):
        solve(Problem(commute, points, Broken(commute, int(points.nearest_vertices()[0]))), points)
    start = shaken(points, 0.1)
    near = int(np.setdiff1d(points.nearest_vertices(), start.mesh.faces[start.face])[0])  # on somebody's way home
    problem = Problem(commute, points, Broken(commute, near))
    found = solve(problem, start)
    assert np.isfinite(found.stress) and found.stress < 0.9 * LeastSquares().value(problem.at(start).residuals)


def test_the_same_problem_gives_the_same_numbers(commute: Distance) -> None:
    points = samples(commute, 30)
    problem, start = Problem(commute, points, commute), shaken(points, 0.1)
    for loss in (Huber(), Minimax()):
        a, b = (solve(problem, start, loss, max_iterations=6) for _ in range(2))
        np.testing.assert_array_equal(a.points.barycentric, b.points.barycentric)
        np.testing.assert_array_equal(a.points.face, b.points.face)
