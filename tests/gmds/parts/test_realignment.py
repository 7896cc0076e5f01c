"""Regions laid anew: a head that was turned round lies right again, and what is right stays where it is."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gmds
from geodesics import Mesh
from geodesics.arrays import Bools, Floats
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.matching.recombination import recombined
from gmds.parts.realignment import SIZES, laid_anew, realigned
from gmds.registration.deformable import DeformableMesh
from gmds.shapes import quadruped, truth
from gmds.surface.measured import measure


@pytest.fixture(scope="module")
def pair() -> SurfacePair:
    source = measure(quadruped(n_vertices=800))
    return SurfacePair(source, measure(quadruped("walk", n_vertices=800, ear_scale=0.7, seed=1)))


@pytest.fixture(scope="module")
def right(pair: SurfacePair) -> Floats:
    """Where the vertices of the simplified source belong (n, 3)."""
    target = pair.target.original
    there = truth(pair.source.original, target).positions[pair.simplified[0].origin]
    return np.asarray((there - target.vertices.mean(axis=0)) / np.sqrt(target.area))


@pytest.fixture(scope="module")
def head(pair: SurfacePair) -> Bools:
    """The head of the simplified source (n,), which looks along x."""
    at = pair.source.original.vertices[pair.simplified[0].origin]
    return np.asarray((at[:, 0] > 0.8) & (at[:, 2] > 1.4))


@pytest.fixture(scope="module")
def wrong(pair: SurfacePair, right: Floats, head: Bools) -> Floats:
    """The same with the nose where an ear is, that ear where the other is, and so on: on the target, all of it."""
    target = pair.simplified[1]
    middle = right[head].mean(axis=0)
    axis = right[head & (right[:, 2] > np.quantile(right[head, 2], 0.8))].mean(axis=0) - middle
    forward = right[head][right[head, 0].argmax()] - middle
    about = axis / np.linalg.norm(axis) + forward / np.linalg.norm(forward)
    turn = Rotation.from_rotvec(2 * np.pi / 3 * about / np.linalg.norm(about))
    y = right.copy()
    y[head] = target.mesh.vertices[target.places.query(turn.apply(right[head] - middle) + middle)[1]]
    return y


def test_a_head_that_is_turned_round_is_laid_right(
    pair: SurfacePair, right: Floats, wrong: Floats, head: Bools
) -> None:
    registered = Proposal.of(pair, wrong).registered.y
    before = np.linalg.norm(registered - right, axis=1)
    assert before[head].mean() > 0.1  # registration alone does not mend it
    after = [np.linalg.norm(y - right, axis=1)[head].mean() for y in realigned(*pair.simplified, registered)]
    assert min(after) < 0.5 * before[head].mean()


def test_registered_from_there_the_map_is_likelier_and_right(pair: SurfacePair, right: Floats, wrong: Floats) -> None:
    start = Proposal.of(pair, wrong)
    found = recombined(pair, [start])
    assert found[-1].neg_log_likelihood < start.neg_log_likelihood - 0.1
    assert np.linalg.norm(found[-1].registered.y - right, axis=1).mean() < 0.02


def test_places_are_similarities_of_regions_that_cost_less_than_the_map(pair: SurfacePair, wrong: Floats) -> None:
    source, target = pair.simplified
    found = laid_anew(source, target, wrong)
    assert found == sorted(found, key=lambda laid: laid.cost)
    for laid in found:
        assert laid.cost < 1
        x, y = (rows - rows.mean(axis=0) for rows in (source.mesh.vertices[laid.vertices], laid.y))
        turn, _ = Rotation.align_vectors(y, x)
        size = np.linalg.norm(y) / np.linalg.norm(x)
        np.testing.assert_allclose(size * turn.apply(x), y, atol=1e-9)
        assert SIZES[0] <= size * (1 + 1e-12) and size <= SIZES[1] * (1 + 1e-12)


def test_what_is_right_stays(pair: SurfacePair, right: Floats) -> None:
    assert recombined(pair, [Proposal.of(pair, right)]) == []


def test_an_animal_with_small_ears_keeps_its_nose() -> None:
    """Of 1,500 vertices; without regions laid anew the nose was an ear, and the map GOOD, in four of nine pairs."""
    source, target = quadruped(n_vertices=1500, seed=11), quadruped("turn", ear_scale=0.6, n_vertices=1500, seed=14)
    answer = gmds.match(source, target)
    errors = np.linalg.norm(answer.points.positions - truth(source, target).positions, axis=1) / np.sqrt(target.area)
    assert (errors > 0.1).mean() < 0.01


def test_a_loose_triangle_that_comes_first_does_no_harm(pair: SurfacePair, right: Floats) -> None:
    """A mesh that was cut apart where it was no manifold may begin with one."""
    whole, target = pair.simplified
    loose = whole.mesh.vertices[whole.mesh.faces[0]] * 1.01
    faces = np.vstack([[[0, 1, 2]], whole.mesh.faces + 3])
    mesh = Mesh(np.vstack([loose, whole.mesh.vertices]), faces)
    source = DeformableMesh(mesh, np.arange(mesh.n_vertices), np.zeros(mesh.n_vertices))
    y = np.vstack([right[whole.mesh.faces[0]], right])
    assert len(realigned(source, target, y)) == len(realigned(whole, target, right))
