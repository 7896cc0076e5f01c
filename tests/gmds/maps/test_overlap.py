"""What a map is about: exact on parts of a flat sheet, whatever its unit, and all of a surface on itself."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, rectangle, with_isolated

from geodesics import Mesh, SurfacePoints
from gmds import Correspondence
from gmds.maps.overlap import area_share, covered_of
from gmds.report.candidates import CandidateMap


def left_of(sheet: Mesh, most: float) -> Correspondence:
    """The left of a sheet, a mesh of its own, on the whole sheet."""
    kept = np.flatnonzero(sheet.vertices[:, 0] <= most)
    row = np.full(sheet.n_vertices, -1)
    row[kept] = np.arange(len(kept))
    faces = row[sheet.faces]
    part = Mesh(sheet.vertices[kept], faces[(faces >= 0).all(axis=1)])
    return Correspondence.from_points(part, SurfacePoints.at_vertices(sheet, kept))


@pytest.mark.parametrize("scale", [1e-5, 1.0, 1e5])
@pytest.mark.parametrize("most", [0.25, 0.5, 0.8])
def test_a_part_covers_itself_and_what_is_within_a_spacing(most: float, scale: float) -> None:
    sheet = rectangle(40, 40)
    answer = scaled(sheet, most, scale)
    x = sheet.vertices[:, 0]
    assert answer.covered[x <= most].all() and not answer.covered[x > most + 1.5 / 40].any()
    assert answer.overlap[0] == pytest.approx(1) and answer.overlap[1] == pytest.approx(most, abs=1.6 / 40)


def scaled(sheet: Mesh, most: float, scale: float) -> Correspondence:
    """The same map in another unit of length."""
    answer = left_of(sheet, most)
    part, whole = (Mesh(scale * mesh.vertices, mesh.faces) for mesh in (answer.source, answer.target))
    return Correspondence.from_points(part, SurfacePoints(whole, answer.points.face, answer.points.barycentric))


def test_what_is_not_valid_covers_nothing() -> None:
    sheet = rectangle(30, 30)
    valid = sheet.vertices[:, 0] <= 0.5
    points = SurfacePoints.at_vertices(sheet, np.arange(sheet.n_vertices))
    answer = Correspondence.from_points(sheet, points, valid=valid)
    assert np.array_equal(answer.covered, left_of(sheet, 0.5).covered)
    nothing = Correspondence.from_points(sheet, points, valid=np.zeros(sheet.n_vertices, dtype=bool))
    assert not nothing.covered.any() and nothing.overlap == (0, 0)


def test_a_surface_covers_itself_but_for_vertices_on_no_face() -> None:
    mesh = with_isolated(bumpy_sphere(2))
    used = np.bincount(mesh.faces.ravel(), minlength=mesh.n_vertices) > 0
    same = Correspondence.from_points(mesh, SurfacePoints.closest(mesh, mesh.vertices))
    assert not used.all() and np.array_equal(same.covered, used)
    assert same.overlap == (pytest.approx(1), pytest.approx(1))
    few = np.resize(np.flatnonzero(used)[:9], mesh.n_vertices)
    assert Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, few)).covered.sum() < used.sum() / 2


def test_a_map_that_does_not_know_is_asked_as_one_that_does() -> None:
    answer = left_of(rectangle(20, 20), 0.5)
    plain = CandidateMap(
        answer.source,
        answer.target,
        answer.points,
        answer.valid,
        answer.distortion,
        answer.confidence,
        answer.status,
        (),
        {},
    )
    assert np.array_equal(covered_of(plain), answer.covered)


def test_shares_of_area_add_up() -> None:
    mesh = bumpy_sphere(2)
    some = mesh.vertices[:, 2] > 0.1
    assert area_share(mesh, some) + area_share(mesh, ~some) == pytest.approx(1)
    assert 0.2 < area_share(mesh, some) < 0.6
