"""Vertices that coincide, or all but do, beside the same surface without them; and surfaces much longer than wide."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
import scipy.sparse as sp

from geodesics import CommuteTimeDistance, Mesh, SurfacePoints, eigenpairs, embedded
from geodesics.errors import EigensolverFailed, SingularMatrix
from geodesics.linalg.factors import factorised
from geodesics.linalg.lanczos import smallest_eigenpairs


def collapsed(apart: float, share: float, subdivisions: int) -> tuple[Mesh, Mesh, np.ndarray]:
    """A mesh some of whose vertices lie `apart` from a neighbour, that without them, and which one each is there."""
    mesh = shapes.bumpy_sphere(subdivisions)
    rng = np.random.default_rng(1)
    gone, kept, taken = [], np.arange(mesh.n_vertices), set()
    for a, b, c in mesh.faces[rng.permutation(mesh.n_faces)].tolist():
        if not taken & {a, b, c} and len(gone) < share * mesh.n_vertices:
            taken |= {a, b, c}
            kept[a] = b
            gone.append(a)
    moved = mesh.vertices[kept]
    moved[gone] += apart * rng.standard_normal((len(gone), 3))
    faces = kept[mesh.faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    return Mesh(moved, mesh.faces), Mesh(mesh.vertices, faces), kept


@pytest.mark.parametrize("subdivisions", [2, 3])  # a dense solver, Lanczos
@pytest.mark.parametrize("share", [0.02, 0.15])
@pytest.mark.parametrize("apart", [0.0, 1e-15, 1e-12, 1e-9, 1e-7])
def test_eigenpairs_are_those_without_them(apart: float, share: float, subdivisions: int) -> None:
    whole, without, kept = collapsed(apart, share, subdivisions)
    found, true = eigenpairs(embedded(whole), 12), eigenpairs(embedded(without), 12)
    np.testing.assert_allclose(found.eigenvalues[1:], true.eigenvalues[1:], rtol=1e-4 + 3e4 * apart)
    assert found.eigenvalues[0] < 1e-7
    mine, theirs = CommuteTimeDistance(found), CommuteTimeDistance(true)
    ours = mine.field(SurfacePoints.at_vertices(whole, [int(kept[0])]))
    expected = theirs.field(SurfacePoints.at_vertices(without, [int(kept[0])]))[:, kept]
    np.testing.assert_allclose(ours, expected, atol=(1e-3 + 1e5 * apart) * expected.max())


@pytest.mark.parametrize("step", [0.3, 0.5, 1.0])
@pytest.mark.parametrize("subdivisions", [2, 3])
def test_vertices_on_a_coarse_grid(step: float, subdivisions: int) -> None:
    mesh = shapes.bumpy_sphere(subdivisions)
    found = eigenpairs(embedded(Mesh(step * np.round(mesh.vertices / step), mesh.faces)), 6)
    true = eigenpairs(embedded(mesh), 6).eigenvalues
    assert found.eigenvalues[0] < 1e-7 and np.isfinite(found.eigenfunctions).all()
    assert 0.5 < found.eigenvalues[1] / true[1] < 1.2


@pytest.mark.parametrize("width", [1e-3, 1e-5, 1e-6])
def test_a_strip_much_longer_than_wide(width: float) -> None:
    """Its first eigenvalues are those of a segment, far below the others."""
    strip = shapes.rectangle(20, 20, 1.0, width)
    segment = (np.arange(4) * np.pi) ** 2
    np.testing.assert_allclose(eigenpairs(embedded(strip), 20).eigenvalues[:4], segment, rtol=0.03, atol=1e-2)


def test_a_singular_system_is_a_typed_error() -> None:
    with pytest.raises(SingularMatrix, match="E404: a system of 3 unknowns cannot be solved"):
        factorised(sp.csc_matrix(np.diag([1.0, 0.0, 0.0])))
    good = factorised(sp.csc_matrix([[1.0, -1.0], [-1.0, 1.0]]))  # singular by rounding alone
    assert np.isfinite(good.solve(np.array([1.0, -1.0]))).all()


def test_a_matrix_that_is_no_number_is_a_typed_error() -> None:
    with pytest.raises(EigensolverFailed, match="E402"):
        smallest_eigenpairs(sp.diags([np.r_[np.full(2999, 1e300), np.nan], np.full(2999, -1e299)], [0, 1]).tocsc(), 20)
