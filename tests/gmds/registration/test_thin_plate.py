"""Splines of maps: what they keep, what they smooth, what they go through."""

from __future__ import annotations

import numpy as np
from matched_shapes import animal, bumpy, surface

from geodesics import SurfacePoints
from gmds.registration.deformable import DeformableMesh
from gmds.registration.thin_plate import ThinPlate


def plate_of(mesh: object) -> ThinPlate:
    whole = DeformableMesh.of(surface(mesh))  # type: ignore[arg-type]
    return ThinPlate(whole, whole)


def test_a_map_that_is_smooth_stays() -> None:
    plate = plate_of(bumpy())
    mesh = plate.source.mesh
    same = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    assert np.linalg.norm(plate.smoothed(same).positions - mesh.vertices, axis=1).mean() < 0.01


def test_noise_is_smoothed_away() -> None:
    plate = plate_of(bumpy())
    mesh = plate.source.mesh
    rough = SurfacePoints.closest(mesh, mesh.vertices + np.random.default_rng(0).normal(0, 0.05, mesh.vertices.shape))
    before, after = (
        np.linalg.norm(points.positions - mesh.vertices, axis=1).mean() for points in (rough, plate.smoothed(rough))
    )
    assert after < 0.75 * before


def test_samples_have_their_say() -> None:
    """From a map that is off everywhere, samples that are right bring back what lies between them."""
    plate = plate_of(animal())
    mesh = plate.source.mesh
    samples = surface(animal()).regular.samples(300)
    off = SurfacePoints.closest(mesh, mesh.vertices + np.array([0.08, 0, 0]))
    right = SurfacePoints.at_vertices(mesh, samples)
    before, after = (
        np.linalg.norm(points.positions - mesh.vertices, axis=1).mean()
        for points in (off, plate.through(samples, right, off))
    )
    assert after < 0.4 * before


def test_a_spline_is_linear_in_its_goals_and_keeps_constants() -> None:
    """The energy of bending knows no place: moved goals move the spline."""
    plate = plate_of(bumpy())
    shift = np.array([1.0, -2.0, 0.5])
    areas, y = plate.source.areas, plate.source.mesh.vertices
    solve = plate._bending.solver(1e-6, areas)
    moved = solve(areas[:, None] * (y + shift))
    np.testing.assert_allclose(moved, solve(areas[:, None] * y) + shift, atol=1e-6)
