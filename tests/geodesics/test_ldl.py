"""Systems of one symmetric pattern with many diagonals."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
import scipy.sparse as sp

from geodesics import embedded, stiffness
from geodesics.errors import SingularMatrix
from geodesics.linalg.ldl import ShiftedSystems

RNG = np.random.default_rng(0)


@pytest.fixture(scope="module")
def matrix() -> sp.csr_matrix:
    return sp.csr_matrix(stiffness(embedded(shapes.bumpy_sphere(3))))


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e3])
@pytest.mark.parametrize("columns", [(), (3,)])
def test_solutions_solve(matrix: sp.csr_matrix, scale: float, columns: tuple[int, ...]) -> None:
    systems, n = ShiftedSystems(matrix), matrix.shape[0]
    for _ in range(2):  # the pattern is kept, the numbers are not
        diagonal = RNG.uniform(1e-3, 1.0, n)
        right = RNG.normal(size=(n, *columns))
        found = systems.solver(scale, diagonal)(right)
        assert found.shape == right.shape
        assert np.allclose((scale * matrix + sp.diags(diagonal)) @ found, right, atol=1e-9 * np.abs(right).max())


def test_the_right_hand_side_is_kept(matrix: sp.csr_matrix) -> None:
    right = RNG.normal(size=matrix.shape[0])
    before = right.copy()
    ShiftedSystems(matrix).solver(1.0, np.ones(len(right)))(right)
    assert np.array_equal(right, before)


def test_a_dense_and_a_diagonal_pattern() -> None:
    full = RNG.normal(size=(7, 7))
    full = full @ full.T
    for dense in (full, np.diag(np.arange(1.0, 8.0))):
        right = RNG.normal(size=(7, 3))
        found = ShiftedSystems(sp.csr_matrix(dense)).solver(2.0, np.ones(7))(right)
        assert np.allclose(found, np.linalg.solve(2.0 * dense + np.eye(7), right))


def test_a_singular_matrix_is_raised_a_little_and_a_negative_one_refused(matrix: sp.csr_matrix) -> None:
    n = matrix.shape[0]
    right = RNG.normal(size=n)
    right -= right.mean()
    found = ShiftedSystems(matrix).solver(1.0, np.zeros(n))(right)  # the constant is in its kernel
    assert np.allclose(matrix @ found, right, atol=1e-4 * np.abs(right).max())
    with pytest.raises(SingularMatrix, match="E404"):
        ShiftedSystems(matrix).solver(1.0, np.full(n, -1e3))
