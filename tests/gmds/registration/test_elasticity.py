"""What it costs to deform a surface in space."""

from __future__ import annotations

import functools

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from geodesics import Mesh, embedded, stiffness
from geodesics.one_ring import one_ring_areas
from gmds.registration.elasticity import DOUBT, LARGEST, Elasticity

Array = NDArray[np.float64]
TURN = Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()
ROUNDING = 1e-12
SHIFT = np.array([0.4, -0.1, 0.2])
MESHES = {
    "closed": bumpy,
    "open": lambda: shapes.disc(5),
    "obtuse": lambda: shapes.jittered(shapes.rectangle(8, 8, 1.0, 3.0), 0.3, 1),
    "isolated vertices": lambda: shapes.with_isolated(shapes.icosphere(2)),
}


@functools.cache
def elastic(name: str) -> Elasticity:
    """The elasticity of a mesh of unit area."""
    mesh = MESHES[name]()
    mesh = Mesh(mesh.vertices / np.sqrt(one_ring_areas(mesh).sum() / 3), mesh.faces)
    return Elasticity(mesh, one_ring_areas(mesh) / 3)


def shaken(elasticity: Elasticity, amount: float = 0.02, seed: int = 0) -> Array:
    """The vertices turned, and moved at random."""
    noise = np.random.default_rng(seed).standard_normal(elasticity.mesh.vertices.shape)
    return np.asarray((elasticity.mesh.vertices + amount * noise) @ TURN.T)


def edges(elasticity: Elasticity) -> list[tuple[int, int, float]]:
    """Ordered pairs of neighbours, and their cotangent weights."""
    matrix = stiffness(embedded(elasticity.mesh)).tocoo()
    return [(i, j, -w) for i, j, w in zip(matrix.row, matrix.col, matrix.data, strict=True) if i != j and w < 0]


def naive_energy(elasticity: Elasticity, y: Array, similarities: Array) -> Array:
    x, found = elasticity.mesh.vertices, np.zeros(len(y))
    for i, j, w in edges(elasticity):
        found[i] += w * ((y[i] - y[j] - similarities[i] @ (x[i] - x[j])) ** 2).sum()
    return found


def objective(elasticity: Elasticity, y: Array, growing: bool = False) -> float:
    return float(elasticity.energy(y, elasticity.local_similarities(y, growing)).sum())


def shrunk(scale: float) -> float:
    """The size that parts are taken to have that are `scale` times as large."""
    log = np.log(np.clip(scale, 1 / LARGEST, LARGEST))
    return float(np.exp(log**3 / (log**2 + DOUBT**2)))


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("growing", [True, False])
def test_rigid_motions_cost_nothing(name: str, growing: bool) -> None:
    elasticity = elastic(name)
    y = elasticity.mesh.vertices @ TURN.T + SHIFT
    similarities = elasticity.local_similarities(y, growing)
    assert elasticity.energy(y, similarities).sum() < ROUNDING
    if name in ("closed", "isolated vertices"):  # a corner of a flat surface may have a single weight
        assert np.allclose(similarities[np.unique(elasticity.mesh.faces)], TURN, atol=1e-9)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("scale", [0.1, 0.9, 1.3, 7.0])
def test_similarities_cost_nothing_unless_parts_grow_and_then_only_the_doubt(name: str, scale: float) -> None:
    elasticity = elastic(name)
    y = scale * elasticity.mesh.vertices @ TURN.T + SHIFT
    rest = elasticity.energy(
        0 * y, elasticity.local_similarities(elasticity.mesh.vertices, False)
    ).sum()  # sum w |x_i - x_j|^2
    assert rest == pytest.approx(4, rel=0.1)  # twice the Dirichlet energy of the identity, which is twice the area
    assert objective(elasticity, y) < ROUNDING * (1 + scale**2)
    assert objective(elasticity, y, True) == pytest.approx(rest * (scale - shrunk(scale)) ** 2, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(("a", "b"), [(1.2, 1.0), (0.5, 2.0), (1.0, 1.0)])
def test_a_flat_stretch_costs_its_dirichlet_energy(a: float, b: float) -> None:
    mesh = shapes.rectangle(6, 6)
    elasticity = Elasticity(mesh, one_ring_areas(mesh) / 3)
    y = (mesh.vertices * [a, b, 1]) @ TURN.T
    assert objective(elasticity, y) == pytest.approx((a - b) ** 2, abs=1e-12)  # 2 min_s |diag(a, b) - s|^2


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("growing", [True, False])
def test_the_energy_agrees_with_its_naive_twin(name: str, growing: bool) -> None:
    elasticity = elastic(name)
    y = shaken(elasticity)
    similarities = elasticity.local_similarities(y, growing)
    assert np.allclose(elasticity.energy(y, similarities), naive_energy(elasticity, y, similarities), atol=1e-12)


@pytest.mark.parametrize("name", MESHES)
def test_the_right_hand_side_agrees_with_its_naive_twin(name: str) -> None:
    elasticity = elastic(name)
    x, similarities = (
        elasticity.mesh.vertices,
        np.random.default_rng(1).standard_normal((elasticity.mesh.n_vertices, 3, 3)),
    )
    expected = np.zeros_like(x)
    for i, j, w in edges(elasticity):
        expected[i] += 0.5 * w * (similarities[i] + similarities[j]) @ (x[i] - x[j])
    assert np.allclose(elasticity.right_hand_side(similarities), expected, atol=1e-12)


@pytest.mark.parametrize("name", MESHES)
def test_turns_are_the_best_rotations_and_one_size(name: str) -> None:
    elasticity = elastic(name)
    y = shaken(elasticity)
    similarities = elasticity.local_similarities(y, False)
    least = elasticity.energy(y, similarities)
    size = np.cbrt(np.linalg.det(similarities))
    assert np.allclose(size, size[0])
    for turned in (similarities @ Rotation.from_rotvec(0.1 * axis).as_matrix() for axis in (*np.eye(3), *-np.eye(3))):
        assert (elasticity.energy(y, turned) >= least - 1e-14).all()
    for factor in (0.99, 1.01):
        assert elasticity.energy(y, factor * similarities).sum() > least.sum()


@pytest.mark.parametrize("name", MESHES)
def test_the_force_is_what_is_missing_in_the_gradient(name: str) -> None:
    elasticity = elastic(name)
    y, step = shaken(elasticity), 1e-5
    gradient = 4 * (elasticity.stiffness @ y - elasticity.right_hand_side(elasticity.local_similarities(y, False)))
    for seed in range(3):
        way = np.random.default_rng(seed).standard_normal(y.shape)
        slope = (objective(elasticity, y + step * way) - objective(elasticity, y - step * way)) / (2 * step)
        assert slope == pytest.approx((gradient * way).sum(), rel=1e-5)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("stiffness_weight", [1e-1, 1e-3])
def test_every_step_lessens_energy_and_point_constraints_taken_together(name: str, stiffness_weight: float) -> None:
    elasticity, weights = elastic(name), elastic(name).areas
    y = goals = shaken(elasticity, 0.05)
    solve = elasticity.solver(stiffness_weight, weights)
    values = []
    for _ in range(8):
        y = solve(
            stiffness_weight * elasticity.right_hand_side(elasticity.local_similarities(y, False))
            + weights[:, None] * goals
        )
        values.append(0.5 * stiffness_weight * objective(elasticity, y) + (weights @ (y - goals) ** 2).sum())
    assert (np.diff(values) < 1e-12).all()
    assert values[-1] < values[0] < 0.5 * stiffness_weight * objective(elasticity, goals)


@pytest.mark.parametrize("name", MESHES)
def test_weights_are_never_negative_and_the_laplacian_forgets_shifts(name: str) -> None:
    laplacian = elastic(name).stiffness
    off = (laplacian - np.diag(laplacian.diagonal())).view(np.ndarray)
    assert (off <= 0).all()
    assert np.allclose(laplacian @ np.ones(len(off)), 0, atol=1e-12)
    assert np.allclose(off, off.T)
    plain = stiffness(embedded(elastic(name).mesh)).toarray()
    assert ((plain - np.diag(plain.diagonal())).max() > 0.1) == (name == "obtuse")  # or the test could not fail


@pytest.mark.parametrize("time", [1e-3, 1.0])
def test_the_smoother_is_a_heat_step(time: float) -> None:
    elasticity = elastic("closed")
    smooth, f = elasticity.smoother(time), np.random.default_rng(0).standard_normal(elasticity.mesh.n_vertices)
    after = smooth(elasticity.areas * f)
    assert elasticity.areas @ after == pytest.approx(elasticity.areas @ f)
    assert f.min() < after.min() and after.max() < f.max()
    assert np.allclose(smooth(elasticity.areas), 1)
    assert elasticity.smoother(time) is smooth  # factorised once


def test_a_part_that_grew_costs_less_where_parts_may_grow() -> None:
    elasticity = elastic("closed")
    x = elasticity.mesh.vertices
    height = x[:, 2:] / np.ptp(x[:, 2])
    y = x * (1 + 1 / (1 + np.exp(-20 * height)))
    assert objective(elasticity, y, True) < 0.5 * objective(elasticity, y)
    size = np.cbrt(np.linalg.det(elasticity.local_similarities(y, True)))
    assert size[height[:, 0] > 0.3].min() > 1.4 and size[height[:, 0] < -0.3].max() < 1.2


def test_vertices_on_no_face_are_left_out() -> None:
    elasticity = elastic("isolated vertices")
    lost = np.flatnonzero(elasticity.areas == 0)
    assert len(lost) == 3
    y = shaken(elasticity)
    y[lost] = 1e3
    for growing in (True, False):
        similarities = elasticity.local_similarities(y, growing)
        assert np.isfinite(similarities).all()
        assert (elasticity.energy(y, similarities)[lost] == 0).all()
        assert (elasticity.right_hand_side(similarities)[lost] == 0).all()
    placed = elasticity.solver(1e-3, elasticity.areas)(elasticity.areas[:, None] * y)
    assert np.abs(placed).max() < 2
