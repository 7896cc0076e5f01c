"""Growth is that of lengths and areas: exact where a surface is resized or stretched, near the truth where a map is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, rectangle
from known_maps import identity
from scipy.stats import spearmanr

from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument
from gmds.correspondence import Correspondence
from gmds.deformations import achieved_log_scale, branch_log_scale, local_scaling
from gmds.maps.growth import growth_between, growth_of
from gmds.pictures.software import software
from gmds.shapes import quadruped, truth


def test_a_copy_of_another_size_grew_everywhere_by_as_much() -> None:
    mesh = bumpy_sphere(2)
    found = growth_between(mesh, Mesh(3 * mesh.vertices + 7, mesh.faces))
    assert np.allclose(found.length, np.log(3)) and np.allclose(found.area, 2 * np.log(3))
    assert np.allclose(found.stretches, 3) and np.allclose(found.relative, 0)
    assert np.allclose(identity(mesh).growth, 0)


def test_a_stretched_sheet_has_its_stretches_and_their_direction() -> None:
    sheet = rectangle(2.0, 1.0, 12, 8)
    found = growth_between(sheet, Mesh(sheet.vertices * [2.0, 0.5, 1.0], sheet.faces))
    assert np.allclose(found.stretches, [2.0, 0.5]) and np.allclose(found.area, 0, atol=1e-12)
    assert np.allclose(found.length, np.log(1.25)) and np.allclose(np.abs(found.direction), [1, 0, 0], atol=1e-6)


def test_a_mirror_image_and_faces_turned_over_make_no_difference() -> None:
    mesh, u = icosphere(3), 0.4 * icosphere(3).vertices[:, 0]
    grown, points = local_scaling(mesh, u)
    plain = Correspondence.from_points(mesh, points).growth
    mirrored = Mesh(grown.vertices * [-1, 1, 1], grown.faces)
    turned = SurfacePoints.at_vertices(mirrored, np.arange(mesh.n_vertices))
    assert np.allclose(Correspondence.from_points(mesh, turned).growth, plain)
    assert spearmanr(plain, u)[0] > 0.99


def test_without_counterparts_growth_is_unknown_there_and_as_before_far_from_there() -> None:
    mesh = icosphere(3)
    _, points = local_scaling(mesh, 0.4 * mesh.vertices[:, 0])
    valid = mesh.vertices[:, 2] < 0.3
    part = Correspondence.from_points(mesh, points, valid=valid).growth
    whole = Correspondence.from_points(mesh, points).growth
    assert np.isnan(part[mesh.vertices[:, 2] > 0.9]).all() and np.isfinite(part[valid]).all()
    assert np.abs(part - whole)[mesh.vertices[:, 2] < -0.2].max() < 0.01
    nothing = growth_of(Correspondence.from_points(mesh, points, valid=np.zeros(mesh.n_vertices, dtype=bool)))
    assert np.isnan(nothing.length).all() and np.isnan(nothing.relative).all()


def test_the_true_map_of_an_animal_to_one_with_other_triangles_tells_where_it_grew() -> None:
    source = quadruped(n_vertices=900)
    target = quadruped("walk", head_scale=1.6, leg_scale=0.8, n_vertices=900, seed=1)
    same = SurfacePoints.closest(Mesh(target.rest, target.faces), source.rest)
    after = Mesh(SurfacePoints(target, same.face, same.barycentric).positions, source.faces)
    found = Correspondence.from_points(source, truth(source, target)).growth
    raw = achieved_log_scale(source, after)
    assert np.median(np.abs(found - raw)) < 0.05 and spearmanr(found, raw)[0] > 0.9
    head = source.rest[:, 0] > 1.1
    legs = source.rest[:, 2] < 0.5
    assert abs(np.median(found[head]) - np.log(1.6)) < 0.05 and np.median(np.abs(found - raw)[legs]) < 0.1


def test_a_field_of_scale_comes_back() -> None:
    mesh = quadruped(n_vertices=900)
    grown, points = local_scaling(mesh, branch_log_scale(mesh, 1.6, count=4))
    found = growth_of(Correspondence.from_points(mesh, points), smoothing=3e-4).length
    raw = achieved_log_scale(mesh, grown)
    assert spearmanr(found, raw)[0] > 0.95 and np.median(np.abs(found - raw)) < 0.05


def test_triangles_that_collapse_are_no_obstacle() -> None:
    mesh = icosphere(2)
    flat = mesh.vertices.copy()
    flat[:10] = flat[0]
    found = growth_between(mesh, Mesh(flat, mesh.faces))
    assert np.isfinite(found.length).all() and np.isfinite(growth_between(Mesh(flat, mesh.faces), mesh).length).all()


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(BadArgument, match="positive share"):
        growth_of(identity(bumpy_sphere(1)), smoothing=0.0)
    with pytest.raises(BadArgument, match="same faces"):
        growth_between(bumpy_sphere(1), icosphere(2))


def test_a_picture_shows_growth_when_it_is_asked_for(tmp_path: Path) -> None:
    answer = identity(bumpy_sphere(1))
    answer.picture(tmp_path / "a.png", renderer=software, show="growth", pixels=80)
    assert (tmp_path / "a.png").stat().st_size > 1000
    with pytest.raises(BadArgument, match="doubt or growth"):
        answer.picture(tmp_path / "b.png", show="size")
