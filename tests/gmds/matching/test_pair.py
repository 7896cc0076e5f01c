"""What is computed of two surfaces before any map."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, reflected, surface

from geodesics import SurfacePoints
from gmds.landmarks.checking import place_landmarks
from gmds.landmarks.soft import SoftLandmarks
from gmds.matching import pair as pair_module
from gmds.matching.pair import WEIGHT, SurfacePair
from gmds.spectral.orientation import vertex_map_orientation
from gmds.surface.measured import Surface, measure
from gmds.surface.view import View

KNOWN = [[3, 5], [40, 41], [90, 7]]


def test_without_landmarks_samples_stay_as_they_are() -> None:
    pair = SurfacePair(surface(bumpy()), surface(bumpy()))
    samples, points = np.array([1, 2]), SurfacePoints.at_vertices(pair.target.mesh, [4, 5])
    ours, theirs = pair.with_landmarks(samples, points)
    assert ours is samples and theirs is points


def test_landmarks_are_added_as_often_as_they_count() -> None:
    landmarks = place_landmarks(SoftLandmarks([*KNOWN, [11, 12]], [0, 0, 0, 0.1]), bumpy(), bumpy()).constraints
    pair = SurfacePair(surface(bumpy()), surface(bumpy()), landmarks)
    ours, theirs = pair.with_landmarks(np.array([1, 2]), SurfacePoints.at_vertices(pair.target.mesh, [4, 5]))
    assert len(ours) == len(theirs) == 2 + 3 * WEIGHT
    assert ours[:2].tolist() == [1, 2] and theirs[:2].nearest_vertices().tolist() == [4, 5]
    added = set(zip(ours[2:].tolist(), theirs[2:].nearest_vertices().tolist(), strict=True))
    assert added == {(3, 5), (40, 41), (90, 7)}
    assert np.bincount(ours)[[3, 40, 90]].tolist() == [WEIGHT] * 3  # and the soft one not at all


def test_an_animal_has_a_reflection_that_turns_it_over_and_undoes_itself() -> None:
    pair = SurfacePair(surface(animal()), surface(bumpy()))
    ours, theirs = pair.reflections
    assert ours is not None and theirs is None  # one is enough
    mesh = pair.source.mesh
    assert vertex_map_orientation(mesh, mesh, ours) < -0.5
    assert np.linalg.norm(mesh.vertices[ours] - mesh.vertices * [1, -1, 1], axis=1).mean() < 0.05
    assert np.linalg.norm(mesh.vertices[ours[ours]] - mesh.vertices, axis=1).mean() < 0.02


def test_where_the_source_has_no_reflection_that_of_the_target_is_sought(monkeypatch: pytest.MonkeyPatch) -> None:
    source, target, flip = measure(bumpy()), measure(animal()), np.arange(600)[::-1]
    seen = []

    def mirror(one: Surface, view: View) -> np.ndarray | None:
        seen.append((one, view))
        return None if one is source else flip

    monkeypatch.setattr(pair_module, "mirror", mirror)
    ours, theirs = SurfacePair(source, target).reflections
    assert ours is None and theirs is flip
    assert seen == [(source, source.regular), (target, target.regular)]
    assert SurfacePair(target, source).reflections[0] is flip and len(seen) == 2  # once is enough


def test_both_surfaces_are_seen_whole_and_in_outline() -> None:
    pair = SurfacePair(measure(shapes.bumpy_sphere(4)), surface(bumpy()))
    assert [g.mesh for g in pair.full] == [pair.source.mesh, pair.target.mesh]
    assert pair.simplified[0].mesh.n_faces < 0.5 * pair.source.mesh.n_faces
    assert pair.simplified[1].mesh is pair.target.mesh
    assert pair.simplified is pair.simplified and pair.full is pair.full


def test_the_mirror_image_of_a_mirror_image_is_the_surface() -> None:
    plain, twice = surface(bumpy()), measure(reflected(bumpy(), axis=0), reflected=True)
    assert np.allclose(twice.mesh.vertices, plain.mesh.vertices)
    normals = [SurfacePair(one, one).full[0].normals for one in (plain, twice)]
    assert np.allclose(*normals)
