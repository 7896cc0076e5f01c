"""Meshes with faults are matched as well as clean ones, with a row for every vertex, and it is told."""

from __future__ import annotations

import numpy as np
import pytest
from matched_shapes import bumpy

import gmds
from benchmarks.accuracy import spoiled
from geodesics import Mesh, MeshError
from geodesics.repair.cleaning import cleaned
from gmds.batch.surface_file import read_surface, write_surface
from gmds.maps.point_map import MatchStatus
from gmds.surface.measured import measure

SAMPLES = 50
JOINED = [spoiled.bow_tie, spoiled.fins, spoiled.repeated, spoiled.unwelded, spoiled.charts]


@pytest.mark.parametrize("fault", JOINED, ids=lambda fault: fault.__name__)
def test_a_mesh_with_faults_is_matched_with_its_clean_self(fault: object) -> None:
    clean = bumpy()
    dirty = fault(clean, np.random.default_rng(2))  # type: ignore[operator]
    n = clean.n_vertices
    there = gmds.match(dirty, clean, n_samples=SAMPLES)
    back = gmds.match(clean, dirty, n_samples=SAMPLES)
    for answer, source in ((there, dirty), (back, clean)):
        assert answer.source is source and len(answer.points) == source.n_vertices
        assert np.linalg.norm(answer.points.positions[:n] - clean.vertices, axis=1).max() < 1e-6
        assert answer.valid.all() and answer.status is MatchStatus.GOOD
        assert any(note.startswith("W303") for note in answer.meta["notes"])
    assert back.points.mesh is dirty
    for one in there.candidates:
        assert len(one.points) == dirty.n_vertices


def test_a_mesh_with_t_junctions_is_sewn_and_all_of_it_is_matched() -> None:
    clean = bumpy()
    dirty = spoiled.t_junctions(clean, np.random.default_rng(0))
    n = clean.n_vertices
    for answer in (gmds.match(dirty, clean, n_samples=SAMPLES), gmds.match(clean, dirty, n_samples=SAMPLES)):
        assert len(answer.points) == answer.source.n_vertices and answer.valid.all()
        assert answer.status is MatchStatus.GOOD and min(answer.overlap) > 0.99
        off = np.linalg.norm(answer.points.positions[:n] - clean.vertices, axis=1)
        assert off.mean() < 0.01 * np.sqrt(clean.area)
        assert any("T-junctions" in note for note in answer.meta["notes"] if note.startswith("W303"))
        assert not any(note.startswith("W205") for note in answer.meta["notes"])
    assert answer.points.mesh is dirty  # of the second
    stray = np.linalg.norm(answer.points.positions - clean.vertices[:n], axis=1)
    assert np.isfinite(stray).all() and np.allclose(answer.points.barycentric.sum(axis=1), 1)


def test_a_landmark_in_a_face_that_was_split_is_met() -> None:
    clean = bumpy()
    dirty = spoiled.t_junctions(clean, np.random.default_rng(0))
    copy = cleaned(dirty)
    assert copy is not None and copy.corners is not None
    face = copy.face[(copy.corners != np.eye(3)).any(axis=(1, 2))][0]
    middle = dirty.vertices[dirty.faces[face]].mean(axis=0)
    pairs = (np.array([middle]), np.array([middle]))
    for target in (dirty, clean):
        two = [joined_with_a_copy(mesh) for mesh in (dirty, target)]
        answer = gmds.match(*two, n_samples=SAMPLES, landmarks=pairs)
        sent = answer.points.positions[dirty.faces[face]].mean(axis=0)
        assert np.linalg.norm(sent - middle) < 0.05 * np.sqrt(clean.area)


def joined_with_a_copy(mesh: Mesh) -> Mesh:
    """Beside a smaller copy of itself."""
    other = 0.8 * mesh.vertices + [0.3, 0.2, 4.0]
    return Mesh(np.vstack([mesh.vertices, other]), np.vstack([mesh.faces, mesh.faces + mesh.n_vertices]))


def test_landmarks_of_the_given_meshes_are_met() -> None:
    clean, dirty = bumpy(), spoiled.unwelded(bumpy(), np.random.default_rng(0))
    last = dirty.n_vertices - 1
    place = np.flatnonzero((clean.vertices == dirty.vertices[last]).all(axis=1))[0]
    answer = gmds.match(dirty, clean, n_samples=SAMPLES, landmarks=[[last, place], [0, 0]])
    assert answer.vertex_map()[last] == place and answer.vertex_map()[0] == 0


def test_small_parts_go_along_are_not_valid_and_are_told() -> None:
    clean = bumpy()
    dirty = spoiled.floating(clean, np.random.default_rng(0))
    answer = gmds.match(dirty, clean, n_samples=SAMPLES)
    assert not answer.valid[clean.n_vertices :].any() and answer.valid[: clean.n_vertices].all()
    assert any(note.startswith("W304: 200 small parts of the source") for note in answer.meta["notes"])
    gap = np.linalg.norm(answer.points.positions - dirty.vertices, axis=1)
    assert gap.max() < 0.3 * np.ptp(clean.vertices)


def test_a_stored_surface_keeps_where_faces_were_split(tmp_path: object) -> None:
    surface = measure(spoiled.t_junctions(bumpy(), np.random.default_rng(0)))
    write_surface(f"{tmp_path}/one.npz", surface)
    again = read_surface(f"{tmp_path}/one.npz")
    assert surface.clean is not None and again.clean is not None
    assert np.array_equal(surface.clean.corners, again.clean.corners)


def test_a_stored_surface_keeps_what_was_given(tmp_path: object) -> None:
    dirty = spoiled.charts(bumpy(), np.random.default_rng(0))
    write_surface(f"{tmp_path}/one.npz", measure(dirty))
    again = read_surface(f"{tmp_path}/one.npz")
    assert np.array_equal(again.given.vertices, dirty.vertices) and np.array_equal(again.given.faces, dirty.faces)
    answer = gmds.match(again, bumpy(), n_samples=SAMPLES)
    assert len(answer.points) == dirty.n_vertices and any("welded" in note for note in answer.meta["notes"])


def test_a_soup_that_cannot_be_welded_is_told_to_be_welded() -> None:
    soup = spoiled.unwelded(bumpy(), np.random.default_rng(0))
    centers = soup.vertices[soup.faces].mean(axis=1)
    shrunk = centers[:, None] + 0.9 * (soup.vertices[soup.faces] - centers[:, None])
    apart = Mesh(shrunk.reshape(-1, 3), np.arange(3 * soup.n_faces).reshape(-1, 3))
    with pytest.raises(MeshError, match=r"E113.*weld it"):
        measure(apart)
