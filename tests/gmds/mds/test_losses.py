"""Every loss: its value, its derivative, and its step, against independent solvers of the linearised problem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog, minimize

from gmds.mds.jacobian import Jacobian, scaled
from gmds.mds.losses import ALL, Huber, LeastSquares, Loss, Minimax, Power, SmoothLoss

SMOOTH = [LeastSquares(), Huber(0.3), Power(4.0), Power(1.5), Power(1.0, 0.05)]
LOSSES = [make() for make in ALL] + SMOOTH


def linear_problem(count: int = 9, seed: int = 0) -> tuple[Jacobian, NDArray]:
    rng = np.random.default_rng(seed)
    first, second = np.triu_indices(count, 1)
    raw = rng.normal(size=(len(first), 2, 2))
    weight = np.full(count, count - 1.0)
    return scaled(first, second, raw, count, weight), rng.normal(size=len(first))


@pytest.mark.parametrize("loss", LOSSES, ids=repr)
def test_value_is_zero_only_without_residuals_and_even(loss: Loss) -> None:
    r = np.random.default_rng(0).normal(size=50)
    assert loss.value(np.zeros(50)) == 0
    assert loss.value(r) == loss.value(-r) > 0
    assert loss.value(2 * r) > loss.value(r)


@pytest.mark.parametrize("loss", SMOOTH, ids=repr)
def test_slope_and_curvature(loss: SmoothLoss) -> None:
    """The slope is the derivative of rho; the curvature is positive and no less than the second derivative."""
    r = np.linspace(-2, 2, 401) + 1e-3
    slope = (loss.rho(r + 1e-6) - loss.rho(r - 1e-6)) / 2e-6
    np.testing.assert_allclose(loss.slope(r), slope, atol=1e-4)
    assert (loss.curvature(r) > 0).all()
    second = (loss.slope(r + 1e-6) - loss.slope(r - 1e-6)) / 2e-6
    assert (loss.curvature(r) >= second - 1e-3 * np.abs(second) - 1e-6).all()


@pytest.mark.parametrize("loss", LOSSES, ids=repr)
@pytest.mark.parametrize("radius", [1e-4, 1e-2, 0.3])
def test_step_lowers_the_linearised_loss_within_the_trust_region(loss: Loss, radius: float) -> None:
    jacobian, r = linear_problem()
    step = loss.step(jacobian, r, radius)
    assert loss.value(r + jacobian.apply(step)) < loss.value(r)
    assert np.abs(step).max() <= 2 * radius * (1 + 1e-9)
    if isinstance(loss, SmoothLoss):
        assert np.sqrt((step**2).sum(axis=1).mean()) <= radius * (1 + 1e-9)


@pytest.mark.parametrize("loss", LOSSES, ids=repr)
def test_step_is_not_there_without_residuals(loss: Loss) -> None:
    jacobian, r = linear_problem()
    assert np.abs(loss.step(jacobian, 0 * r, 0.1)).max() < 1e-9


def test_wide_least_squares_step_is_the_normal_equations() -> None:
    jacobian, r = linear_problem()
    dense = jacobian.rows(np.arange(len(r))).toarray()
    exact = np.linalg.lstsq(dense, -r, rcond=None)[0]
    best = LeastSquares().value(r + dense @ exact)
    step = LeastSquares().step(jacobian, r, 1e6)
    assert LeastSquares().value(r + jacobian.apply(step)) < best * 1.001


@pytest.mark.parametrize("loss", [Huber(0.3), Power(4.0), Power(1.5)], ids=repr)
def test_repeated_steps_reach_the_minimum_of_a_linear_problem(loss: SmoothLoss) -> None:
    jacobian, r = linear_problem()
    dense = jacobian.rows(np.arange(len(r))).toarray()
    best = minimize(lambda y: loss.value(r + dense @ y), np.zeros(18), method="BFGS").fun
    for _ in range(60):
        r = r + jacobian.apply(loss.step(jacobian, r, 1.0))
    assert loss.value(r) < best * 1.001


@pytest.mark.parametrize("radius", [0.01, 0.2, 5.0])
def test_minimax_step_is_the_linear_program_over_all_rows(radius: float) -> None:
    jacobian, r = linear_problem(14)
    dense = jacobian.rows(np.arange(len(r))).toarray()
    rows = np.block([[dense, -np.ones((len(r), 1))], [-dense, -np.ones((len(r), 1))]])
    limits = [(-radius, radius)] * 28 + [(0, None)]
    whole = linprog(np.r_[np.zeros(28), 1.0], rows, np.r_[-r, r], bounds=limits)
    step = Minimax().step(jacobian, r, radius)
    assert np.abs(step).max() <= radius * (1 + 1e-9)
    assert Minimax().value(r + jacobian.apply(step)) == pytest.approx(whole.fun, abs=2e-3 * radius)


@pytest.mark.parametrize("loss", LOSSES, ids=repr)
def test_steps_respect_walls(loss: Loss) -> None:
    jacobian, r = linear_problem(10)
    rng = np.random.default_rng(2)
    weight = rng.dirichlet([1, 1, 1], 10)
    weight[:4, 0] = 0
    weight[:2, 1] = 0
    slope = rng.normal(size=(10, 3, 2))
    slope -= slope.mean(axis=1, keepdims=True)
    inside = replace(jacobian, walls=(weight, slope))
    free, held = loss.step(jacobian, r, 0.5), loss.step(inside, r, 0.5)
    assert (weight + np.einsum("pkx,px->pk", slope, held)).min() > -1e-7
    assert (weight + np.einsum("pkx,px->pk", slope, free)).min() < -0.1
    values = [loss.value(r + jacobian.apply(step)) for step in (free, held, 0 * held)]
    assert values[0] < values[1] < values[2]


def test_a_point_at_a_wall_slides_along_it() -> None:
    """Least squares at a wall is least squares along the wall."""
    jacobian, r = linear_problem(10)
    dense = jacobian.rows(np.arange(len(r))).toarray()
    push = LeastSquares().step(jacobian, r, 1e6)[0]
    weight, slope = np.full((10, 3), 1 / 3), np.zeros((10, 3, 2))
    weight[0, 0], slope[0, 0] = 0, [-1, 0] if push[0] > 0 else [1, 0]
    step = LeastSquares().step(replace(jacobian, walls=(weight, slope)), r, 1e6)
    assert abs(step[0, 0]) < 1e-12 < abs(step[0, 1])
    best = np.linalg.lstsq(dense[:, 1:], -r, rcond=None)[0]
    assert LeastSquares().value(r + jacobian.apply(step)) < 1.001 * np.mean((r + dense[:, 1:] @ best) ** 2)


def test_minimax_leaves_points_alone_that_can_not_help() -> None:
    jacobian, r = linear_problem(12)
    r = 0.01 * r
    r[0] = 1.0  # between points 0 and 1
    step = Minimax().step(jacobian, r, 0.01)
    assert np.abs(step[2:]).max() < 1e-9 < np.abs(step[:2]).max()


@pytest.mark.parametrize("make", [lambda: Huber(0), lambda: Power(0.5), lambda: Power(2, 0), lambda: Huber(np.nan)])
def test_losses_without_meaning_are_refused(make: type) -> None:
    with pytest.raises(ValueError, match="positive"):
        make()


def test_huber_and_power_contain_least_squares() -> None:
    r = np.random.default_rng(3).normal(size=40)
    assert Huber(1e6).value(r) == pytest.approx(LeastSquares().value(r))
    assert Power(2.0).value(r) == pytest.approx(LeastSquares().value(r))
    assert Power(80.0).value(r) ** (1 / 80) == pytest.approx(Minimax().value(r), rel=0.06)


def test_frames_make_blocks_of_unit_size() -> None:
    jacobian, _ = linear_problem(30)
    mean = np.einsum("rsx,rsy->xy", jacobian.blocks, jacobian.blocks) / len(jacobian.blocks)
    np.testing.assert_allclose(mean, np.eye(2), atol=1e-9)


def test_frames_stay_bounded_where_distances_do_not_change() -> None:
    first, second = np.triu_indices(4, 1)
    raw = np.random.default_rng(4).normal(size=(6, 2, 2))
    raw[first == 0, 0] *= [1, 0]  # point 0 changes nothing along its second axis
    raw[second == 3, 1] = 0  # point 3 changes nothing at all
    jacobian = scaled(first, second, raw, 4, np.full(4, 3.0))
    assert np.isfinite(jacobian.frames).all()
    size = np.linalg.norm(jacobian.frames, axis=(1, 2))
    assert size.max() < 100 * np.median(size)
    assert (scaled(first, second, 0 * raw, 4, np.full(4, 3.0)).frames == 0).all()
