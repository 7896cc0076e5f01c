"""Edges and components: against what a dictionary counts."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from generated_shapes import bumpy_sphere, icosphere, joined, rectangle

from geodesics import Mesh
from geodesics.topology.components import boundary_vertices, component_areas, largest_component
from geodesics.topology.edges import edge_ends, edge_keys, twice_given


def sides(mesh: Mesh) -> dict[frozenset[int], list[int]]:
    """For each undirected edge the half-edges 3 * face + k, from corner k to corner k + 1, that run along it."""
    found = defaultdict(list)
    for i, face in enumerate(mesh.faces.tolist()):
        for k in range(3):
            found[frozenset((face[k], face[(k + 1) % 3]))].append(3 * i + k)
    return found


def test_keys_do_not_depend_on_direction_and_give_the_ends_back() -> None:
    start, end = np.random.default_rng(0).integers(0, 1000, (2, 500))
    keys = edge_keys(start, end, 1000)
    assert np.array_equal(keys, edge_keys(end, start, 1000))
    assert np.array_equal(edge_ends(keys, 1000), np.sort(np.stack([start, end], axis=1), axis=1))


def test_keys_given_twice_are_the_inner_edges() -> None:
    for mesh in (icosphere(1), rectangle(4, 5), joined(icosphere(1), rectangle(3, 3))):
        first, second = twice_given(edge_keys(mesh.faces, np.roll(mesh.faces, -1, axis=1), mesh.n_vertices).ravel())
        pairs = sorted(zip(first.tolist(), second.tolist(), strict=True))
        assert pairs == sorted(tuple(found) for found in sides(mesh).values() if len(found) == 2)
        rim = {vertex for edge, found in sides(mesh).items() if len(found) == 1 for vertex in edge}
        assert set(np.flatnonzero(boundary_vertices(mesh)).tolist()) == rim


def test_keys_given_once_or_three_times_are_left_out() -> None:
    first, second = twice_given(np.array([7, 3, 7, 3, 7, 1, 2, 2]))
    assert sorted(zip(first.tolist(), second.tolist(), strict=True)) == [(1, 3), (6, 7)]
    assert all(len(index) == 0 for index in twice_given(np.zeros(0, dtype=np.int64)))


def test_the_largest_component_is_that_of_the_largest_area_unless_other_weights_are_given() -> None:
    small = Mesh(0.1 * bumpy_sphere(3).vertices, bumpy_sphere(3).faces)
    mesh = joined(small, icosphere(1))
    first = np.arange(mesh.n_faces) < small.n_faces
    assert np.array_equal(largest_component(mesh), ~first)
    assert np.array_equal(largest_component(mesh, weights=np.ones(mesh.n_faces)), first)
    np.testing.assert_allclose(component_areas(mesh), [small.area, icosphere(1).area])
