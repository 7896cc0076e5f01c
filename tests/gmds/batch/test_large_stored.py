"""Large meshes are stored as the copies that are matched: quick to measure, and the maps are those of the meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geodesics import Mesh
from gmds.batch.collection import Shape
from gmds.batch.store import Store
from gmds.matching import large_surfaces
from gmds.matching.large_surfaces import coarse
from gmds.matching.pipeline import match
from gmds.shapes import quadruped
from gmds.surface.measured import measure


@pytest.fixture
def meshes(monkeypatch: pytest.MonkeyPatch) -> tuple[Mesh, Mesh]:
    """Two animals that are large, as large begins at 700 vertices here."""
    monkeypatch.setattr(large_surfaces, "LARGE", 700)
    monkeypatch.setattr(large_surfaces, "WORKING", 400)
    return quadruped(n_vertices=900), quadruped("walk", n_vertices=1000, seed=1)


def test_the_copy_is_stored_and_the_map_is_that_of_the_meshes(meshes: tuple[Mesh, Mesh], tmp_path: Path) -> None:
    store = Store(tmp_path)
    records = [store.keep(Shape(str(k), mesh), mirrored=True) for k, mesh in enumerate(meshes)]
    surfaces = [store.surface(record) for record in records]
    for surface, mesh, record in zip(surfaces, meshes, records, strict=True):
        assert "regular" not in vars(surface), "the whole surface is not measured"
        copy, anew = coarse(surface), coarse(measure(mesh))
        assert copy.mesh.n_vertices < 700 and np.array_equal(copy.mesh.vertices, anew.mesh.vertices)
        assert "regular" in vars(copy) and "reflection" in vars(copy)
        assert np.array_equal(copy.reflection.mesh.vertices, anew.reflection.mesh.vertices)
        assert record.usable == record.vertices == mesh.n_vertices
    stored, direct = match(*surfaces), match(*meshes)
    assert np.array_equal(stored.points.face, direct.points.face)
    assert np.array_equal(stored.points.barycentric, direct.points.barycentric)


def test_vertices_that_go_around_are_spread_over_the_whole(meshes: tuple[Mesh, Mesh], tmp_path: Path) -> None:
    store = Store(tmp_path)
    mesh, samples = store.outside(store.keep(Shape("dog", meshes[0])), 50)
    assert np.array_equal(mesh.vertices, meshes[0].vertices) and len(np.unique(samples)) == 50
    gaps = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[samples], axis=2).min(axis=1)
    assert gaps.max() < 0.2 * np.ptp(mesh.vertices, axis=0).max()


def test_with_a_distance_of_ones_own_the_whole_is_measured(meshes: tuple[Mesh, Mesh], tmp_path: Path) -> None:
    store = Store(tmp_path, whole=True)
    shape = Shape("dog", meshes[0])
    whole = store.surface(store.keep(shape))
    assert "regular" in vars(whole) and whole.regular.spectrum.mass.shape == (900,)
    assert Store(tmp_path).keep(shape).key != store.keep(shape).key
