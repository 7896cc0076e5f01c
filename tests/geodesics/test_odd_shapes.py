"""Odd but legal surfaces (rows G01-G26 of the reliability table): every operation answers, and rightly."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from odd_shapes import ODD, Odd

import geodesics
from geodesics import GeodesicDistance, Mesh, SurfacePoints, read_mesh, write_mesh
from geodesics.check import check
from geodesics.repair.repairing import repair

NAMES = [f"{row} {name}" for row, name, _ in ODD]


@functools.cache
def odd(index: int) -> tuple[Odd, Mesh]:
    found = ODD[index][2]()
    return found, Mesh(found.vertices, found.faces)


@pytest.fixture(params=range(len(ODD)), ids=NAMES)
def case(request: pytest.FixtureRequest) -> tuple[Odd, Mesh]:
    return odd(request.param)


def test_distances_are_those_of_a_graph_that_minds_nothing(case: tuple[Odd, Mesh]) -> None:
    shape, mesh = case
    source = SurfacePoints.at_vertices(mesh, [shape.source])
    found = GeodesicDistance(geodesics.embedded(mesh)).field(source)[0]
    reached = np.isfinite(shape.distances)
    assert np.array_equal(np.isfinite(found), reached) and not np.isnan(found).any()
    assert found[shape.source] == 0
    error = np.abs(found[reached] - shape.distances[reached]) / shape.distances[reached].max()
    assert error.mean() < 0.015 and error.max() < 0.06


def test_the_laplacian_is_one(case: tuple[Odd, Mesh]) -> None:
    """Symmetric, constants in its kernel, no negative energy, and coordinates have at most the area as energy."""
    shape, mesh = case
    metric = geodesics.embedded(mesh)
    matrix = geodesics.stiffness(metric)
    centred = mesh.vertices - mesh.vertices[mesh.faces[0, 0]]
    size = np.abs(matrix).max()
    assert np.isfinite(matrix.data).all() and abs(matrix - matrix.T).max() <= 1e-12 * size
    assert np.abs(matrix @ np.ones(mesh.n_vertices)).max() <= 1e-9 * size
    energy = float((centred * (matrix @ centred)).sum())
    assert 0.25 * 2 * shape.area < energy < 1.0001 * 2 * shape.area
    assert metric.mass.sum() == pytest.approx(shape.area, rel=1e-4)


@pytest.mark.parametrize("metric", geodesics.metrics.ALL, ids=lambda metric: metric.__name__)
def test_every_metric_and_its_spectrum_are_finite(
    case: tuple[Odd, Mesh], metric: Callable[[Mesh], geodesics.Metric]
) -> None:
    _, mesh = case
    measured = metric(mesh)
    assert np.isfinite(measured.l_sq).all() and np.isfinite(measured.mass).all() and (measured.mass >= 0).all()
    found = geodesics.eigenpairs(measured, min(5, mesh.n_vertices))
    assert np.isfinite(found.eigenvalues).all() and np.isfinite(found.eigenfunctions).all()
    assert (np.diff(found.eigenvalues) >= -1e-6 * found.eigenvalues.max()).all()


def test_check_and_repair_answer(case: tuple[Odd, Mesh]) -> None:
    _, mesh = case
    assert check(mesh)
    better, vertex, face, *_ = repair(mesh)
    assert np.array_equal(better.vertices, mesh.vertices[vertex])
    corners = np.sort(vertex[better.faces], axis=1)
    assert np.array_equal(corners, np.sort(mesh.faces[face], axis=1))


def test_files_keep_them(case: tuple[Odd, Mesh], tmp_path: Path) -> None:
    _, mesh = case
    for ending in ("off", "obj", "ply", "tri"):
        write_mesh(mesh, tmp_path / f"a.{ending}")
        again = read_mesh(tmp_path / f"a.{ending}")
        assert again.vertices.tobytes() == mesh.vertices.tobytes() and again.faces.tobytes() == mesh.faces.tobytes()
