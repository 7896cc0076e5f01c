"""What it costs to deform a surface in space: laws of every energy, and those of each."""

from __future__ import annotations

import functools

import generated_shapes as shapes
import numpy as np
import pytest
import scipy.sparse as sp
from matched_shapes import bumpy
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from geodesics import Mesh, embedded, stiffness
from geodesics.one_ring import one_ring_areas
from gmds.registration.energies import (
    ALL,
    AsRigidAsPossible,
    AsSimilarAsPossible,
    Energy,
    EnergyKind,
    NearlyAffine,
    ThinShell,
)
from gmds.registration.energies.as_similar_as_possible import DOUBT, LARGEST
from gmds.registration.energies.base import LocalGlobalEnergy
from gmds.registration.laplacian import CotangentLaplacian

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
every_mesh = pytest.mark.parametrize("name", MESHES)
every_kind = pytest.mark.parametrize("kind", ALL)
one_size = pytest.mark.parametrize("kind", [AsRigidAsPossible, ThinShell])  # sizes that do not depend on the place


@functools.cache
def laplacian(name: str) -> CotangentLaplacian:
    """That of a mesh of unit area."""
    mesh = MESHES[name]()
    mesh = Mesh(mesh.vertices / np.sqrt(one_ring_areas(mesh).sum() / 3), mesh.faces)
    return CotangentLaplacian(mesh, one_ring_areas(mesh) / 3)


def rest(name: str) -> Array:
    return laplacian(name).mesh.vertices


def shaken(name: str, amount: float = 0.02, seed: int = 0) -> Array:
    """The vertices turned, and moved at random."""
    noise = np.random.default_rng(seed).standard_normal(rest(name).shape)
    return np.asarray((rest(name) + amount * noise) @ TURN.T)


def total(energy: Energy, y: Array) -> float:
    return float(energy.value(y, energy.local_step(y)).sum())


def edges(name: str) -> list[tuple[int, int, float]]:
    """Ordered pairs of neighbours, and their cotangent weights."""
    matrix = stiffness(embedded(laplacian(name).mesh)).tocoo()
    return [(i, j, -w) for i, j, w in zip(matrix.row, matrix.col, matrix.data, strict=True) if i != j and w < 0]


def stretch(name: str, y: Array, local: Array) -> Array:
    """What edges cost, one after the other."""
    x, cost = rest(name), np.zeros(len(y))
    for i, j, w in edges(name):
        cost[i] += w * ((y[i] - y[j] - local[i] @ (x[i] - x[j])) ** 2).sum()
    return cost


@every_mesh
@every_kind
def test_rigid_motions_cost_nothing(name: str, kind: EnergyKind) -> None:
    energy = kind(laplacian(name))
    y = rest(name) @ TURN.T + SHIFT
    local = energy.local_step(y)
    assert energy.value(y, local).sum() < ROUNDING
    if name in ("closed", "isolated vertices"):  # a corner of a flat surface may have a single weight
        assert np.allclose(local[np.unique(laplacian(name).mesh.faces)], TURN, atol=1e-9)


@every_mesh
@every_kind
def test_what_is_not_a_rigid_motion_costs_something(name: str, kind: EnergyKind) -> None:
    energy = kind(laplacian(name))
    value = energy.value(shaken(name), energy.local_step(shaken(name)))
    assert (value >= 0).all() and value.sum() > 1e-3


@every_mesh
@every_kind
def test_no_energy_depends_on_where_the_surface_lies(name: str, kind: EnergyKind) -> None:
    energy, y = kind(laplacian(name)), shaken(name)
    turned = y @ TURN.T + SHIFT
    there = energy.value(turned, energy.local_step(turned))
    assert np.allclose(there, energy.value(y, energy.local_step(y)), rtol=1e-9, atol=1e-12)


@every_mesh
@every_kind
def test_with_the_local_step_held_the_energy_is_quadratic_with_this_gradient(name: str, kind: EnergyKind) -> None:
    energy, y = kind(laplacian(name)), shaken(name)
    local = energy.local_step(y)
    gradient = 4 * (energy.system.matrix @ y - energy.right_hand_side(local))
    for seed in range(3):
        way = 0.01 * np.random.default_rng(seed).standard_normal(y.shape)
        way[laplacian(name).areas <= 0] = 0
        there, here, back = (energy.value(y + step * way, local).sum() for step in (1, 0, -1))
        assert (there - back) / 2 == pytest.approx((gradient * way).sum(), rel=1e-9, abs=1e-12)
        assert there - 2 * here + back == pytest.approx(4 * (way * (energy.system.matrix @ way)).sum(), rel=1e-7)


@every_mesh
@one_size
def test_the_gradient_is_that_of_the_energy_after_its_local_step(name: str, kind: EnergyKind) -> None:
    energy, y, step = kind(laplacian(name)), shaken(name), 1e-5
    gradient = 4 * (energy.system.matrix @ y - energy.right_hand_side(energy.local_step(y)))
    for seed in range(3):
        way = np.random.default_rng(seed).standard_normal(y.shape)
        slope = (total(energy, y + step * way) - total(energy, y - step * way)) / (2 * step)
        assert slope == pytest.approx((gradient * way).sum(), rel=1e-5)


@every_mesh
@one_size
def test_the_local_step_finds_the_best_rotations(name: str, kind: EnergyKind) -> None:
    energy, y = kind(laplacian(name)), shaken(name)
    local = energy.local_step(y)
    least = energy.value(y, local)
    size = np.cbrt(np.linalg.det(local))
    assert np.allclose(size, size[0])
    for turned in (local @ Rotation.from_rotvec(0.1 * axis).as_matrix() for axis in (*np.eye(3), *-np.eye(3))):
        assert (energy.value(y, turned) >= least - 1e-14).all()
    if kind is AsRigidAsPossible:
        assert all(energy.value(y, factor * local).sum() > least.sum() for factor in (0.99, 1.01))


@every_mesh
@one_size
@pytest.mark.parametrize("stiffness_weight", [1e-1, 1e-3])
def test_every_step_lessens_energy_and_point_constraints_taken_together(
    name: str, kind: EnergyKind, stiffness_weight: float
) -> None:
    energy, weights = kind(laplacian(name)), laplacian(name).areas
    y = goals = shaken(name, 0.05)
    solve = energy.system.solver(stiffness_weight, weights)
    values = []
    for _ in range(8):
        y = solve(stiffness_weight * energy.right_hand_side(energy.local_step(y)) + weights[:, None] * goals)
        values.append(0.5 * stiffness_weight * total(energy, y) + (weights @ (y - goals) ** 2).sum())
    assert (np.diff(values) < 1e-12).all()
    assert values[-1] < values[0] < 0.5 * stiffness_weight * total(energy, goals)


@every_kind
def test_vertices_on_no_face_are_left_out(kind: EnergyKind) -> None:
    energy, areas = kind(laplacian("isolated vertices")), laplacian("isolated vertices").areas
    lost = np.flatnonzero(areas == 0)
    assert len(lost) == 3
    y = shaken("isolated vertices")
    y[lost] = 1e3
    local = energy.local_step(y)
    assert np.isfinite(local).all()
    assert (energy.value(y, local)[lost] == 0).all() and (energy.right_hand_side(local)[lost] == 0).all()
    placed = energy.system.solver(1e-3, areas)(areas[:, None] * y)
    assert np.abs(placed).max() < 2


@every_mesh
@pytest.mark.parametrize("kind", [AsRigidAsPossible, AsSimilarAsPossible])
def test_the_cost_of_edges_agrees_with_its_naive_twin(name: str, kind: EnergyKind) -> None:
    energy, y = kind(laplacian(name)), shaken(name)
    local = energy.local_step(y)
    assert np.allclose(energy.value(y, local), stretch(name, y, local), atol=1e-12)


@every_mesh
def test_the_right_hand_side_agrees_with_its_naive_twin(name: str) -> None:
    x = rest(name)
    local = np.random.default_rng(1).standard_normal((len(x), 3, 3))
    expected = np.zeros_like(x)
    for i, j, w in edges(name):
        expected[i] += 0.5 * w * (local[i] + local[j]) @ (x[i] - x[j])
    assert np.allclose(AsRigidAsPossible(laplacian(name)).right_hand_side(local), expected, atol=1e-12)


def shrunk(scale: float) -> float:
    """The size that parts are taken to have that are `scale` times as large."""
    log = np.log(np.clip(scale, 1 / LARGEST, LARGEST))
    return float(np.exp(log**3 / (log**2 + DOUBT**2)))


@every_mesh
@pytest.mark.parametrize("scale", [0.1, 0.9, 1.3, 7.0])
def test_another_size_costs_nothing_or_the_doubt_or_all_of_it(name: str, scale: float) -> None:
    y = scale * rest(name) @ TURN.T + SHIFT
    rigid, similar, shell = (kind(laplacian(name)) for kind in (AsRigidAsPossible, AsSimilarAsPossible, ThinShell))
    size = LocalGlobalEnergy.spread(rigid, rest(name)).sum()
    assert size == pytest.approx(4, rel=0.1)  # twice the Dirichlet energy of the identity, which is twice the area
    assert total(rigid, y) < ROUNDING * (1 + scale**2)
    assert total(similar, y) == pytest.approx(size * (scale - shrunk(scale)) ** 2, rel=1e-6, abs=1e-9)
    assert total(shell, y) == pytest.approx(shell.rest_spread.sum() * (scale - 1) ** 2, rel=1e-6)


@every_mesh
def test_affine_maps_cost_nothing_against_the_nearly_affine_energy_and_the_rest_its_dirichlet_energy(name: str) -> None:
    energy, x = NearlyAffine(laplacian(name)), rest(name)
    matrix = TURN @ np.array([[1.3, 0.4, 0.0], [0.0, 0.7, -0.2], [0.1, 0.0, 1.0]])
    y = x @ matrix.T + SHIFT
    flat = np.linalg.matrix_rank(x - x[0], tol=1e-9) < 3  # of a disc B is known in its plane alone
    assert flat or np.allclose(energy.local_step(y), matrix, atol=1e-7)
    assert total(energy, y) < 1e-8
    moved = shaken(name)
    fitted = energy.local_step(moved)
    for way in np.eye(9).reshape(9, 3, 3):
        assert energy.value(moved, fitted + 1e-3 * way).sum() >= total(energy, moved) - 1e-12
    naive = [w * ((moved[i] - moved[j] - fitted[i] @ (x[i] - x[j])) ** 2).sum() for i, j, w in edges(name)]
    assert total(energy, moved) == pytest.approx(sum(naive))


@pytest.mark.parametrize(("a", "b"), [(1.2, 1.0), (0.5, 2.0), (1.0, 1.0)])
def test_a_flat_stretch_costs_its_dirichlet_energy(a: float, b: float) -> None:
    mesh = shapes.rectangle(6, 6)
    energy = AsRigidAsPossible(CotangentLaplacian(mesh, one_ring_areas(mesh) / 3))
    y = (mesh.vertices * [a, b, 1]) @ TURN.T
    assert total(energy, y) == pytest.approx((a - b) ** 2, abs=1e-12)  # 2 min_s |diag(a, b) - s|^2


def test_a_part_that_grew_costs_less_where_parts_may_change_size() -> None:
    x = rest("closed")
    height = x[:, 2:] / np.ptp(x[:, 2])
    y = x * (1 + 1 / (1 + np.exp(-20 * height)))
    similar = AsSimilarAsPossible(laplacian("closed"))
    assert total(similar, y) < 0.5 * total(AsRigidAsPossible(laplacian("closed")), y)
    size = np.cbrt(np.linalg.det(similar.local_step(y)))
    assert size[height[:, 0] > 0.3].min() > 1.4 and size[height[:, 0] < -0.3].max() < 1.2


@every_mesh
def test_a_thin_shell_costs_its_edges_and_the_change_of_its_curvature(name: str) -> None:
    lap, x, y = laplacian(name), rest(name), shaken(name)
    shell = ThinShell(lap, 0.02)
    local = shell.local_step(y)
    used = lap.areas > 0
    before, after = ((lap.matrix @ places)[used] / lap.areas[used, None] for places in (x, y))
    bent = 0.02 * lap.areas[used] * ((after - np.einsum("nab,nb->na", local[used], before)) ** 2).sum(axis=1)
    expected = stretch(name, y, local)
    expected[used] += bent
    assert np.allclose(shell.value(y, local), expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("bending", [1e-4, 1e-2])
def test_bending_a_strip_to_a_cylinder_costs_its_curvature(bending: float) -> None:
    x, z = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 0.1, 5), indexing="ij")
    corner = (5 * np.arange(40)[:, None] + np.arange(4)).ravel()  # every square is cut along the same diagonal
    faces = [np.stack([corner, corner + 5, corner + 6], axis=1), np.stack([corner, corner + 6, corner + 1], axis=1)]
    mesh = Mesh(np.stack([x, z, 0 * x], axis=2).reshape(-1, 3), np.concatenate(faces))
    lap = CotangentLaplacian(mesh, one_ring_areas(mesh) / 3)
    angle, across = mesh.vertices[:, 0], mesh.vertices[:, 1]
    y = np.column_stack([np.sin(angle), across, 1 - np.cos(angle)])  # radius 1: its Laplacian has length 1
    inside = (np.abs(angle - angle.mean()) < 0.45) & (np.abs(across - across.mean()) < 0.04)
    shell, membrane = ThinShell(lap, bending), ThinShell(lap, 0.0)
    cost = shell.value(y, shell.local_step(y)) - membrane.value(y, membrane.local_step(y))
    assert np.allclose(cost[inside] / (bending * lap.areas[inside]), 1, rtol=0.02)


@every_mesh
def test_weights_are_never_negative_and_the_laplacian_forgets_shifts(name: str) -> None:
    matrix = laplacian(name).matrix
    off = (matrix - np.diag(matrix.diagonal())).view(np.ndarray)
    assert (off <= 0).all()
    assert np.allclose(matrix @ np.ones(len(off)), 0, atol=1e-12)
    assert np.allclose(off, off.T)
    plain = stiffness(embedded(laplacian(name).mesh)).toarray()
    assert ((plain - np.diag(plain.diagonal())).max() > 0.1) == (name == "obtuse")  # or the test could not fail


@every_mesh
@every_kind
def test_solvers_solve(name: str, kind: EnergyKind) -> None:
    system, rng = kind(laplacian(name)).system, np.random.default_rng(0)
    weights, right = rng.random(len(rest(name))), rng.standard_normal(rest(name).shape)
    y = system.solver(0.01, weights)(right)
    assert np.allclose((0.01 * system.matrix + sp.diags(weights)) @ y, right, atol=1e-9)


@pytest.mark.parametrize("time", [1e-3, 1.0])
def test_heat_is_kept_and_spread(time: float) -> None:
    lap = laplacian("closed")
    step, f = lap.heat_step(time), np.random.default_rng(0).standard_normal(lap.mesh.n_vertices)
    after = step(lap.areas * f)
    assert lap.areas @ after == pytest.approx(lap.areas @ f)
    assert f.min() < after.min() and after.max() < f.max()
    assert np.allclose(step(lap.areas), 1)
    assert lap.heat_step(time) is step  # factorised once
