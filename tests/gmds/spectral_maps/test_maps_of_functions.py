"""Functional maps pull back what they should, commute with what they should, and find known maps."""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, joined
from matched_shapes import animal, permuted, reflected

import geodesics
import gmds
from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument, BadShape
from gmds.shapes import truth
from gmds.spectral_maps.operators import multiplication, orientation_operator
from gmds.spectral_maps.spectral_gmds import carried_over
from gmds.surface.view import View


def twice(mesh: Mesh, count: int) -> object:
    """Spectral scaling of two components."""
    distance = geodesics.BiharmonicDistance(joined(mesh, mesh))
    return gmds.spectral_gmds(distance, distance, np.arange(2 * mesh.n_vertices), count=count)


def mean_error(points: SurfacePoints, true: SurfacePoints) -> float:
    return 100 * float(gmds.geodesic_error(points, true).mean())


def test_a_relabelled_copy_has_a_permutation_of_signs_and_its_map_comes_back() -> None:
    mesh = bumpy_sphere(2)
    other, place = permuted(mesh)
    found = gmds.functional_map(mesh, other, points=place, count=20)
    np.testing.assert_allclose(np.abs(found.matrix), np.eye(20), atol=1e-5)
    assert np.array_equal(found.vertex_map(), place)
    values = other.vertices[:, 2]
    smooth = gmds.functional_map(mesh, other, points=place, count=100).pull_back(values)
    assert np.abs(smooth - values[place]).mean() < 0.02 * np.ptp(values)


def test_descriptors_find_the_map_and_a_reflection_is_told_from_it() -> None:
    source, target = animal(), animal("walk", seed=1)
    true = truth(source, target)
    error = {}
    for orientation in ("preserve", "reverse"):
        rough = gmds.functional_map(source, target, count=20, orientation=orientation)  # type: ignore[arg-type]
        error[orientation] = mean_error(rough.zoomed_out(60).points(), true)
    assert error["preserve"] < 3 < 15 < error["reverse"]  # 1.9 and 23 when written


def test_between_two_metrics_the_map_of_an_area_preserving_pair_is_orthogonal() -> None:
    mesh = bumpy_sphere(2)
    regular = geodesics.eigenpairs(mesh, 60)
    invariant = geodesics.eigenpairs(geodesics.scale_invariant(mesh), 60)
    same = np.arange(mesh.n_vertices)
    found = gmds.functional_map(invariant, regular, points=same, count=60)
    assert abs(found.matrix[0, 0]) == pytest.approx(1)  # constants stay constant
    np.testing.assert_allclose(found.matrix[:12, :12], gmds.self_functional_map(mesh, 12), atol=1e-5)
    plain = gmds.functional_map(regular, regular, points=same, count=30)
    np.testing.assert_allclose(plain.matrix, np.eye(30), atol=1e-8)


def test_own_descriptors_are_welcome() -> None:
    mesh = bumpy_sphere(2)
    other, place = permuted(mesh)
    columns = np.random.default_rng(0).normal(size=(mesh.n_vertices, 60))
    theirs = np.empty_like(columns)
    theirs[place] = columns
    found = gmds.functional_map(mesh, other, (columns, theirs), count=30)
    assert (found.vertex_map() == place).mean() > 0.95


def test_operators_multiply_and_tell_orientation() -> None:
    mesh = bumpy_sphere(2)
    view, mirror = (View.of(geodesics.eigenpairs(m, 40)) for m in (mesh, reflected(mesh)))
    f = mesh.vertices[:, 0]
    product = multiplication(view, np.ones(mesh.n_vertices), 40)
    np.testing.assert_allclose(product, np.eye(40), atol=1e-9)
    turned = orientation_operator(view, f, 10)
    np.testing.assert_allclose(orientation_operator(view, 3 * f + 1, 10), 3 * turned, atol=1e-9)
    scaled = Mesh(5 * mesh.vertices, mesh.faces)
    again = orientation_operator(View.of(geodesics.eigenpairs(scaled, 40)), f, 10)
    np.testing.assert_allclose(np.abs(again), np.abs(turned), atol=1e-6)  # depends on no unit, but for signs
    own = View(mirror.mesh, view.spectrum)  # the same functions, the other way around
    flipped = orientation_operator(View(Mesh(mesh.vertices, mesh.faces[:, ::-1]), own.spectrum), f, 10)
    np.testing.assert_allclose(flipped, -turned, atol=1e-12)


def test_the_self_functional_map_does_not_change_with_pose_size_or_numbering() -> None:
    mesh = animal()
    features = gmds.self_functional_features(mesh)
    other, _ = permuted(Mesh(7 * mesh.vertices[:, [1, 2, 0]], mesh.faces))
    np.testing.assert_allclose(gmds.self_functional_features(other), features, atol=1e-5)
    posed = np.abs(gmds.self_functional_features(animal("walk", seed=1)) - features).sum()
    ball = np.abs(gmds.self_functional_features(bumpy_sphere(2)) - features).sum()
    assert posed < 0.7 * ball
    assert gmds.retrieve(mesh, [bumpy_sphere(2), animal("walk", seed=1)], gmds.self_functional_features).order[0] == 1
    found = gmds.retrieve(
        mesh, [gmds.shapes.humanoid(n_vertices=600), animal("walk", seed=1)], gmds.self_functional_features
    )
    assert found.order[0] == 1


@pytest.mark.parametrize("exponent", [0.0, 0.5])
def test_spectral_scaling_improves_a_rough_map(exponent: float) -> None:
    source, target = animal(), animal("walk", seed=1)
    true = truth(source, target)
    shaken = true.positions + np.random.default_rng(0).normal(0, 0.15, (len(true), 3))
    rough = SurfacePoints.closest(target, shaken)
    metric = functools.partial(geodesics.scale_invariant, exponent=exponent, smoothing=0.02)
    distances = [geodesics.GeodesicDistance(metric(mesh)) for mesh in (source, target)]
    placed = gmds.spectral_gmds(*distances, rough, count=30, samples=100)
    assert mean_error(placed.points, true) < 0.5 * mean_error(rough, true)
    turn = placed.map.matrix
    np.testing.assert_allclose(turn.T @ turn, np.eye(30), atol=1e-9)
    same = gmds.spectral_gmds(distances[0], distances[0], np.arange(source.n_vertices), count=30, samples=100)
    assert same.stress < 1e-6


def test_steps_of_spectral_scaling_never_raise_the_stress() -> None:
    rng = np.random.default_rng(2)
    points = rng.normal(size=(2, 12, 4))
    squared = [((x[:, None] - x) ** 2).sum(axis=2) for x in points]
    turn = np.linalg.qr(np.column_stack([np.ones(12), rng.normal(size=(12, 11))]))[0]
    first, second = (turn.T @ d @ turn for d in squared)
    start = np.eye(12)
    start[1:, 1:] = np.linalg.qr(rng.normal(size=(11, 11)))[0]
    end = carried_over(first, second, start)

    def stress(c: np.ndarray) -> float:
        return float(((c.T @ first @ c - second) ** 2).sum())

    assert stress(end) < stress(start)
    np.testing.assert_allclose(end.T @ end, np.eye(12), atol=1e-9)
    np.testing.assert_allclose(carried_over(first, first, np.eye(12)), np.eye(12), atol=1e-6)


@pytest.mark.parametrize("flipped", [(0,), (0, 3), (5,)])
def test_signs_of_eigenfunctions_have_no_say_in_spectral_scaling(flipped: tuple[int, ...]) -> None:
    """Not that of the constant one either: it is as often -1 as 1."""
    source, target = animal(), animal("walk", seed=1)
    spectra = [geodesics.eigenpairs(mesh, 20) for mesh in (source, target)]
    signs = np.ones(20)
    signs[list(flipped)] = -1
    other = dataclasses.replace(spectra[1], eigenfunctions=spectra[1].eigenfunctions * signs)
    ours, theirs, turned = (geodesics.BiharmonicDistance(one) for one in (*spectra, other))
    found, same = (
        gmds.spectral_gmds(ours, one, truth(source, target), count=20, samples=60) for one in (theirs, turned)
    )
    assert same.stress == pytest.approx(found.stress, rel=1e-9)
    np.testing.assert_allclose(same.map.matrix, found.map.matrix * signs, atol=1e-9)


@pytest.mark.parametrize(
    ("call", "error", "says"),
    [
        (lambda m: gmds.functional_map(m, m, orientation="left"), BadArgument, "orientation must be one of"),
        (lambda m: gmds.functional_map(m, m, count=1000), BadArgument, "count must be from 1 to"),
        (lambda m: gmds.functional_map(m, m, ([1.0], [1.0]), points=[0]), BadArgument, "not both"),
        (lambda m: gmds.functional_map(m, m, points=[0]), BadShape, "one for each source vertex"),
        (lambda m: gmds.functional_map(m, m, ([1.0], [1.0])), BadShape, "descriptors of the source"),
        (lambda m: gmds.functional_map(m, m, 2 * (np.full(m.n_vertices, np.nan),)), BadArgument, "must be finite"),
        (lambda m: gmds.functional_map(m, m, count=8).zoomed_out(1000), BadArgument, "count must be from 1"),
        (lambda m: gmds.functional_map(m, m, count=8).pull_back([1.0]), BadShape, "one for each target vertex"),
        (lambda m: twice(m, 4), BadArgument, "several"),
        (lambda m: gmds.self_functional_map(m, 1000), BadArgument, "fewer than 1000"),
    ],
)
def test_what_cannot_be_is_refused(call: Any, error: type, says: str) -> None:
    with pytest.raises(error, match=says):
        call(bumpy_sphere(1))
