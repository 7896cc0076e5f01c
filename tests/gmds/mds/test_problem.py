"""Residuals and their derivative, for every kind of distance."""

from __future__ import annotations

from collections.abc import Callable

import generated_shapes as shapes
import numpy as np
import pytest
from numpy.typing import NDArray

from geodesics import (
    BiharmonicDistance,
    CommuteTimeDistance,
    DiffusionDistance,
    Distance,
    GeodesicDistance,
    Mesh,
    SurfacePoints,
    eigenpairs,
    embedded,
    farthest_point_sampling,
    scale_invariant,
)
from geodesics.points import joined, mixed
from geodesics.tracing import walk
from gmds._kernels import jacobian as kernel
from gmds.mds.frozen_fields import frozen
from gmds.mds.pair_distances import pairwise
from gmds.mds.problem import Problem
from gmds.mds.tabulated import TabulatedDistance

DISTANCES: dict[str, Callable[[Mesh], Distance]] = {
    "commute time": lambda m: CommuteTimeDistance(eigenpairs(embedded(m), 30)),
    "diffusion": lambda m: DiffusionDistance(eigenpairs(embedded(m), 30), 0.01),
    "biharmonic": lambda m: BiharmonicDistance(eigenpairs(embedded(m), 30)),
    "scale-invariant commute time": lambda m: CommuteTimeDistance(eigenpairs(scale_invariant(m), 30)),
    "geodesic": lambda m: GeodesicDistance(embedded(m)),
    "tabulated geodesic": lambda m: TabulatedDistance(GeodesicDistance(embedded(m)), 120, 60),
}


def inner_points(mesh: Mesh, count: int, seed: int = 0) -> SurfacePoints:
    """Points spread over the surface, away from edges."""
    rng = np.random.default_rng(seed)
    face = rng.choice(mesh.n_faces, count, replace=False)
    return SurfacePoints(mesh, face, 0.4 * rng.dirichlet([1, 1, 1], count) + 0.2)


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return shapes.bumpy_sphere(3)


@pytest.fixture(scope="module", params=DISTANCES, ids=str)
def distance(request: pytest.FixtureRequest, mesh: Mesh) -> Distance:
    return DISTANCES[request.param](mesh)


def test_derivatives_agree_with_central_differences(distance: Distance, mesh: Mesh) -> None:
    source, target = inner_points(mesh, 12), inner_points(mesh, 12, seed=1)
    here = Problem(distance, source, distance).at(target)
    if isinstance(distance, GeodesicDistance):
        here = frozen(here)
    h, worst = 1e-5, 0.0
    for point in range(12):
        for axis in range(2):
            step = np.zeros((12, 2))
            step[point, axis] = h
            change = here.problem.at(walk(target, step)).residuals - here.problem.at(walk(target, -step)).residuals
            touched = (here.problem.first == point, here.problem.second == point)
            exact = sum(np.where(mask, here.derivatives[:, side, axis], 0) for side, mask in enumerate(touched))
            worst = max(worst, np.abs(change / (2 * h) - exact).max())
    assert worst < 1e-5 * np.abs(here.derivatives).max()


def test_the_jacobian_foretells_a_joint_step_to_second_order(distance: Distance, mesh: Mesh) -> None:
    target = inner_points(mesh, 12, seed=1)
    here = Problem(distance, inner_points(mesh, 12), distance).at(target)
    if isinstance(distance, GeodesicDistance):
        here = frozen(here)
    direction = np.random.default_rng(2).normal(size=(12, 2))
    errors = []
    for size in (1e-3, 5e-4):
        there = here.problem.at(walk(target, here.jacobian.displacement(size * direction)))
        errors.append(np.abs(there.residuals - here.residuals - here.jacobian.apply(size * direction)).max())
    assert errors[1] < 0.3 * errors[0] or errors[0] < 1e-10


def test_marched_fields_have_the_derivative_of_marched_distances(mesh: Mesh) -> None:
    """Of fields marched anew: the marching itself is only approximate, so is the agreement."""
    distance = GeodesicDistance(embedded(mesh))
    target = inner_points(mesh, 10, seed=1)
    here = Problem(distance, inner_points(mesh, 10), distance).at(target)
    step = np.random.default_rng(3).normal(size=(10, 2))
    h = 0.01
    change = here.problem.at(walk(target, h * step)).residuals - here.problem.at(walk(target, -h * step)).residuals
    first, second = here.problem.first, here.problem.second
    exact = np.einsum("rsx,rsx->r", here.derivatives, np.stack([step[first], step[second]], axis=1))
    assert np.abs(change / (2 * h) - exact).mean() < 0.05 * np.abs(exact).mean()


def test_distances_between_points_are_those_of_the_fields(distance: Distance, mesh: Mesh) -> None:
    vertices = np.arange(0, mesh.n_vertices, 40)
    points = SurfacePoints.at_vertices(mesh, vertices)
    field = distance.field(points)[:, vertices]
    between = pairwise(distance, points).distances()
    np.testing.assert_array_equal(between, between.T)
    assert (np.diagonal(between) == 0).all()
    tolerance = 0.05 if isinstance(distance, TabulatedDistance) else 1e-9
    assert np.abs(between - 0.5 * (field + field.T)).max() < tolerance * field.max()


def test_a_surface_placed_on_itself_has_no_residuals(distance: Distance, mesh: Mesh) -> None:
    points = inner_points(mesh, 20)
    assert np.abs(Problem(distance, points, distance).at(points).residuals).max() < 1e-12


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_residuals_have_no_dimension(scale: float, mesh: Mesh) -> None:
    big = shapes.moved(mesh, scale)
    source, target = inner_points(mesh, 15), inner_points(mesh, 15, seed=1)
    values = []
    for m in (mesh, big):
        d = DISTANCES["geodesic"](m)
        here = Problem(d, SurfacePoints(m, source.face, source.barycentric), d).at(
            SurfacePoints(m, target.face, target.barycentric)
        )
        values.append((here.residuals, here.jacobian.blocks))
    np.testing.assert_allclose(values[0][0], values[1][0], atol=1e-8)
    np.testing.assert_allclose(values[0][1], values[1][1], atol=1e-7)


def test_a_unit_step_changes_geodesic_distances_by_about_one(mesh: Mesh) -> None:
    distance = GeodesicDistance(embedded(mesh))
    jacobian = Problem(distance, inner_points(mesh, 60), distance).at(inner_points(mesh, 60)).jacobian
    stretch = np.linalg.svd(jacobian.frames)[1]
    unit = np.mean(np.linalg.norm(jacobian.blocks, axis=2))
    assert 0.8 < unit < 1.2
    assert (stretch[:, 0] / stretch[:, 1]).max() < 3


def test_pairs_out_of_reach_are_left_out_or_count_as_far() -> None:
    two = shapes.joined(shapes.icosphere(2), shapes.icosphere(2))
    half = two.n_vertices // 2
    points = SurfacePoints.at_vertices(two, [0, 20, 40, half, half + 20, half + 40])
    for make in (DISTANCES["geodesic"], DISTANCES["commute time"], DISTANCES["tabulated geodesic"]):
        distance = make(two)
        problem = Problem(distance, points, distance)
        assert len(problem.first) == 6 and np.isfinite(problem.source_distances).all()
        assert np.abs(problem.at(points).residuals).max() < 1e-9
        torn = problem.at(SurfacePoints.at_vertices(two, [0, 20, half + 80, half, half + 20, half + 40]))
        assert np.isfinite(torn.residuals).all() and np.isfinite(torn.jacobian.blocks).all()
        assert torn.residuals.min() < -1.5


def test_weights_and_chosen_pairs(mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    points, there = inner_points(mesh, 8), inner_points(mesh, 8, seed=1)
    plain = Problem(distance, points, distance).at(there)
    w = np.random.default_rng(4).uniform(0.5, 2, 8)
    weighted = Problem(distance, points, distance, weights=w).at(there)
    table = Problem(distance, points, distance, weights=np.outer(w, w) * 7).at(there)
    pair = w[plain.problem.first] * w[plain.problem.second]
    np.testing.assert_allclose(weighted.residuals, plain.residuals * np.sqrt(pair / pair.mean()))
    np.testing.assert_allclose(table.residuals, weighted.residuals)
    some = Problem(distance, points, distance, pairs=[[3, 1], [0, 2], [1, 3]])
    assert some.first.tolist() == [0, 1] and some.second.tolist() == [2, 3]
    raw = some.at(there).residuals * some.unit
    expected = plain.residuals * plain.problem.unit
    np.testing.assert_allclose(raw, [expected[1], expected[8]])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"weights": [1.0, 2.0]}, r"\(8,\) or \(8, 8\)"),
        ({"weights": [-1.0] + [1.0] * 7}, "not negative"),
        ({"weights": [np.nan] * 8}, "finite"),
        ({"weights": lambda lengths: lengths[:3]}, "28 distances"),
        ({"pairs": 0}, "1 of the first"),
        ({"pairs": [[0, 8]]}, "0 .. 7"),
        ({"pairs": [[1, 1]]}, "two different"),
        ({"pairs": [[0.0, 1.0]]}, "whole numbers"),
        ({"pairs": np.zeros((0, 2), dtype=int)}, "at least two"),
    ],
)
def test_bad_problems_are_refused(arguments: dict, message: str, mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    with pytest.raises(ValueError, match=message):
        Problem(distance, inner_points(mesh, 8), distance, **arguments)


def test_points_that_do_not_fit_are_refused(mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    problem = Problem(distance, inner_points(mesh, 8), distance)
    with pytest.raises(ValueError, match="not 7"):
        problem.at(inner_points(mesh, 7))
    with pytest.raises(ValueError, match="another mesh"):
        problem.at(inner_points(shapes.icosphere(2), 8))


def test_head_is_the_problem_of_the_first_samples(mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    points, there = inner_points(mesh, 9), inner_points(mesh, 9, seed=1)
    whole, part = Problem(distance, points, distance), Problem(distance, points[:5], distance)
    head = whole.head(5)
    np.testing.assert_allclose(head.at(there[:5]).residuals * head.unit, part.at(there[:5]).residuals * part.unit)
    table = head.distance_table()
    assert table.shape == (5, 5) and np.isnan(np.diagonal(table)).all()


def test_mixed_and_joined_points(mesh: Mesh) -> None:
    a, b = inner_points(mesh, 4), inner_points(mesh, 4, seed=1)
    choice = np.array([True, False, True, False])
    np.testing.assert_array_equal(mixed(choice, a, b).face, [a.face[0], b.face[1], a.face[2], b.face[3]])
    np.testing.assert_array_equal(joined(a, b).positions, np.concatenate([a.positions, b.positions]))


def test_the_table_of_geodesics_is_close_to_the_geodesics(mesh: Mesh) -> None:
    exact = GeodesicDistance(embedded(mesh))
    sample = SurfacePoints.at_vertices(mesh, farthest_point_sampling(exact, 40))
    truth = pairwise(exact, sample).distances()
    errors = []
    for landmarks in (40, 160):
        table = pairwise(TabulatedDistance(exact, landmarks, landmarks), sample).distances()
        errors.append(np.abs(table - truth).mean() / truth.mean())
    assert errors[1] < 0.003 and errors[1] < errors[0]
    with pytest.raises(ValueError, match="2 landmarks"):
        TabulatedDistance(exact, 1)


# ---- naive twins of the kernels


@pytest.fixture
def pairs() -> tuple[NDArray, NDArray, NDArray, NDArray]:
    rng = np.random.default_rng(5)
    first, second = np.triu_indices(7, 1)
    dense = np.zeros((len(first), 7, 2))
    blocks = rng.normal(size=(len(first), 2, 2))
    dense[np.arange(len(first)), first], dense[np.arange(len(first)), second] = blocks[:, 0], blocks[:, 1]
    return first, second, blocks, dense.reshape(len(first), 14)


def test_products_agree_with_a_dense_matrix(pairs: tuple[NDArray, NDArray, NDArray, NDArray]) -> None:
    first, second, blocks, dense = pairs
    rng = np.random.default_rng(6)
    step, rows, weights = rng.normal(size=(7, 2)), rng.normal(size=21), rng.uniform(size=21)
    np.testing.assert_allclose(kernel.multiply(first, second, blocks, step), dense @ step.ravel())
    transposed = kernel.multiply_transposed(first, second, blocks, rows, 7)
    np.testing.assert_allclose(transposed.ravel(), dense.T @ rows)
    normal = kernel.weighted_normal(first, second, blocks, weights, step)
    np.testing.assert_allclose(normal.ravel(), dense.T @ (weights * (dense @ step.ravel())))


def test_moments_and_frames_agree_with_a_dense_matrix(pairs: tuple[NDArray, NDArray, NDArray, NDArray]) -> None:
    first, second, blocks, dense = pairs
    moments = kernel.second_moments(first, second, blocks, 7)
    columns = dense.reshape(21, 7, 2)
    outer = np.einsum("rpx,rpy->pxy", columns, columns)
    np.testing.assert_allclose(moments, outer.reshape(7, 4)[:, [0, 1, 3]])
    frames = np.random.default_rng(7).normal(size=(7, 2, 2))
    changed = kernel.change_frames(first, second, blocks, frames)
    np.testing.assert_allclose(changed[:, 0], np.einsum("rx,rxy->ry", blocks[:, 0], frames[first]))
    np.testing.assert_allclose(changed[:, 1], np.einsum("rx,rxy->ry", blocks[:, 1], frames[second]))


def test_chosen_pairs_are_those_of_all(distance: Distance, mesh: Mesh) -> None:
    """Few pairs are measured one by one, many by products of matrices: the same numbers."""
    points, chosen = inner_points(mesh, 20), np.array([[0, 3], [2, 17], [5, 19], [3, 11]])
    every = Problem(distance, points, distance).at(inner_points(mesh, 20, seed=1))
    some = Problem(distance, points, distance, pairs=chosen).at(inner_points(mesh, 20, seed=1))
    place = [
        int(np.flatnonzero((every.problem.first == i) & (every.problem.second == j))[0]) for i, j in np.sort(chosen)
    ]
    place.sort()
    np.testing.assert_allclose(some.lengths, every.lengths[place], rtol=1e-9)
    np.testing.assert_allclose(
        some.residuals * some.problem.unit, every.residuals[place] * every.problem.unit, atol=1e-9
    )
    ratio = every.problem.unit / some.problem.unit
    np.testing.assert_allclose(some.derivatives, every.derivatives[place] * ratio, rtol=1e-7, atol=1e-10)
    table = pairwise(distance, inner_points(mesh, 20, seed=1)).distances()
    np.testing.assert_allclose(every.lengths, table[every.problem.first, every.problem.second], rtol=1e-9)


def test_pairs_of_the_first_samples_are_asked_for_by_their_number(distance: Distance, mesh: Mesh) -> None:
    points, there = inner_points(mesh, 9), inner_points(mesh, 9, seed=1)
    first, second = np.triu_indices(9, 1)
    chosen = np.stack([first, second], axis=1)[first < 3]
    few, named = (Problem(distance, points, distance, pairs=pairs) for pairs in (3, chosen))
    np.testing.assert_array_equal(np.stack([few.first, few.second]), np.stack([named.first, named.second]))
    np.testing.assert_array_equal(few.at(there).residuals, named.at(there).residuals)
    assert len(Problem(distance, points, distance, pairs=100).first) == len(first)


def test_weights_may_be_made_of_the_distances(mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    points = inner_points(mesh, 9)
    table = pairwise(distance, points).distances()
    made = Problem(distance, points, distance, lambda lengths: lengths**2)
    np.testing.assert_allclose(made.root_weights, Problem(distance, points, distance, table**2).root_weights)


def test_anchored_problems_have_the_pairs_of_the_first(mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    problem = Problem(distance, inner_points(mesh, 9), distance)
    part = problem.anchored(3)
    assert len(part) == 9 and part.unit == problem.unit and (part.first < 3).all() and len(part.first) == 3 + 3 * 6
    np.testing.assert_allclose(part.total_weights, [8, 8, 8, *[3] * 6])


def test_sparse_rows_are_rows_of_the_jacobian(mesh: Mesh) -> None:
    distance = DISTANCES["commute time"](mesh)
    jacobian = Problem(distance, inner_points(mesh, 9), distance).at(inner_points(mesh, 9, seed=1)).jacobian
    step, index = np.random.default_rng(8).normal(size=(9, 2)), np.array([3, 7, 20])
    np.testing.assert_allclose(jacobian.rows(index) @ step.ravel(), jacobian.apply(step)[index])
