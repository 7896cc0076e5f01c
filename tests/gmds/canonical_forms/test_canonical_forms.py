"""Scalings give back points that exist, never raise the stress, and bring isometric surfaces together."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, joined, rectangle

import geodesics
import gmds
from geodesics import Mesh
from geodesics.errors import BadArgument
from geodesics.euclidean import euclidean_distances
from gmds.canonical_forms import classical_scaling, smacof, squared_distances_in_eigenfunctions
from gmds.canonical_forms.canonical_form import METHODS
from gmds.canonical_forms.smacof import guttman, stress_of

RNG = np.random.default_rng(5)
POINTS = RNG.normal(size=(40, 3))
DISTANCES = euclidean_distances(POINTS, POINTS)
each_method = pytest.mark.parametrize("method", METHODS)


def aligned(x: np.ndarray, y: np.ndarray) -> float:
    """The largest distance of points x from y after the best rigid motion and reflection."""
    x, y = x - x.mean(axis=0), y - y.mean(axis=0)
    u, _, vt = np.linalg.svd(x.T @ y)
    return float(np.linalg.norm(x @ u @ vt - y, axis=1).max())


@pytest.mark.parametrize("scaling", [classical_scaling, smacof])
@pytest.mark.parametrize("weights", [None, RNG.uniform(0.2, 3, 40)], ids=["equal", "weighted"])
def test_points_of_a_euclidean_space_come_back(scaling: Any, weights: Any) -> None:
    assert aligned(scaling(DISTANCES, 3, weights), POINTS) < 1e-6
    assert aligned(scaling(DISTANCES, 5, weights)[:, :3], POINTS) < 1e-6  # what is not needed is 0


def test_a_guttman_transform_never_raises_the_stress() -> None:
    d = DISTANCES * RNG.uniform(0.7, 1.3, DISTANCES.shape)
    d, w = 0.5 * (d + d.T), np.full(40, 1 / 40)
    x, before = RNG.normal(size=(40, 2)), np.inf
    for _ in range(30):
        between = euclidean_distances(x, x)
        stress = stress_of(d, between, w)
        assert stress <= before * (1 + 1e-12)
        x, before = guttman(x, d, between, w), stress
    assert stress_of(d, euclidean_distances(*2 * (smacof(d, 2),)), w) < before


@each_method
def test_a_plane_is_its_own_form(method: Any) -> None:
    plane = rectangle(20, 14)
    form = gmds.canonical_form(geodesics.GeodesicDistance(plane), method=method, samples=60)
    # marching is a few thousandths long; eigenfunctions do not resolve the straight boundary
    assert aligned(form.positions, plane.vertices) < (0.05 if method == "spectral" else 0.03)
    assert form.stress < (0.03 if method == "spectral" else 0.01)


@each_method
def test_a_bent_surface_has_the_same_form(method: Any) -> None:
    straight = rectangle(24, 12)
    x, y, _ = straight.vertices.T
    angle = 2.5 * x / np.ptp(x)
    bent = Mesh(np.stack([np.sin(angle), y * 2.5 / np.ptp(x), np.cos(angle)], axis=1) * np.ptp(x) / 2.5, straight.faces)
    same = np.arange(0, straight.n_vertices, 6)
    forms = [gmds.canonical_form(geodesics.GeodesicDistance(m), method=method, samples=same) for m in (straight, bent)]
    assert aligned(forms[0].positions, forms[1].positions) < 0.03 * np.ptp(x)
    assert np.ptp(bent.vertices[:, 2]) > 0.5 * np.ptp(x)  # it is bent


def test_least_squares_has_the_least_stress_and_more_dimensions_less() -> None:
    distance = geodesics.CommuteTimeDistance(geodesics.scale_invariant(bumpy_sphere(2)))
    stress = {m: gmds.canonical_form(distance, method=m, samples=80).stress for m in METHODS}
    assert stress["least squares"] < stress["classical"]
    assert gmds.canonical_form(distance, 6, samples=80).stress < stress["least squares"]


def test_vertices_between_samples_have_their_distances_as_well() -> None:
    mesh = bumpy_sphere(3)
    distance = geodesics.GeodesicDistance(mesh)
    form = gmds.canonical_form(distance, samples=60, weights="area")
    others = np.setdiff1d(np.arange(mesh.n_vertices), form.samples)[::5]
    d = geodesics.distance_matrix(distance, others)
    left = d - euclidean_distances(form.positions[others], form.positions[others])
    assert np.sqrt((left**2).sum() / (d**2).sum()) < 1.15 * form.stress
    assert form.bent.n_faces == mesh.n_faces and repr(form).startswith("CanonicalForm(3 dimensions")


def test_all_squared_distances_are_in_few_numbers() -> None:
    mesh = bumpy_sphere(3)
    distance, spectrum = geodesics.GeodesicDistance(mesh), geodesics.eigenpairs(mesh, 80)
    samples = geodesics.farthest_point_sampling(distance, 150)
    between = geodesics.distance_matrix(distance, samples)
    alpha = squared_distances_in_eigenfunctions(spectrum, samples, between)
    rows = spectrum.eigenfunctions[::7]
    expected = geodesics.distance_matrix(distance, np.arange(mesh.n_vertices)[::7])
    got = np.sqrt(np.maximum(rows @ alpha @ rows.T, 0))
    assert np.sqrt(((got - expected) ** 2).mean()) < 0.02 * expected.mean()


@each_method
def test_what_samples_cannot_reach_has_no_place(method: Any) -> None:
    here, lone = bumpy_sphere(2), [[9.0, 9.0, 9.0]]
    two = joined(here, bumpy_sphere(1))
    known = np.arange(two.n_vertices) < here.n_vertices
    form = gmds.canonical_form(geodesics.GeodesicDistance(two), method=method, samples=np.arange(0, 150, 5))
    assert np.array_equal(np.isfinite(form.positions).all(axis=1), known)
    with pytest.raises(BadArgument, match="out of reach"):
        _ = form.bent
    loose = Mesh(np.vstack([lone, here.vertices]), here.faces + 1)  # a vertex on no face
    form = gmds.canonical_form(geodesics.GeodesicDistance(loose), method=method, samples=60)
    assert np.isnan(form.positions[0]).all() and np.isfinite(form.positions[1:]).all()
    assert not form.bent.vertices[0].any()


def test_four_vertices_have_a_form_of_three_eigenfunctions() -> None:
    corners = Mesh(np.vstack([np.zeros(3), np.eye(3)]), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    form = gmds.canonical_form(geodesics.GeodesicDistance(corners), method="spectral")
    assert form.positions.shape == (4, 3) and form.stress < 0.05


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: smacof(np.zeros((3, 2)), 2), "square matrix"),
        (lambda: classical_scaling([[0, np.inf], [np.inf, 0]], 2), "finite"),
        (lambda: classical_scaling([[0, 1], [2, 0]], 2), "symmetric"),
        (lambda: smacof(DISTANCES, 2, np.zeros(40)), "positive numbers"),
        (lambda: smacof(DISTANCES, 2, start=np.zeros((3, 2))), "start must be"),
        (lambda: gmds.canonical_form(geodesics.GeodesicDistance(rectangle(4, 4)), 0), "dimension"),
        (lambda: gmds.canonical_form(geodesics.GeodesicDistance(rectangle(4, 4)), method="pca"), "method"),
        (lambda: gmds.canonical_form(geodesics.GeodesicDistance(rectangle(4, 4)), weights="mass"), "weights"),
        (lambda: gmds.canonical_form(geodesics.GeodesicDistance(rectangle(4, 4)), 2).bent, "ask for three"),
    ],
)
def test_what_cannot_be_is_refused(call: Any, says: str) -> None:
    with pytest.raises(BadArgument, match=says):
        call()
