"""Maps under consideration: what is done to them, and when."""

from __future__ import annotations

from typing import Any

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal

import gmds
from geodesics import BiharmonicDistance, Distance, Mesh, eigenpairs, scale_invariant
from gmds.matching import candidates
from gmds.registration.register import Registered


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
