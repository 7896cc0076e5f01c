"""Extremities: maxima as a naive twin finds them, in any unit and numbering the same, left alone by a cut elsewhere."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from cut_shapes import cut
from generated_shapes import bumpy_sphere, disc, joined, rectangle, torus, with_isolated
from hypothesis import given
from hypothesis import strategies as st

from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.deformations import scan
from gmds.parts.extremities import (
    APART,
    MOST,
    RINGS,
    all_extremities,
    inner_extremities,
    near_boundary,
    persistent_maxima,
    with_interior,
)
from gmds.shapes import humanoid, quadruped
from gmds.surface.measured import measure

MESHES = {
    "sphere": bumpy_sphere(1),
    "sheet": rectangle(5, 7),
    "torus": torus(8, 5),
    "two": joined(bumpy_sphere(1), rectangle(4, 4)),
    "vertices on no face": with_isolated(bumpy_sphere(1)),
}


def naive_maxima(mesh: Mesh, values: Floats, least: float) -> list[int]:
    """Every vertex, with all that can be reached from it without going lower than a level, level by level."""
    order = np.argsort(-values, kind="stable")
    rank = np.argsort(order)
    neighbours: dict[int, set[int]] = {int(v): set() for v in np.unique(mesh.faces)}
    for a, b, c in mesh.faces.tolist():
        neighbours[a] |= {b, c}
        neighbours[b] |= {a, c}
        neighbours[c] |= {a, b}
    found = []
    for top in order.tolist():
        if top not in neighbours:
            continue
        for level in order[rank[top] :].tolist():  # the first at which something higher can be reached
            seen, todo = {top}, [top]
            while todo:
                new = {v for v in neighbours[todo.pop()] if rank[v] <= rank[level]} - seen
                seen |= new
                todo += new
            if any(rank[v] < rank[top] for v in seen):
                if values[top] - values[level] > least:
                    found.append(top)
                break
        else:
            found.append(top)
    return found


@given(name=st.sampled_from(list(MESHES)), seed=st.integers(0, 2**32 - 1), least=st.sampled_from([0.0, 0.1, 0.3, 2.0]))
def test_maxima_are_those_of_a_naive_search(name: str, seed: int, least: float) -> None:
    mesh = MESHES[name]
    values = np.random.default_rng(seed).uniform(size=mesh.n_vertices)
    if seed % 3 == 0:
        values = values.round(1)  # ties
    assert persistent_maxima(mesh, values, least).tolist() == naive_maxima(mesh, values, least)


def test_a_field_that_only_falls_has_one_maximum_a_component() -> None:
    mesh = MESHES["two"]
    assert len(persistent_maxima(mesh, -np.arange(mesh.n_vertices, dtype=float), 1e9)) == 2


def test_more_persistence_leaves_fewer_and_the_highest_stays() -> None:
    mesh = bumpy_sphere(2)
    values = np.random.default_rng(0).uniform(size=mesh.n_vertices)
    nested = [set(persistent_maxima(mesh, values, least).tolist()) for least in (0.0, 0.2, 0.5, 0.9, 9.0)]
    assert all(small <= large for large, small in itertools.pairwise(nested))
    assert nested[-1] == {int(values.argmax())} and len(nested[0]) > 10


def test_near_a_boundary_is_within_so_many_rings_of_it() -> None:
    mesh = disc(8)
    radius = np.linalg.norm(mesh.vertices, axis=1)
    assert np.array_equal(near_boundary(mesh), radius > 1 - (RINGS + 0.5) / 8)
    assert not near_boundary(bumpy_sphere(1)).any()


@pytest.fixture(scope="module")
def animal() -> Mesh:
    body = quadruped(n_vertices=1200)
    return Mesh(body.vertices, body.faces)


def test_tips_of_an_animal_are_extremities(animal: Mesh) -> None:
    found = inner_extremities(measure(animal))
    at = animal.vertices[found.vertices]
    assert 6 <= len(at) <= MOST
    for i, sign in ((0, 1), (0, -1), (2, 1)):  # the snout, the tail, an ear
        assert (sign * at[:, i]).max() > (sign * animal.vertices[:, i]).max() - 0.15
    assert len({(x > 0, y > 0) for x, y, z in at.tolist() if z < 0.2}) == 4  # a foot in each corner
    between = found.distances[:, found.vertices] + 9 * np.eye(len(at))
    assert between.min() > APART and np.allclose(found.distances[np.arange(len(at)), found.vertices], 0)


@pytest.mark.parametrize("scale", [1e-4, 1e4])
def test_extremities_have_no_unit(animal: Mesh, scale: float) -> None:
    ours, theirs = (inner_extremities(measure(m)) for m in (animal, Mesh(scale * animal.vertices, animal.faces)))
    assert np.array_equal(ours.vertices, theirs.vertices)
    np.testing.assert_allclose(theirs.distances, ours.distances, rtol=1e-6, atol=1e-9)


def test_extremities_do_not_depend_on_numbers(animal: Mesh) -> None:
    rng = np.random.default_rng(0)
    order, faces = rng.permutation(animal.n_vertices), rng.permutation(animal.n_faces)
    other = Mesh(animal.vertices[order], np.argsort(order)[animal.faces[faces]])
    ours, theirs = (inner_extremities(measure(m)).vertices for m in (animal, other))
    assert len(ours) == len(theirs)
    gap = np.linalg.norm(animal.vertices[ours][:, None] - other.vertices[theirs], axis=2)
    assert gap.min(axis=1).max() < 0.1 and gap.min(axis=0).max() < 0.1


@pytest.mark.parametrize("least", [-0.75, -0.1])
def test_a_cut_leaves_extremities_that_are_far_from_it(animal: Mesh, least: float) -> None:
    """Without the tail, then without the hind: what is left has the snout, the ears and the feet, and no others."""
    part, _ = cut(animal, animal.vertices[:, 0] > least)
    whole, found = (inner_extremities(measure(mesh)).vertices for mesh in (animal, part))
    before, after = animal.vertices[whole], part.vertices[found]
    left = before[before[:, 0] > least + 0.1]
    gap = np.linalg.norm(left[:, None] - after, axis=2)
    assert gap.min(axis=1).max() < 0.15
    assert not near_boundary(part)[found].any()


def test_points_inside_are_apart_from_extremities_and_each_other(animal: Mesh) -> None:
    surface = measure(cut(animal, animal.vertices[:, 0] > -0.1)[0])
    tips = inner_extremities(surface)
    for count in (0, 3, 30):
        anchors, ends = with_interior(surface, count)
        assert np.array_equal(anchors.vertices[ends], tips.vertices) and ends.sum() == len(tips.vertices)
        assert len(anchors.vertices) == len(tips.vertices) + count == len(set(anchors.vertices.tolist()))
        assert not near_boundary(surface.mesh)[anchors.vertices].any()
        assert np.allclose(anchors.distances[np.arange(len(ends)), anchors.vertices], 0)
    apart = anchors.distances[:, anchors.vertices].min(axis=0, where=~np.eye(len(ends), dtype=bool), initial=9)
    assert apart.min() > 0.05


def test_hands_and_feet_of_a_scan_are_extremities_although_they_are_at_its_boundary() -> None:
    seen = measure(scan(humanoid(n_vertices=800), (1, 0, 0))[0])
    assert len(inner_extremities(seen).vertices) < 2
    found = all_extremities(seen)
    at = seen.original.vertices[found.vertices]
    body = seen.original.vertices
    for tip in (body[:, 1].argmin(), body[:, 1].argmax(), body[:, 2].argmax()):  # both hands, and the top of the head
        assert np.linalg.norm(at - body[tip], axis=1).min() < 0.1
    assert (at[:, 2] < 0.2).sum() == 2  # feet
    assert len(found.vertices) <= MOST


def test_inner_extremities_are_those_of_all_that_are_not_beside_a_boundary() -> None:
    body = quadruped(n_vertices=800)
    part = measure(cut(body, body.vertices[:, 0] > -0.1)[0])
    inner, everywhere = inner_extremities(part).vertices, all_extremities(part).vertices
    beside = near_boundary(part.mesh)
    assert 1 < len(inner) < len(everywhere)
    assert not beside[inner].any() and beside[everywhere].any()
