"""Semilandmarks slide as others slide them, and stay on their surface; energies are those of the literature."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere
from scipy.spatial.transform import Rotation

from geodesics import SurfacePoints
from geodesics.errors import BadArgument
from gmds.morphometrics.procrustes import superimposed
from gmds.morphometrics.sliding import bending_energy, bending_energy_matrix, slid, slide_all

REFERENCE = np.array([[0, 0, 0], [1, 0, 0.1], [2, 0.2, 0.3], [3, 0.1, 0.2], [4, 0, 0], [2, 2, 1], [1, 1.5, 0.7]])
SHIFT = [[0.1, 0, 0.05], [0.2, 0.1, -0.1], [-0.15, 0.1, 0.05], [0.05, -0.1, 0.1], [0, 0.1, 0], [-0.1, 0.1, 0.2], [0.1, -0.2, 0.1]]  # fmt: skip # noqa: E501
POINTS = REFERENCE + np.array(SHIFT)
CURVE = np.array([[0, 1, 2], [1, 2, 3], [2, 3, 4]])
# what ktch 0.11.1 (BSD) makes of the same input: its tps_bending_energy, _slide_bending_energy and _slide_procrustes
ENERGY = 0.19585432202263336
BENDING = [
    [1.0009646899195723, 0.06587966112906954, -0.03412033887093047],
    [1.8307076735161087, 0.30104282845858876, 0.3468715146242338],
    [2.848843241236861, 0.0187122566291292, 0.33274644910097617],
]
PROCRUSTES = [
    [1.0111025443330763, 0.06761757902852739, -0.03238242097147262],
    [1.9931156848828957, 0.292264017033357, 0.373207948899929],
    [3.008437826541275, 0.0038662486938348855, 0.3067659352142111],
]


def along_curve() -> tuple[np.ndarray, np.ndarray]:
    chords = POINTS[CURVE[:, 2]] - POINTS[CURVE[:, 0]]
    return CURVE[:, 1], chords / np.linalg.norm(chords, axis=1, keepdims=True)


def test_it_is_what_ktch_says() -> None:
    assert abs(bending_energy(REFERENCE, POINTS) - ENERGY) < 1e-8
    assert np.abs(slid(POINTS, REFERENCE, *along_curve())[1:4] - BENDING).max() < 1e-8
    assert np.abs(slid(POINTS, REFERENCE, *along_curve(), "procrustes")[1:4] - PROCRUSTES).max() < 1e-8


def test_no_other_place_along_the_tangents_has_less() -> None:
    which, tangents = along_curve()
    best = slid(POINTS, REFERENCE, which, tangents)
    least = bending_energy(REFERENCE, best)
    rng = np.random.default_rng(0)
    for _ in range(20):
        other = best.copy()
        other[which] += rng.normal(scale=0.1, size=(3, 1)) * tangents
        assert bending_energy(REFERENCE, other) >= least
    fixed = [0, 4, 5, 6]
    assert np.array_equal(best[fixed], POINTS[fixed])


def test_affine_changes_cost_nothing() -> None:
    turned = Rotation.random(random_state=1).apply(REFERENCE) @ np.diag([2.0, 0.5, 1.5]) + 3
    assert abs(bending_energy(REFERENCE, turned)) < 1e-10
    values = np.linalg.eigvalsh(bending_energy_matrix(REFERENCE))
    assert values.min() > -1e-10


def test_semilandmarks_of_patches_stay_on_their_surfaces_and_come_nearer() -> None:
    meshes = [bumpy_sphere(2, seed=seed) for seed in range(3)]
    rng = np.random.default_rng(0)
    rows = rng.choice(meshes[0].n_vertices, 14, replace=False)
    start = np.stack([mesh.vertices[rows] for mesh in meshes])
    start[1:, 6:] += rng.normal(scale=0.1, size=(2, 8, 3))
    start = np.stack([SurfacePoints.closest(m, x).positions for m, x in zip(meshes, start, strict=True)])
    found = slide_all(start, patches=range(6, 14), meshes=meshes, by="procrustes")
    for mesh, points in zip(meshes, found, strict=True):
        assert np.abs(SurfacePoints.closest(mesh, points).positions - points).max() < 1e-9
    assert np.array_equal(found[:, :6], start[:, :6])
    assert (superimposed(found).distances ** 2).sum() < 0.9 * (superimposed(start).distances ** 2).sum()


def test_what_cannot_slide_is_refused() -> None:
    with pytest.raises(BadArgument, match="bending or procrustes"):
        slid(POINTS, REFERENCE, *along_curve(), "far")  # type: ignore[arg-type]
    with pytest.raises(BadArgument, match="need the meshes"):
        slide_all(np.stack([POINTS, REFERENCE]), patches=[1])
    curved = slide_all(np.stack([POINTS, REFERENCE]), [tuple(row) for row in CURVE.tolist()])
    assert curved.shape == (2, 7, 3) and not np.allclose(curved, [POINTS, REFERENCE])
