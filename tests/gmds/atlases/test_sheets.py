"""Surfaces that touch: the closest point is looked for on the part that faces the same way."""

from __future__ import annotations

import numpy as np
import pytest

from geodesics import Mesh, SurfacePoints, vertex_normals
from gmds.atlases.fusion import Said, fused
from gmds.atlases.registered import MIRROR
from gmds.atlases.sheets import closest_facing, located
from gmds.shapes import quadruped

APART = 0.01  # of two sheets


@pytest.fixture(scope="module")
def sheets() -> Mesh:
    """Two squares one above the other, the upper facing up and the lower down: the outsides of a thin sheet."""
    x, y = (g.ravel() for g in np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 6), indexing="ij"))
    corner = np.arange(36).reshape(6, 6)
    a, b, c, d = corner[:-1, :-1].ravel(), corner[1:, :-1].ravel(), corner[1:, 1:].ravel(), corner[:-1, 1:].ravel()
    up = np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    upper, lower = (np.stack([x, y, np.full(36, z)], axis=1) for z in (APART, 0.0))
    return Mesh(np.vstack([upper, lower]), np.vstack([up, up[:, [0, 2, 1]] + 36]))


@pytest.mark.parametrize("side", [1, -1])
def test_what_faces_the_same_way_is_taken_wherever_outside_is(sheets: Mesh, side: int) -> None:
    rng = np.random.default_rng(0)
    upper = np.column_stack([rng.uniform(0.05, 0.95, (40, 2)), np.full(40, 0.3 * APART)])  # nearer to the lower one
    lower = np.column_stack([rng.uniform(0.05, 0.95, (60, 2)), np.zeros(60)])
    places, faces = np.vstack([upper, lower]), sheets.faces if side > 0 else sheets.faces[:, [0, 2, 1]]
    normals = np.vstack([np.tile([0, 0, 1.0], (40, 1)), np.tile([0, 0, -1.0], (60, 1))])
    on = SurfacePoints(Mesh(sheets.vertices, faces), *closest_facing(places, normals, sheets.vertices, faces)).positions
    assert np.allclose(on[:40, 2], APART) and np.allclose(on[:, :2], places[:, :2]) and np.allclose(on[40:, 2], 0)
    plain = SurfacePoints(Mesh(sheets.vertices, faces), *closest_facing(places, None, sheets.vertices, faces)).positions
    assert np.allclose(plain[:, 2], 0)


def test_where_nothing_near_faces_the_same_way_the_closest_is_taken(sheets: Mesh) -> None:
    half = len(sheets.faces) // 2
    places = np.tile([0.5, 0.5, 0.0], (9, 1))
    normals = np.vstack([np.tile([0, 0, -1.0], (6, 1)), np.tile([0, 0, 1.0], (3, 1))])
    face, _ = closest_facing(places, normals, sheets.vertices, sheets.faces[half:])
    assert len(set(face[[0, 6]].tolist())) <= 2 and (face < half).all()
    assert closest_facing(places[:0], normals[:0], sheets.vertices, sheets.faces)[0].shape == (0,)


def test_points_of_a_mesh_know_their_normals_and_places_do_not(sheets: Mesh) -> None:
    source = Mesh(sheets.vertices * [1, 1, 0.2] + [0, 0, 0.1 * APART], sheets.faces)
    inner = np.arange(7, 29)
    points = SurfacePoints.at_vertices(source, np.concatenate([inner, inner + 36]))
    found = SurfacePoints(sheets, *located(points, sheets.vertices, sheets.faces)).positions
    assert np.allclose(found[: len(inner), 2], APART) and np.allclose(found[len(inner) :, 2], 0)
    plain = SurfacePoints(sheets, *located(points.positions, sheets.vertices, sheets.faces)).positions
    assert np.allclose(plain[:, 2], 0)


def test_on_a_closed_surface_mirrored_or_not_points_stay_where_they_are() -> None:
    animal = quadruped(n_vertices=300)
    turned = Mesh(animal.vertices * MIRROR, animal.faces)  # facing inward as it is written
    for mesh in (animal, turned):
        points = SurfacePoints(mesh, np.arange(mesh.n_faces), np.full((mesh.n_faces, 3), 1 / 3))
        face, weights = located(points, mesh.vertices, mesh.faces)
        on = SurfacePoints(mesh, face, weights).positions
        assert np.abs(on - points.positions).max() < 1e-9


def test_a_median_between_two_sheets_is_brought_to_its_own(sheets: Mesh) -> None:
    upper = np.arange(36)
    places = sheets.vertices.copy()
    places[upper, 2] = 0.2 * APART
    said = [Said(places, np.ones(72, bool), np.ones(72))] * 2
    assert np.allclose(fused(said, sheets).places[upper, 2], 0)
    assert np.allclose(fused(said, sheets, vertex_normals(sheets)).places[upper, 2], APART)
