"""What the paper claims of the whole distance layer: invariance, on generated surfaces and on real ones."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest
import scipy.optimize
from generated_shapes import bumpy_sphere, dumbbell, icosphere, joined, moved, rectangle

from geodesics import (
    BiharmonicDistance,
    CommuteTimeDistance,
    DiffusionDistance,
    GeodesicDistance,
    SurfacePoints,
    angle_defect,
    eigenpairs,
    embedded,
    farthest_point_sampling,
    gaussian_curvature,
    read_mesh,
    scale_invariant,
    voronoi_cells,
)
from geodesics.metrics import ALL

DATA = Path(os.environ.get("GMDS_DATA", "missing"))
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="GMDS_DATA is not set")
DISTANCES = {
    "geodesic": lambda metric: GeodesicDistance(metric),
    "diffusion": lambda metric: DiffusionDistance(eigenpairs(metric, 40), 0.01),
    "commute": lambda metric: CommuteTimeDistance(eigenpairs(metric, 40)),
    "biharmonic": lambda metric: BiharmonicDistance(eigenpairs(metric, 40)),
}
each_distance = pytest.mark.parametrize("distance", DISTANCES.values(), ids=DISTANCES.keys())


@each_distance
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_distances_in_the_scale_invariant_metric_forget_scale_and_motion(distance, scale):
    """Theorem 2.1, for every distance."""
    mesh = bumpy_sphere(3)
    other = moved(mesh, scale)
    here = distance(scale_invariant(mesh)).field(SurfacePoints.at_vertices(mesh, [0, 100]))
    there = distance(scale_invariant(other)).field(SurfacePoints.at_vertices(other, [0, 100]))
    # fast marching takes ties in another order when the surface is turned
    np.testing.assert_allclose(there, here, rtol=3e-3, atol=1e-7 * here.max())


@pytest.mark.parametrize("metric", ALL, ids=lambda f: f.__name__)
@each_distance
def test_every_distance_in_every_metric(metric, distance):
    """Zero at the source and nowhere else, finite on one component, the same both ways."""
    mesh = bumpy_sphere(3)
    d = distance(metric(mesh)).field(SurfacePoints.at_vertices(mesh, [0, 7, 99]))
    assert np.all(np.isfinite(d)) and np.all(d >= 0)
    assert np.all(d[[0, 1, 2], [0, 7, 99]] <= 1e-9 * d.max())
    assert np.count_nonzero(d <= 1e-9 * d.max()) == 3
    np.testing.assert_allclose(d[0, 99], d[2, 0], rtol=0.02)


@each_distance
def test_other_component_is_not_near(distance):
    mesh = joined(bumpy_sphere(2), icosphere(2))
    half = mesh.n_vertices // 2
    d = distance(embedded(mesh)).field(SurfacePoints.at_vertices(mesh, [0]))[0]
    assert d[half:].min() > 0.5 * d[:half].max()


def eigenvalues_apart(metric, a, b):
    one, two = (eigenpairs(metric(m), 16).eigenvalues[1:] * metric(m).mass.sum() for m in (a, b))
    return np.mean(abs(two / one - 1))


@pytest.mark.parametrize("scale", [2.0, 3.0])
def test_local_scale_moves_the_regular_spectrum_and_hardly_the_invariant_one(scale):
    """Figs. 2-3, in one number: one ball of the dumbbell larger, eigenvalues times area."""
    a, b = dumbbell(), dumbbell(scale)
    assert eigenvalues_apart(embedded, a, b) > 0.25
    assert eigenvalues_apart(scale_invariant, a, b) < 0.1


def test_local_scale_keeps_voronoi_cells():
    """Fig. 6: farthest points and their cells by diffusion distance, on both; the share of vertices that agree."""
    agree, above = {}, {}
    for metric in (embedded, scale_invariant):
        overlap, labels = np.zeros((20, 20)), []
        for mesh in (dumbbell(), dumbbell(2.0)):
            distance = DiffusionDistance(eigenpairs(metric(mesh), 60), 0.003)
            samples = farthest_point_sampling(distance, 20, first=0)
            labels.append(voronoi_cells(distance, samples))
            above[metric] = np.count_nonzero(mesh.vertices[samples, 2] > 0)
        np.add.at(overlap, tuple(labels), 1)
        agree[metric] = overlap[scipy.optimize.linear_sum_assignment(-overlap)].sum() / overlap.sum()
    assert agree[scale_invariant] > 0.8 > 0.7 > agree[embedded]
    assert 8 <= above[scale_invariant] <= 12 and above[embedded] > 13  # samples crowd where the surface is larger


def test_flat_surface_is_measured_as_it_is():
    """K = 0 everywhere: the relative eps leaves the embedded metric times a constant, of any size."""
    for scale in (1e-6, 1.0, 1e6):
        g = scale_invariant(moved(rectangle(8, 8), scale))
        assert g.mass.sum() == pytest.approx(4 * np.pi)
        assert g.conformal_factor is not None
        np.testing.assert_allclose(g.conformal_factor, g.conformal_factor.mean(), rtol=1e-6)


@needs_data
@pytest.mark.parametrize("name", ["tosca_5k/cat0", "faust_5k/tr_reg_000"])
def test_real_surfaces(name):
    """Gauss-Bonnet, scale, and eigenpairs on meshes with slivers."""
    mesh = read_mesh(DATA / f"{name}.off")
    assert angle_defect(mesh).sum() == pytest.approx(4 * np.pi, abs=1e-8)
    assert gaussian_curvature(mesh) @ embedded(mesh).mass == pytest.approx(4 * np.pi, abs=1e-6)
    here, there = (eigenpairs(scale_invariant(m), 20).eigenvalues for m in (mesh, moved(mesh, 1e-5)))
    np.testing.assert_allclose(there, here, rtol=1e-5, atol=1e-7)


@needs_data
def test_remeshed_and_scaled_parts_of_a_real_surface():
    """Diffusion distances between known pairs of points of a horse and its remeshed copy with parts scaled."""
    pair = next(p for p in json.loads((DATA / "scaled" / "pairs.json").read_text()) if p["name"] == "b06_horse_multi")
    source, target = read_mesh(DATA / pair["source"]), read_mesh(DATA / pair["target"])
    truth = np.load(DATA / pair["truth"])
    apart = {}
    for metric in (embedded, scale_invariant):
        first, second = (DiffusionDistance(eigenpairs(metric(m), 60), 0.003) for m in (source, target))
        a = first.field(SurfacePoints.at_vertices(source, truth["src"][::10]))[:, truth["src"][::10]]
        b = second.field(SurfacePoints.at_vertices(target, truth["gt"][::10]))[:, truth["gt"][::10]]
        a, b = a / np.sqrt(np.mean(a**2)), b / np.sqrt(np.mean(b**2))
        apart[metric] = np.sqrt(np.mean((a - b) ** 2))
    assert apart[scale_invariant] < 0.6 * apart[embedded]
