"""Farthest points and their cells, in any distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, joined, moved, rectangle, torus, with_isolated
from numpy.typing import NDArray

from geodesics import (
    CommuteTimeDistance,
    GeodesicDistance,
    Mesh,
    SurfacePoints,
    eigenpairs,
    embedded,
    farthest_point_sampling,
    scale_invariant,
    voronoi_cells,
)
from geodesics.sampling import farthest_point_cells

SQUEEZED = Mesh(bumpy_sphere(3).vertices * [0.3, 1, 1], bumpy_sphere(3).faces)


@dataclass(frozen=True)
class WholeFields:
    """The same distance without its own way to find closer vertices: the naive twin."""

    distance: GeodesicDistance

    @property
    def mesh(self) -> Mesh:
        return self.distance.mesh

    def field(self, points: SurfacePoints) -> NDArray[np.float64]:
        return self.distance.field(points)


DISTANCES = {
    "geodesic": lambda mesh: GeodesicDistance(embedded(mesh)),
    "whole fields": lambda mesh: WholeFields(GeodesicDistance(embedded(mesh))),
    "scale invariant": lambda mesh: GeodesicDistance(scale_invariant(mesh, exponent=0.5)),
    "commute time": lambda mesh: CommuteTimeDistance(eigenpairs(embedded(mesh), 20)),
}


@pytest.mark.parametrize("make", DISTANCES.values(), ids=DISTANCES)
def test_each_sample_is_the_farthest_from_those_before(make) -> None:
    distance = make(bumpy_sphere(2))
    samples = farthest_point_sampling(distance, 15, first=7)
    assert samples[0] == 7 and len(set(samples)) == 15
    fields = distance.field(SurfacePoints.at_vertices(distance.mesh, samples))
    for i in range(1, 15):
        nearest = fields[:i].min(axis=0)
        assert nearest[samples[i]] >= nearest.max() * (1 - 1e-2)
    cells = voronoi_cells(distance, samples)
    assert (cells[samples] == np.arange(15)).all()
    chosen = fields[cells, np.arange(distance.mesh.n_vertices)]
    np.testing.assert_allclose(chosen, fields.min(axis=0), atol=1e-2 * fields.max())


@pytest.mark.parametrize("mesh", [SQUEEZED, torus(40, 20), rectangle(20, 20)], ids=["squeezed", "torus", "border"])
@pytest.mark.parametrize(
    "metric", [embedded, lambda mesh: scale_invariant(mesh, exponent=0.5)], ids=["plain", "scaled"]
)
def test_fronts_that_stop_early_equal_whole_fields(mesh: Mesh, metric) -> None:
    """The same samples to start with, then the same cells and distances up to the errors of both."""
    distance = GeodesicDistance(metric(mesh))
    ours, naive = (farthest_point_cells(d, 40, first=0) for d in (distance, WholeFields(distance)))
    assert abs(ours.distance.max() / naive.distance.max() - 1) < 0.02
    samples = naive.samples
    fields = distance.field(SurfacePoints.at_vertices(mesh, samples))
    closer, nearest, cells = distance.spreader(), np.full(mesh.n_vertices, np.inf), np.full(mesh.n_vertices, -1)
    for i, vertex in enumerate(samples):
        where, values = closer(int(vertex), nearest)
        assert (values < nearest[where]).all()
        nearest[where], cells[where] = values, i
    assert np.abs(nearest / np.where(fields.min(axis=0) > 0, fields.min(axis=0), np.inf) - (nearest > 0)).mean() < 1e-3
    assert (cells == fields.argmin(axis=0)).mean() > 0.99
    np.testing.assert_array_equal(voronoi_cells(distance, samples), cells)


def test_cells_are_the_labels_of_the_distances() -> None:
    distance = GeodesicDistance(embedded(SQUEEZED))
    cells = farthest_point_cells(distance, 25)
    fields = distance.field(SurfacePoints.at_vertices(SQUEEZED, cells.samples))
    chosen = fields[cells.nearest, np.arange(SQUEEZED.n_vertices)]
    assert np.abs(cells.distance - chosen).max() < 0.02 * chosen.max()
    np.testing.assert_array_equal(cells.samples, farthest_point_sampling(distance, 25))


@pytest.mark.parametrize("make", [CommuteTimeDistance, WholeFields], ids=["spectral", "fields"])
def test_cells_that_were_begun_are_gone_on_from(make) -> None:  # type: ignore[no-untyped-def]
    mesh = SQUEEZED
    distance = make(eigenpairs(embedded(mesh), 20)) if make is CommuteTimeDistance else make(GeodesicDistance(mesh))
    begun = farthest_point_cells(distance, 12, first=5)
    kept = [array.copy() for array in begun]
    ours, alone = farthest_point_cells(distance, 30, begun=begun), farthest_point_cells(distance, 30, first=5)
    for one, other in zip(ours, alone, strict=True):
        np.testing.assert_array_equal(one, other)
    for one, other in zip(begun, kept, strict=True):
        np.testing.assert_array_equal(one, other)


def test_samples_cover_a_square_evenly() -> None:
    """Five samples from a corner: the other corners, then the middle."""
    mesh = rectangle(20, 20)
    samples = farthest_point_sampling(GeodesicDistance(embedded(mesh)), 5, first=0)
    corners = {tuple(p) for p in mesh.vertices[samples[:4], :2]}
    assert corners == {(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)}
    np.testing.assert_allclose(mesh.vertices[samples[4]], [0.5, 0.5, 0])


def test_components_are_covered_and_isolated_vertices_never_chosen() -> None:
    small = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    mesh = with_isolated(joined(icosphere(2), icosphere(1), small))
    distance = GeodesicDistance(embedded(mesh))
    samples = farthest_point_sampling(distance, 10)
    x = mesh.vertices[samples, 0]
    assert (x < 2).any() and ((x > 3) & (x < 7)).any() and not (x > 8.5).any()
    assert np.isin(samples, mesh.faces).all()
    cells = voronoi_cells(distance, samples)
    unreached = ~np.isin(np.arange(mesh.n_vertices), mesh.faces) | (mesh.vertices[:, 0] > 8.5)
    assert (cells[unreached] == -1).all() and (cells[~unreached] >= 0).all()


def test_a_mesh_of_small_components_is_sampled_all_the_same() -> None:
    small = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    samples = farthest_point_sampling(GeodesicDistance(embedded(joined(small, small, small))), 3)
    assert set(samples // 3) == {0, 1, 2}


def test_all_vertices_can_be_chosen_and_no_more() -> None:
    mesh = with_isolated(icosphere(0))
    distance = GeodesicDistance(embedded(mesh))
    assert sorted(farthest_point_sampling(distance, 12)) == sorted(np.unique(mesh.faces))
    for count in (0, -1, 13):
        with pytest.raises(ValueError, match="count must be 1 to 12"):
            farthest_point_sampling(distance, count)
    for first in (0, 99, -1):
        with pytest.raises(ValueError, match="first must be a vertex on the surface"):
            farthest_point_sampling(distance, 3, first=first)


def test_first_sample_does_not_depend_on_numbering_or_motion() -> None:
    mesh = bumpy_sphere(2)
    order = np.random.default_rng(0).permutation(mesh.n_vertices)
    shuffled = Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])
    first = farthest_point_sampling(GeodesicDistance(embedded(mesh)), 1)[0]
    assert order[farthest_point_sampling(GeodesicDistance(embedded(shuffled)), 1)[0]] == first
    assert farthest_point_sampling(GeodesicDistance(embedded(moved(mesh, 1e-3))), 1)[0] == first
