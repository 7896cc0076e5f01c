"""A region is a surface of its own; its points are points of the whole, however faces are numbered or turned."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, joined

from geodesics import Mesh, MeshError, SurfacePoints
from gmds.errors import TooFewVertices
from gmds.surface.measured import Surface, measure
from gmds.surface.originals import on_original
from gmds.surface.region import Region


def whole(turned: bool) -> Surface:
    """A sphere with a smaller one aside, in large units; some faces turned over."""
    mesh = joined(bumpy_sphere(3), bumpy_sphere(1))
    faces = mesh.faces.copy()
    if turned:
        faces[::7] = faces[::7, [0, 2, 1]]
        faces[3::11] = faces[3::11, [1, 2, 0]]
    return measure(Mesh(100 * mesh.vertices + 5, faces))


def points_of(mesh: Mesh) -> SurfacePoints:
    rng = np.random.default_rng(0)
    return SurfacePoints(mesh, rng.integers(0, mesh.n_faces, 200), rng.dirichlet(np.ones(3), 200))


@pytest.mark.parametrize("reflected", [False, True])
@pytest.mark.parametrize("turned", [False, True])
def test_points_of_a_region_stay_in_place(turned: bool, reflected: bool) -> None:
    surface = whole(turned).reflection if reflected else whole(turned)
    region = Region.of(surface, surface.mesh.vertices[:, 2] > -0.1)
    points = points_of(region.surface.mesh)
    here = region.on_whole(on_original(region.surface, points))
    assert here.mesh is surface.original
    there = region.on_measured(points)
    assert there.mesh is surface.mesh
    np.testing.assert_allclose(on_original(surface, there).positions, here.positions, atol=1e-9)
    frame = np.linalg.lstsq(points.positions - points.positions.mean(axis=0), there.positions, rcond=None)[0]
    assert surface.reflected == region.surface.reflected == reflected and np.linalg.det(frame) > 0
    scale = np.sqrt(region.surface.original.area / region.surface.mesh.area)
    spread = np.linalg.norm(points.positions - points.positions[0], axis=1)
    np.testing.assert_allclose(scale * spread, np.linalg.norm(here.positions - here.positions[0], axis=1), atol=1e-6)


def test_a_region_has_all_vertices_and_the_faces_inside() -> None:
    surface = whole(False)
    inside = surface.mesh.vertices[:, 0] > 0
    region = Region.of(surface, inside)
    assert region.surface.original.n_vertices == surface.original.n_vertices
    used = np.unique(region.surface.mesh.faces)
    assert inside[used].all() and len(used) > 0.8 * inside[np.unique(surface.mesh.faces)].sum()
    assert region.surface.mesh.area == pytest.approx(1)
    assert np.array_equal(surface.original.faces[region.faces], region.surface.original.faces)


def test_all_of_a_surface_is_a_region_of_it() -> None:
    surface = whole(True)
    region = Region.of(surface, np.ones(surface.mesh.n_vertices, dtype=bool))
    np.testing.assert_allclose(region.surface.mesh.vertices, surface.mesh.vertices, atol=1e-12)
    assert len(region.surface.face_index) == len(surface.face_index)


def test_of_two_pieces_the_larger_is_the_region() -> None:
    surface = whole(False)
    z = surface.mesh.vertices[:, 2]
    region = Region.of(surface, (z > 0.05) | (z < -0.15))
    z = z[np.unique(region.surface.mesh.faces)]
    assert (z > 0.05).all() or (z < -0.15).all()


def test_what_is_too_small_is_refused() -> None:
    surface = whole(False)
    few = np.zeros(surface.mesh.n_vertices, dtype=bool)
    few[surface.mesh.faces[0]] = True
    with pytest.raises(TooFewVertices, match="E113"):
        Region.of(surface, few)
    with pytest.raises(MeshError):
        Region.of(surface, np.zeros(surface.mesh.n_vertices, dtype=bool))
