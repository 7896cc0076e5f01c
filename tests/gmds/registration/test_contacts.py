"""What a map has put on a sheet that the surface only touches is taken back to its own."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from geodesics import Mesh, SurfacePoints
from geodesics.topology.edges import edges
from gmds.registration import contacts
from gmds.registration.contacts import JUMP, MOST, RINGS, islands, jumps, on_the_sheets_of, taken_back, within_rings
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import Registered, assessed
from gmds.registration.settings import FULL

GAP = 0.02  # between the sheets
LONG, WIDE = 61, 21


def folded() -> DeformableMesh:
    """A strip bent back over itself, so that both halves nearly touch, of unit area."""
    u, v = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 2, LONG), np.linspace(0, 0.5, WIDE), indexing="ij"))
    out = u <= 1
    places = np.stack([np.where(out, u, 2 - u), v, np.where(out, 0.0, GAP)], axis=1)
    corner = (np.arange(LONG - 1)[:, None] * WIDE + np.arange(WIDE - 1)).ravel()
    faces = np.stack([corner, corner + WIDE, corner + WIDE + 1, corner, corner + WIDE + 1, corner + 1], axis=1)
    mesh = Mesh(places, faces.reshape(-1, 3))
    return DeformableMesh(mesh, np.arange(mesh.n_vertices), np.zeros(mesh.n_vertices))


def sent_over(surface: DeformableMesh, patch: np.ndarray) -> Registered:
    """The surface on itself, as it is, but for the vertices of a patch, which lie on the other sheet."""
    places = surface.mesh.vertices
    images = np.arange(len(places))
    images[patch] = (LONG - 1 - patch // WIDE) * WIDE + patch % WIDE
    one = assessed(surface, surface, places, FULL)
    return replace(one, points=SurfacePoints.at_vertices(surface.mesh, images))


@pytest.fixture(scope="module")
def surface() -> DeformableMesh:
    return folded()


def test_a_patch_on_the_other_sheet_is_taken_back(surface: DeformableMesh) -> None:
    places = surface.mesh.vertices
    patch = np.flatnonzero((np.abs(places[:, 0] - 0.3) < 0.1) & (places[:, 1] < 0.2) & (places[:, 2] == 0))
    one = sent_over(surface, patch)
    assert (np.abs(one.points.positions - places)[patch, 2] == GAP).all()
    back = taken_back(surface, surface, one.y, one.points)
    np.testing.assert_allclose(back.positions, places, atol=1e-12)


def test_an_island_is_taken_back_alike_in_pieces(surface: DeformableMesh, monkeypatch: pytest.MonkeyPatch) -> None:
    """Islands of many vertices, near many of the target, are gone through a few at a time."""
    places = surface.mesh.vertices
    patch = np.flatnonzero((np.abs(places[:, 0] - 0.3) < 0.1) & (places[:, 1] < 0.2) & (places[:, 2] == 0))
    one = sent_over(surface, patch)
    whole = taken_back(surface, surface, one.y, one.points)
    monkeypatch.setattr("gmds.registration.contacts.PAIRS", 1)
    pieces = taken_back(surface, surface, one.y, one.points)
    np.testing.assert_array_equal(pieces.face, whole.face)
    np.testing.assert_array_equal(pieces.barycentric, whole.barycentric)


def test_what_does_not_jump_stays_as_it_is(surface: DeformableMesh) -> None:
    one = sent_over(surface, np.empty(0, dtype=np.int64))
    assert taken_back(surface, surface, one.y, one.points) is one.points


def test_half_of_a_surface_is_no_island(surface: DeformableMesh) -> None:
    """Where as much is on one sheet as on the other nobody knows which is right: nothing is moved."""
    places = surface.mesh.vertices
    half = np.flatnonzero((places[:, 1] < 0.24) & (places[:, 2] == 0) & (places[:, 0] < 0.9))
    assert surface.areas[half].sum() > MOST
    one = sent_over(surface, half)
    assert taken_back(surface, surface, one.y, one.points) is one.points


def test_pairs_jump_where_they_are_far_along_the_surface(surface: DeformableMesh) -> None:
    x, z = surface.mesh.vertices[:, 0], surface.mesh.vertices[:, 2]
    row = np.flatnonzero((z == 0) & (surface.mesh.vertices[:, 1] == 0))
    above = np.flatnonzero((z == GAP) & (surface.mesh.vertices[:, 1] == 0))
    above = above[[int(np.abs(x[above] - x[i]).argmin()) for i in row]]
    far = 2 * (1 - x[row])
    told = jumps(surface, np.stack([row, above], axis=1))
    assert not told[far < 0.8 * JUMP].any()
    assert told[far > 1.5 * JUMP].all()


def spindle(count: int) -> DeformableMesh:
    """Two vertices, and a ring of so many others that are all neighbours of both."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    places = np.vstack([np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), [[0, 0, 0.1], [0, 0, -0.1]]])
    one = np.arange(count)
    other, top = np.roll(one, -1), np.full(count, count)
    faces = np.vstack([np.stack([one, other, top], axis=1), np.stack([other, one, top + 1], axis=1)])
    return DeformableMesh(Mesh(places, faces), np.arange(len(places)), np.zeros(len(places)))


@pytest.mark.parametrize("walks", [contacts.WALKS, 1])
def test_rings_are_those_of_the_power_of_the_matrix(
    surface: DeformableMesh, walks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(contacts, "WALKS", walks)
    n = surface.mesh.n_vertices
    steps = np.eye(n)
    steps[tuple(edges(surface.mesh).ends.T)] = 1
    near = np.linalg.matrix_power(np.maximum(steps, steps.T), RINGS) > 0
    here = np.random.default_rng(0).integers(0, n, 2000)
    pairs = np.stack([here, (here + np.random.default_rng(1).integers(-90, 90, 2000)) % n], axis=1)
    told = within_rings(surface, pairs)
    np.testing.assert_array_equal(told, near[tuple(pairs.T)])
    assert told.any() and not told.all()


def test_rings_around_a_vertex_of_thousands_of_neighbours_take_little_memory() -> None:
    """The table of all of them, 3,000 x 3,000, takes 140 MB."""
    hub = spindle(3000)
    pairs = np.random.default_rng(0).integers(0, 3000, (6000, 2))
    edges(hub.mesh)
    tracemalloc.start()
    try:
        told = within_rings(hub, pairs)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert told.all()
    assert peak < 20e6


def test_islands_are_small_beside_one_that_is_most_of_the_surface(surface: DeformableMesh) -> None:
    ends = edges(surface.mesh).ends
    corner = surface.mesh.vertices[:, 0] + surface.mesh.vertices[:, 1] + 100 * surface.mesh.vertices[:, 2] < 0.2
    kept = ends[corner[ends[:, 0]] == corner[ends[:, 1]]]
    np.testing.assert_array_equal(islands(surface, kept), corner)
    assert not islands(surface, ends).any()


def test_a_fine_copy_is_sent_to_the_sheets_of_the_coarse_one(surface: DeformableMesh) -> None:
    """Vertices found on the other sheet go to what lies where the image of the coarse copy does."""
    every = np.arange(surface.mesh.n_vertices)
    places = surface.mesh.vertices
    patch = np.flatnonzero((np.abs(places[:, 0] - 0.3) < 0.1) & (places[:, 2] == 0))
    found = every.copy()
    found[patch] = (LONG - 1 - patch // WIDE) * WIDE + patch % WIDE
    fine = replace(surface)
    np.testing.assert_array_equal(on_the_sheets_of(every, surface, found, fine), every)
    assert on_the_sheets_of(every, surface, every, fine) is every
