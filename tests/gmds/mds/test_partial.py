"""Samples placed with weights that are unknown: what never rises, what is met, and who is left out."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gmds
from geodesics import CommuteTimeDistance, SurfacePoints, eigenpairs, farthest_point_sampling
from gmds.mds import partial
from gmds.mds.partial import least_weights, on_simplex

MESH = shapes.bumpy_sphere(3)
DISTANCE = CommuteTimeDistance(eigenpairs(MESH, 30))
SAMPLES = SurfacePoints.at_vertices(MESH, farthest_point_sampling(DISTANCE, 30))
VALUES = arrays(float, 12, elements=st.floats(-5, 5))


@settings(max_examples=50, deadline=None)
@given(VALUES, st.floats(0.05, 1))
def test_the_nearest_weights_are_weights_and_nothing_on_the_way_is_nearer(values: np.ndarray, share: float) -> None:
    found = on_simplex(values, share)
    assert (found >= 0).all() and (found <= 1).all() and found.mean() == pytest.approx(share, abs=1e-9)
    other = on_simplex(np.roll(values, 1), share)  # any other point of the set: the angle to it is not acute
    assert (values - found) @ (other - found) <= 1e-6


@settings(max_examples=30, deadline=None)
@given(arrays(float, (10, 10), elements=st.floats(0, 1)), st.floats(0.1, 1))
def test_weights_never_raise_the_sum(misfit: np.ndarray, share: float) -> None:
    misfit = misfit + misfit.T
    np.fill_diagonal(misfit, 0)
    before = np.full(10, share)
    after = least_weights(misfit, before, share)
    assert after @ misfit @ after <= before @ misfit @ before + 1e-9
    assert after.mean() == pytest.approx(share, abs=1e-9)


def test_who_has_no_counterpart_is_left_out() -> None:
    """A fifth of the samples lies as far as can be from where it belongs."""
    lost = np.arange(30) % 5 == 0
    there = SAMPLES.nearest_vertices().copy()
    there[lost] = DISTANCE.field(SAMPLES[lost]).argmax(axis=1)
    found = gmds.solve_partial(
        DISTANCE, SAMPLES, DISTANCE, SurfacePoints.at_vertices(MESH, there), share=0.8, rounds=3, max_iterations=0
    )
    assert found.weights[lost].max() < 0.1 and found.weights[~lost].min() > 0.9


def test_the_sum_falls_and_all_is_asked_for_where_all_corresponds() -> None:
    shaken = MESH.vertices[SAMPLES.nearest_vertices()] + np.random.default_rng(0).normal(0, 0.1, (30, 3))
    start = SurfacePoints.closest(MESH, shaken)
    found = gmds.solve_partial(DISTANCE, SAMPLES, DISTANCE, start, share=0.9, rounds=4)
    assert all(after <= before for before, after in zip(found.stresses, found.stresses[1:], strict=False))
    assert found.stresses[-1] < 0.05 * found.stresses[0]
    whole = gmds.solve_partial(DISTANCE, SAMPLES, DISTANCE, start, share=1, rounds=1)
    np.testing.assert_allclose(whole.weights, 1, atol=1e-9)


@pytest.mark.parametrize("share", [0, -0.5, 1.5, float("nan"), True, "half", 0.5 + 0j], ids=repr)
def test_shares_that_are_none(share: object) -> None:
    with pytest.raises(ValueError, match="share must be a number"):
        gmds.solve_partial(DISTANCE, SAMPLES, DISTANCE, SAMPLES, share=share)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "settings", [{"rounds": 0}, {"rounds": "2"}, {"rounds": 2.5}, {"max_iterations": "a"}, {"max_iterations": -1}]
)
def test_counts_that_are_none(settings: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"E604.*must be at least .*, and a whole number"):
        gmds.solve_partial(DISTANCE, SAMPLES, DISTANCE, SAMPLES, progress=lambda *_: None, **settings)  # type: ignore[arg-type]


def test_a_mesh_is_no_distance() -> None:
    for ours, theirs in ((MESH, DISTANCE), (DISTANCE, MESH)):
        with pytest.raises(TypeError, match="a distance is expected, not Mesh"):
            gmds.solve_partial(ours, SAMPLES, theirs, SAMPLES)


def test_a_round_that_would_raise_the_sum_leaves_the_samples_where_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    there = SurfacePoints.at_vertices(MESH, np.roll(SAMPLES.nearest_vertices(), 7))

    def worse(problem: gmds.Problem, start: SurfacePoints, *_: object, max_iterations: int) -> gmds.Solution:
        return gmds.solve(problem, there if max_iterations else start, max_iterations=0)

    monkeypatch.setattr(partial, "solve", worse)
    found = gmds.solve_partial(DISTANCE, SAMPLES, DISTANCE, SAMPLES, share=1, rounds=1)
    np.testing.assert_array_equal(found.solution.points.positions, SAMPLES.positions)
    assert found.stresses == pytest.approx((0, 0), abs=1e-12)
