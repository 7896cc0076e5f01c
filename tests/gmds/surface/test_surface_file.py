"""A measured surface comes back from its file with every bit, so that a match of stored surfaces is the match."""

from __future__ import annotations

from pathlib import Path

import generated_shapes as shapes
import matched_shapes as matched
import numpy as np
import pytest

import gmds
from geodesics import Mesh
from gmds.batch.surface_file import read_surface, write_surface
from gmds.errors import SurfaceFileError
from gmds.matching import pair
from gmds.surface import measured, view
from gmds.surface.measured import Surface, measure


def stored(mesh: Mesh, folder: Path, *, reflected: bool = False) -> Surface:
    path = folder / f"{mesh.n_vertices}-{reflected}.npz"
    write_surface(path, measure(mesh, reflected=reflected))
    return read_surface(path)


def same_map(one: gmds.Correspondence, other: gmds.Correspondence) -> bool:
    arrays = [(m.points.face, m.points.barycentric, m.valid, m.distortion) for m in (one, other)]
    meta = [{key: value for key, value in m.meta.items() if key != "seconds"} for m in (one, other)]
    return all(np.array_equal(a, b) for a, b in zip(*arrays, strict=True)) and meta[0] == meta[1]


def test_everything_that_was_measured_comes_back(tmp_path: Path) -> None:
    mesh = matched.animal(n_vertices=1500)
    before, after = measure(mesh), stored(mesh, tmp_path)
    assert np.array_equal(after.original.vertices, mesh.vertices) and np.array_equal(
        after.mesh.faces, before.mesh.faces
    )
    assert np.array_equal(after.face_index, before.face_index)
    for one, other in zip(before.views, after.views, strict=True):
        assert np.array_equal(one.functions, other.functions) and np.array_equal(one.eigenvalues, other.eigenvalues)
        assert np.array_equal(one.spectrum.mass, other.spectrum.mass)
        for count in (40, 300, 1000):
            assert np.array_equal(one.samples(count), other.samples(count))
    assert np.array_equal(before.squashed_curvature, after.squashed_curvature)
    here, there = pair.simplified(before), pair.simplified(after)
    assert here.mesh.n_faces < mesh.n_faces
    assert np.array_equal(here.mesh.vertices, there.mesh.vertices) and np.array_equal(here.origin, there.origin)
    assert np.array_equal(here.curvature, there.curvature)
    assert np.array_equal(pair.reversing(before), pair.reversing(after))


def test_nothing_is_measured_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    after = stored(matched.bumpy(), tmp_path)

    def never(*_: object, **__: object) -> None:
        raise AssertionError("computed again")

    for module, name in ((measured, "eigenpairs"), (measured, "mean_curvature"), (pair, "mirror")):
        monkeypatch.setattr(module, name, never)
    monkeypatch.setattr(view, "farthest_point_cells", never)
    assert len(after.views) == 3 and len(pair.SurfacePair(after, after).reflections) == 2
    assert len(after.regular.samples(100)) == 100 and after.squashed_curvature.shape == (162,)


@pytest.mark.parametrize("orientation", ["preserve", "any"])
def test_stored_surfaces_are_matched_as_meshes_are(tmp_path: Path, orientation: str) -> None:
    meshes = shapes.bumpy_sphere(1, seed=0), shapes.bumpy_sphere(1, seed=1)
    ours, theirs = stored(meshes[0], tmp_path), stored(meshes[1], tmp_path)
    vars(theirs)["reflection"] = stored(meshes[1], tmp_path, reflected=True)
    plain = gmds.match(*meshes, orientation=orientation)
    for _ in range(2):  # what the first match leaves with the surfaces changes nothing
        assert same_map(plain, gmds.match(ours, theirs, orientation=orientation))


def test_the_largest_part_and_loose_vertices_come_back(tmp_path: Path) -> None:
    whole = matched.bumpy()
    vertices = np.vstack([whole.vertices, whole.vertices[:12] + 9, [[5, 5, 5]]])
    faces = np.vstack([whole.faces, whole.faces[(whole.faces < 12).all(axis=1)] + whole.n_vertices])
    after = stored(Mesh(vertices, faces), tmp_path)
    assert after.original.n_vertices == after.mesh.n_vertices == whole.n_vertices + 13
    assert after.mesh.n_faces == whole.n_faces and len(after.regular.usable) == whole.n_vertices


def test_samples_of_fewer_begin_those_of_more() -> None:
    one, other = measure(matched.bumpy()).regular, measure(matched.bumpy()).regular
    many = one.samples(120)
    assert np.array_equal(other.samples(50), many[:50]) and np.array_equal(one.samples(50), many[:50])
    assert one.cells(50).nearest.max() == 49  # cells are those of the number asked for


def test_a_damaged_file_is_told(tmp_path: Path) -> None:
    stored(matched.bumpy(), tmp_path)
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    for damaged in (b"", whole[:-100], whole[:5000] + b"xxxx" + whole[5004:]):
        path.write_bytes(damaged)
        with pytest.raises(SurfaceFileError, match=path.name):
            read_surface(path)
    np.savez(path, version=np.array(99))
    with pytest.raises(SurfaceFileError, match="version 99"):
        read_surface(path)
    with pytest.raises(FileNotFoundError):
        read_surface(tmp_path / "gone.npz")
