"""Maps under consideration: what is done to them, and when."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal

import gmds
from geodesics import BiharmonicDistance, Distance, Mesh, SurfacePoints, eigenpairs, scale_invariant
from geodesics.arrays import Integers
from gmds.landmarks.checking import place_landmarks
from gmds.matching import candidates
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.mds.losses import LeastSquares
from gmds.registration.in_space import HARDLY_BENT
from gmds.registration.register import Registered, assessed
from gmds.registration.settings import FULL
from gmds.surface.measured import measure


def biharmonic(mesh: Mesh) -> Distance:
    return BiharmonicDistance(eigenpairs(scale_invariant(mesh), 40))


@pytest.fixture
def registrations(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Grows whenever a map that was embedded is registered."""
    calls: list[bool] = []
    plain = candidates.register

    def register(*surfaces: Any, **options: Any) -> Registered:
        calls.append(True)
        return plain(*surfaces, **options)

    monkeypatch.setattr(candidates, "register", register)
    return calls


def test_with_a_distance_the_embedding_is_the_answer_as_it_stands(registrations: list[bool]) -> None:
    source, target = animal(n_vertices=300), shapes.moved(animal(n_vertices=300), 0.3)
    answer = gmds.match(source, target, distance=biharmonic, n_samples=30)
    assert not registrations
    assert np.abs(answer.points.positions - target.vertices).max() < 0.05 * np.ptp(target.vertices)


def test_without_one_it_is_registered(registrations: list[bool]) -> None:
    gmds.match(animal(n_vertices=300), animal("walk", 1, 300), n_samples=30)
    assert registrations


@pytest.fixture(scope="module")
def bent_animal() -> SurfacePair:
    """The animal and itself bent, whose vertices correspond, with three landmarks."""
    source = animal(n_vertices=600)
    x, y, z = source.vertices.T
    target = Mesh(np.column_stack([x + 0.2 * np.sin(z), 1.2 * y, z + 0.1 * x**2]), source.faces)
    given = np.arange(0, 600, 200)
    placed = place_landmarks((given, given), source, target)
    return SurfacePair(measure(source), measure(target), placed.constraints)


def test_of_two_registrations_the_cheaper_is_the_map(bent_animal: SurfacePair) -> None:
    right = np.arange(bent_animal.source.mesh.n_vertices)
    wrong = right[::-1]
    lost = candidates.registered(bent_animal, at(bent_animal, wrong))
    found, other = candidates.cheaper(bent_animal, lost, right)
    assert found.residuals.energy < 0.5 * lost.residuals.energy
    assert other is None
    assert np.abs(found.points.positions - bent_animal.target.mesh.vertices).max() < 0.05
    kept, _ = candidates.cheaper(bent_animal, found, wrong)
    assert kept is found


def test_of_two_that_cost_nearly_the_same_both_are_kept(bent_animal: SurfacePair) -> None:
    right = np.arange(bent_animal.source.mesh.n_vertices)
    found, _ = candidates.cheaper(bent_animal, candidates.registered(bent_animal, at(bent_animal, right)), right)
    best, other = candidates.cheaper(bent_animal, found, right)
    assert other is not None and best is not other
    assert other.residuals.energy < (1 + candidates.HARDLY_MORE) * best.residuals.energy


@pytest.mark.parametrize(("growth", "fewest", "again"), [(1.0, 601, True), (1.0, 600, False), (2.0, 601, False)])
def test_without_landmarks_coarse_meshes_alone_that_keep_their_sizes_are_registered_twice(
    growth: float, fewest: int, again: bool, bent_animal: SurfacePair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(candidates, "FEWEST_DECIDED", fewest)
    source = bent_animal.source.mesh
    larger = source.vertices * np.where(source.vertices[:, :1] > 0.3, growth, 1.0)
    pair = SurfacePair(bent_animal.source, measure(Mesh(larger, source.faces)))
    proposal = Proposal.of(pair, pair.target.mesh.vertices[pair.simplified[0].origin])
    assert candidates.may_lose_extremities(pair, proposal) is again
    assert candidates.may_lose_extremities(bent_animal, proposal)


def at(pair: SurfacePair, images: Integers) -> SurfacePoints:
    """Vertices of the target."""
    return SurfacePoints.at_vertices(pair.target.mesh, images)


@pytest.mark.parametrize(("mesh", "limbless"), [(shapes.bumpy_sphere(2), True), (animal(n_vertices=300), False)])
def test_a_map_that_bends_less_is_likelier_and_of_what_has_limbs_one_that_hardly_bends(
    mesh: Mesh, limbless: bool
) -> None:
    x, y, z = mesh.vertices.T
    bowed = Mesh(np.column_stack([x, y, z + 0.3 * x**2]), mesh.faces)
    pair = SurfacePair(measure(mesh), measure(bowed))
    proposal = Proposal.of(pair, pair.simplified[1].mesh.vertices)
    candidate = candidates.make_candidate(pair, proposal, LeastSquares(), 30)
    straight = replace(candidate, deformation=assessed(*pair.full, pair.full[0].mesh.vertices, FULL))
    gain = candidate.neg_log_likelihood - straight.neg_log_likelihood
    assert gain > 1 if limbless else gain == pytest.approx(np.log(HARDLY_BENT / candidates.LEAST_BENT))
