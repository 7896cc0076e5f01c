"""What tells a map from its mirror image."""

from __future__ import annotations

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy, mirror_vertices, reflected, surface

from geodesics import Mesh, eigenpairs
from geodesics.curvature import vertex_normals
from geodesics.metric import conformal
from geodesics.topology.orientation import orient_faces
from gmds._kernels.sample_maps import minors
from gmds.spectral.functional_maps import functional_map
from gmds.spectral.orientation import FUNCTIONS, orientation_forms, orientation_score, vertex_map_orientation
from gmds.surface.view import View

LOBED = shapes.ellipsoid(2, (1.0, 1.4, 2.0))


@pytest.mark.parametrize("mesh", [LOBED, bumpy(), shapes.torus(24, 12)], ids=["ellipsoid", "bumpy", "torus"])
def test_the_identity_keeps_orientation(mesh: Mesh) -> None:
    assert vertex_map_orientation(mesh, mesh, np.arange(mesh.n_vertices)) > 0.95


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_reflection_reverses_it_by_the_same_amount(axis: int) -> None:
    mirror = mirror_vertices(LOBED, axis)
    assert np.array_equal(mirror[mirror], np.arange(LOBED.n_vertices))
    kept = vertex_map_orientation(LOBED, LOBED, np.arange(LOBED.n_vertices))
    assert vertex_map_orientation(LOBED, LOBED, mirror) == pytest.approx(-kept, abs=1e-6)


def test_two_reflections_keep_orientation() -> None:
    turn = mirror_vertices(LOBED, 0)[mirror_vertices(LOBED, 2)]
    assert vertex_map_orientation(LOBED, LOBED, turn) > 0.95


def test_the_score_does_not_depend_on_size_place_or_facing() -> None:
    moved, same = shapes.moved(bumpy(), 1e-5, seed=3), np.arange(bumpy().n_vertices)
    score = vertex_map_orientation(bumpy(), bumpy(), same)
    assert vertex_map_orientation(moved, bumpy(), same) == pytest.approx(score, abs=1e-9)
    assert vertex_map_orientation(bumpy(), moved, same) == pytest.approx(score, abs=1e-6)
    mirrored = orient_faces(reflected(bumpy()))  # outward again, so the map to it turns every triangle over
    assert vertex_map_orientation(bumpy(), mirrored, same) == pytest.approx(-score, abs=1e-9)


def test_the_score_of_a_constant_map_is_zero() -> None:
    mesh = bumpy()
    images = np.zeros((mesh.n_vertices, 3))
    assert orientation_score(mesh, mesh, images, vertex_normals(mesh)) == 0.0


def test_half_a_surface_folded_over_the_other_half_scores_zero() -> None:
    fold = np.where(LOBED.vertices[:, 2] < 0, mirror_vertices(LOBED, 2), np.arange(LOBED.n_vertices))
    assert abs(vertex_map_orientation(LOBED, LOBED, fold)) < 0.05


def test_forms_change_sign_under_a_reflection() -> None:
    view, mirror = surface(LOBED).regular, mirror_vertices(LOBED, 1)
    pulled = View(
        view.mesh, type(view.spectrum)(view.mesh, view.spectrum.mass, view.eigenvalues, view.functions[mirror])
    )
    forms = orientation_forms(view, np.arange(LOBED.n_vertices))
    assert np.allclose(orientation_forms(pulled, mirror), -forms, atol=1e-6 * np.abs(forms).max())


def test_forms_of_a_turned_mesh_are_the_same_and_of_a_turned_over_mesh_the_opposite() -> None:
    view = surface(bumpy()).regular
    points = np.arange(bumpy().n_vertices)
    over = Mesh(view.mesh.vertices, view.mesh.faces[:, [0, 2, 1]])
    forms = orientation_forms(view, points)
    assert np.abs(forms).max() > 0
    assert np.allclose(orientation_forms(View(over, view.spectrum), points), -forms)


def test_forms_times_area_do_not_depend_on_the_conformal_factor() -> None:
    # the same functions, in another conformal metric: the 2-forms stay, their density changes with the area
    view = surface(bumpy()).regular
    factor = np.exp(np.random.default_rng(0).uniform(-1, 1, bumpy().n_vertices))
    spectrum = view.spectrum
    other = View(view.mesh, type(spectrum)(view.mesh, factor * spectrum.mass, spectrum.eigenvalues, view.functions))
    points = np.arange(0, bumpy().n_vertices, 3)
    here, there = orientation_forms(view, points), orientation_forms(other, points)
    assert np.allclose(here, there * factor[points, None])


def test_forms_integrate_to_zero_on_a_closed_surface() -> None:
    # d phi_i ^ d phi_j = d(phi_i d phi_j)
    view = surface(bumpy()).regular
    forms = orientation_forms(view, view.usable)
    total = view.spectrum.mass[view.usable] @ forms
    assert np.abs(total).max() < 1e-10 * np.abs(forms).max()


def test_pulled_back_forms_are_the_forms_of_the_combined_functions() -> None:
    view = surface(bumpy()).regular
    rng, n = np.random.default_rng(1), bumpy().n_vertices
    matrix = np.eye(8)
    matrix[1 : FUNCTIONS + 1, 1 : FUNCTIONS + 1] = rng.standard_normal((FUNCTIONS, FUNCTIONS))
    combined = view.functions.copy()
    combined[:, 1 : FUNCTIONS + 1] = (
        view.functions[:, 1 : FUNCTIONS + 1] @ matrix[1 : FUNCTIONS + 1, 1 : FUNCTIONS + 1].T
    )
    expected = orientation_forms(
        View.of(type(view.spectrum)(view.mesh, view.spectrum.mass, view.eigenvalues, combined)), np.arange(n)
    )
    found = orientation_forms(view, np.arange(n)) @ minors(matrix).T
    assert np.allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_forms_of_nearly_the_same_surface_in_another_metric_agree_through_the_functional_map() -> None:
    mesh = surface(bumpy()).mesh
    factor = 1 + 0.2 * np.tanh(mesh.vertices[:, 0] / mesh.vertices[:, 0].std())
    view, other = surface(bumpy()).regular, View.of(eigenpairs(conformal(mesh, factor), 60))
    points = np.arange(mesh.n_vertices)
    matrix = functional_map(view.functions[:, :20], other.functions[:, :20])
    ours, theirs = orientation_forms(view, points), orientation_forms(other, points) @ minors(matrix).T
    factor = (other.spectrum.mass / view.spectrum.mass)[:, None]
    assert np.corrcoef(ours.ravel(), (theirs * factor).ravel())[0, 1] > 0.9
