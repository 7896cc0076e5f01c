"""A source deformed until it lies on a target."""

from __future__ import annotations

import functools
from dataclasses import replace

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, surface
from numpy.typing import NDArray
from scipy.stats import pearsonr

import gmds
from geodesics import Mesh
from geodesics.closest import closest_on_triangles
from gmds.deformations import bending, local_scaling
from gmds.registration.deformable import DeformableMesh
from gmds.registration.energies import ALL, AsRigidAsPossible, AsSimilarAsPossible, EnergyKind, NearlyAffine
from gmds.registration.register import correlation, register
from gmds.registration.residuals import LEAST, Residuals
from gmds.registration.settings import FINE, RegistrationSettings, Stage
from gmds.surface.measured import measure

Array = NDArray[np.float64]
Pair = tuple[DeformableMesh, DeformableMesh, Array]
RIGID, SIMILAR = RegistrationSettings(energy=AsRigidAsPossible), RegistrationSettings(energy=AsSimilarAsPossible)
FAIR = Residuals(energy=0.3, misfit=0.01, misfit_back=0.02, curvature=0.8, curvature_back=0.7)


@functools.cache
def posed() -> Pair:
    """The animal standing and walking, each triangulated on its own, and where its vertices belong."""
    source, target = animal(), animal("walk", 1)
    place, truth = surface(target).mesh.vertices, gmds.shapes.truth(source, target)
    corners = place[target.faces[truth.face]]
    return (
        DeformableMesh.of(surface(source)),
        DeformableMesh.of(surface(target)),
        (truth.barycentric[:, :, None] * corners).sum(1),
    )


@functools.cache
def deformed(name: str) -> Pair:
    """A surface and a deformed copy, vertex by vertex."""
    whole = shapes.bumpy_sphere(3)
    z = whole.vertices[:, 2]
    source, target = {
        "turned": lambda: (whole, shapes.moved(whole, 3.0)),
        "turned animal": lambda: (animal(), shapes.moved(animal(), 0.1)),
        "bent": lambda: (animal(), bending(animal(), 60.0)[0]),
        "grown": lambda: (whole, local_scaling(whole, np.log(2.0) / (1 + np.exp(-3 * (z - np.median(z)))))[0]),
    }[name]()
    deformable = DeformableMesh.of(measure(target))
    return DeformableMesh.of(measure(source)), deformable, deformable.mesh.vertices


def cut(deformable: DeformableMesh, axis: int, sign: int) -> tuple[DeformableMesh, NDArray[np.bool_]]:
    """Half of a surface, the boundary rough, and which vertices are on it."""
    z = sign * deformable.mesh.vertices[:, axis]
    kept = z < np.median(z)
    used, faces = np.unique(deformable.mesh.faces[kept[deformable.mesh.faces].all(axis=1)], return_inverse=True)
    half = Mesh(deformable.mesh.vertices[used], faces.reshape(-1, 3))
    return DeformableMesh(half, used, deformable.curvature[used]), kept


def noisy(truth: Array, amount: float) -> Array:
    return truth + amount * np.random.default_rng(0).standard_normal(truth.shape)


def off(places: Array, truth: Array) -> float:
    """Mean distance, in root areas."""
    return float(np.linalg.norm(places - truth, axis=1).mean())


@pytest.mark.parametrize("energy", ALL, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize(("amount", "share"), [(0.03, 0.35), (0.1, 0.15)])
def test_a_noisy_map_to_another_pose_gets_close_to_the_truth(amount: float, share: float, energy: EnergyKind) -> None:
    source, target, truth = posed()
    start = noisy(truth, amount)
    found = register(source, target, start, RegistrationSettings(energy=energy))
    assert off(found.points.positions, truth) < share * off(start, truth)
    assert off(found.points.positions, truth) < 0.02  # an edge is 0.04
    assert found.residuals.misfit < 0.006 and found.residuals.misfit_back < 0.02
    assert found.residuals.curvature > 0.85 and found.residuals.curvature_back > 0.8


@pytest.mark.parametrize("energy", ALL, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize(("name", "least"), [("turned", 1e-3), ("turned animal", 6e-3), ("bent", 8e-3)])
def test_a_copy_that_was_turned_or_bent_is_found_vertex_by_vertex(name: str, least: float, energy: EnergyKind) -> None:
    source, target, truth = deformed(name)
    found = register(source, target, noisy(truth, 0.05), RegistrationSettings(energy=energy))
    assert off(found.points.positions, truth) < least
    assert found.residuals.energy < (0.3 if energy is NearlyAffine else 0.1)  # against which bending costs as well
    assert found.residuals.misfit < 4e-3


@pytest.mark.parametrize("amount", [0.03, 0.08])
def test_where_a_part_grew_it_pays_to_let_it(amount: float) -> None:
    source, target, truth = deformed("grown")
    plain, grown = (register(source, target, noisy(truth, amount), settings) for settings in (RIGID, SIMILAR))
    assert off(grown.points.positions, truth) < 2e-3
    assert off(grown.points.positions, truth) < 0.1 * off(plain.points.positions, truth)
    assert grown.residuals.energy < 0.1 * plain.residuals.energy


def test_the_mirrored_map_costs_more_than_the_right_one() -> None:
    source, target, _ = posed()
    flipped = gmds.shapes.truth(animal(), animal("walk", 1), mirrored=True)
    corners = target.mesh.vertices[animal("walk", 1).faces[flipped.face]]
    wrong = register(source, target, (flipped.barycentric[:, :, None] * corners).sum(1), SIMILAR)
    right = register(source, target, posed()[2], SIMILAR)
    assert wrong.residuals.energy > 4 * right.residuals.energy
    assert wrong.residuals.neg_log_likelihood > right.residuals.neg_log_likelihood + 1


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_what_the_target_lacks_is_not_squeezed_to_its_boundary(axis: int, sign: int) -> None:
    source, whole, truth = deformed("turned")
    target, kept = cut(whole, axis, sign)
    start = noisy(truth, 0.03)
    plain, partial = (register(source, target, start, replace(RIGID, partial=partial)) for partial in (False, True))
    assert off(partial.y[kept], truth[kept]) < 0.6 * off(plain.y[kept], truth[kept])
    assert off(partial.y[kept], truth[kept]) < 0.02
    lost = ~kept & (np.linalg.norm(truth - target.mesh.vertices[target.places.query(truth)[1]], axis=1) > 0.1)
    gaps = [
        closest_on_triangles(found.y[lost], target.mesh.vertices, target.mesh.faces)[2] for found in (plain, partial)
    ]
    assert gaps[1].mean() > 3 * gaps[0].mean()
    assert partial.residuals.misfit < 0.03 and partial.residuals.misfit_back < 0.01  # of what has a counterpart


def test_points_are_closest_to_where_the_vertices_are() -> None:
    source, target, truth = posed()
    found = register(source, target, truth, SIMILAR)
    gap = np.linalg.norm(found.points.positions - found.y, axis=1)
    least = closest_on_triangles(found.y, target.mesh.vertices, target.mesh.faces)[2]
    assert (gap >= least - 1e-12).all() and (gap - least).mean() < 4e-3  # normals have a say too
    assert found.residuals.misfit == pytest.approx(np.sqrt(source.areas @ gap**2))
    assert (found.strain * source.areas).sum() == pytest.approx(found.residuals.energy)
    assert (found.strain >= 0).all()


def test_a_softer_surface_fits_better() -> None:
    source, target, truth = posed()
    stiff, soft = (
        register(source, target, truth, SIMILAR.with_stages((Stage(s, 6), Stage(s, 6)))) for s in (3e-2, FINE[-1][0])
    )
    assert soft.residuals.misfit < 0.5 * stiff.residuals.misfit
    assert soft.residuals.energy > stiff.residuals.energy


@pytest.mark.parametrize("start", ["one point", "far away"])
def test_a_hopeless_map_is_finite(start: str) -> None:
    source, target = DeformableMesh.of(surface(bumpy())), DeformableMesh.of(measure(shapes.torus(20, 10)))
    images = np.zeros_like(source.mesh.vertices) + (100.0 if start == "far away" else 0.0)
    for partial in (False, True):
        found = register(source, target, images, replace(SIMILAR, partial=partial))
        assert np.isfinite(found.y).all() and np.isfinite(list(vars(found.residuals).values())).all()
        assert np.isfinite(found.residuals.neg_log_likelihood)


@pytest.mark.parametrize(
    ("name", "worse"), [("energy", 0.6), ("misfit_back", 0.05), ("curvature", 0.5), ("curvature_back", 0.2)]
)
def test_every_residual_counts_and_by_its_logarithm(name: str, worse: float) -> None:
    both = replace(FAIR, **{name: worse})
    assert both.neg_log_likelihood > FAIR.neg_log_likelihood
    if name == "misfit_back":
        assert both.neg_log_likelihood - FAIR.neg_log_likelihood == pytest.approx(np.log(0.05 / 0.02))
    if name == "energy":
        assert both.neg_log_likelihood - FAIR.neg_log_likelihood == pytest.approx(0.5 * np.log(2))


def test_the_loss_is_finite_for_perfect_and_for_hopeless_maps() -> None:
    perfect, hopeless = Residuals(0.0, 0.0, 0.0, 1.0, 1.0), Residuals(9.0, 9.0, 9.0, -1.0, -1.0)
    assert perfect.neg_log_likelihood == pytest.approx(4 * np.log(LEAST))
    assert hopeless.neg_log_likelihood == pytest.approx(np.log(3) + np.log(9))  # no worse than no correlation at all


def test_correlation_agrees_with_pearson_and_heeds_weights() -> None:
    rng = np.random.default_rng(0)
    x, y, times = rng.standard_normal(50), rng.standard_normal(50), rng.integers(0, 4, 50)
    assert correlation(x, y, np.ones(50)) == pytest.approx(pearsonr(x, y)[0])
    assert correlation(x, y, 0.1 * times) == pytest.approx(pearsonr(x.repeat(times), y.repeat(times))[0])
    assert correlation(x, 3 * x + 1, np.ones(50)) == pytest.approx(1)
    assert correlation(x, np.ones(50), np.ones(50)) == 0
    assert correlation(np.zeros(50), np.zeros(50), np.ones(50)) == 1
