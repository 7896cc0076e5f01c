"""Large surfaces are matched as copies with fewer vertices, and the map is carried back to all of them."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, reflected

import gmds
from geodesics import Mesh
from gmds.landmarks.checking import place_landmarks
from gmds.matching import large_surfaces as coarsening
from gmds.matching.large_surfaces import CoarseCopies, coarse
from gmds.surface.measured import measure

LARGE, WORKING = 900, 500


@pytest.fixture(autouse=True)
def small_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coarsening, "LARGE", LARGE)
    monkeypatch.setattr(coarsening, "WORKING", WORKING)


def whole() -> Mesh:
    return animal("stand", 0, 1500)


def moved_whole() -> Mesh:
    return shapes.moved(whole(), 3.0, seed=4)


def mean_error(answer: gmds.Correspondence, target: Mesh) -> float:
    """Of a map to a copy with the same vertices, x100."""
    gap = np.linalg.norm(answer.points.positions - target.vertices, axis=1)
    return 100 * float(gap.mean() / np.sqrt(target.area))


def test_every_vertex_is_sent_close_to_where_it_belongs() -> None:
    answer = gmds.match(whole(), moved_whole())
    assert answer.points.mesh is answer.target
    assert len(answer.points) == whole().n_vertices
    assert answer.valid.all()
    assert max(answer.meta["solved_vertices"]) < LARGE
    assert mean_error(answer, moved_whole()) < 2


@pytest.mark.parametrize("sizes", [(1500, 600), (600, 1500)])
def test_one_of_two_may_be_large(sizes: tuple[int, int]) -> None:
    source, target = (animal("stand", seed, n) for seed, n in enumerate(sizes))
    answer = gmds.match(source, target)
    assert max(answer.meta["solved_vertices"]) < LARGE
    assert 100 * gmds.geodesic_error(answer, gmds.shapes.truth(source, target)).mean() < 3


def test_a_map_that_reverses_orientation_is_carried_to_the_right_side() -> None:
    target = reflected(whole())
    answer = gmds.match(whole(), target, orientation="reverse")
    assert mean_error(answer, target) < 2


def test_small_surfaces_and_given_distances_have_no_copies() -> None:
    small = measure(animal())
    assert coarse(small) is small
    assert CoarseCopies.of(small, small) is None
    assert "solved_vertices" not in gmds.match(animal(), animal()).meta


def test_what_is_no_manifold_is_cut_apart_and_decimated() -> None:
    mesh = whole()
    fin = Mesh(
        np.vstack([mesh.vertices, mesh.vertices[mesh.faces[0]].mean(axis=0) * 1.1]),
        np.vstack([mesh.faces, [*mesh.faces[0, :2], mesh.n_vertices]]),
    )
    copy = coarse(measure(fin))
    assert copy.mesh.n_vertices < 0.6 * fin.n_vertices
    assert np.isfinite(copy.mesh.vertices).all() and abs(copy.mesh.area - 1) < 1e-9


def test_what_cannot_be_decimated_stays_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coarsening, "decimated", lambda mesh, n_faces: None)
    surface = measure(whole())
    assert coarse(surface) is surface


def test_landmarks_are_kept_but_not_twice() -> None:
    surface = measure(whole())
    copies = CoarseCopies.of(surface, surface)
    assert copies is not None
    everything = np.arange(whole().n_vertices)
    ours, theirs = copies.landmarks(place_landmarks((everything, everything), whole(), whole()).constraints).vertices
    assert len(ours) == copies.copies[0].mesh.n_vertices
    assert len(set(ours.tolist())) == len(ours)
    assert len(set(theirs.tolist())) == len(theirs)
    answer = gmds.match(whole(), moved_whole(), landmarks=[[0, 0], [700, 700], [1400, 1400]])
    assert mean_error(answer, moved_whole()) < 2
    assert answer.vertex_map()[[0, 700, 1400]].tolist() == [0, 700, 1400]


def test_a_second_match_finds_the_copy_made() -> None:
    surface = measure(whole())
    assert coarse(surface) is coarse(surface)


@pytest.mark.parametrize("mirrored", [False, True])
def test_what_keeps_its_shape_is_laid_with_all_its_vertices(mirrored: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    source = shapes.bumpy_sphere(4, seed=2)
    bowed = source.vertices * [1.0, 1.08, 0.96] + 0.04 * source.vertices[:, [1]] ** 2
    target = reflected(Mesh(bowed, source.faces)) if mirrored else Mesh(bowed, source.faces)
    orientation: gmds.matching.attempts.Orientation = "reverse" if mirrored else "preserve"
    answer = gmds.match(source, target, orientation=orientation)
    assert answer.meta["evidence"]["laid_in_space"]
    monkeypatch.setattr(coarsening, "MOST_LAID", 0)
    before = gmds.match(source, target, orientation=orientation)
    assert mean_error(answer, target) < 0.7 * mean_error(before, target)
