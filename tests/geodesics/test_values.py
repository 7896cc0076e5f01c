"""Objects that hold arrays never change, are equal to themselves alone, and can be keys."""

from __future__ import annotations

import copy
import dataclasses

import numpy as np
import pytest
from generated_shapes import icosphere
from known_maps import identity

from geodesics import GeodesicDistance, Mesh, SurfacePoints, eigenpairs, embedded
from geodesics.io.contents import Contents
from geodesics.topology.edges import edges
from geodesics.topology.orientation import orientation
from gmds.landmarks.checking import place_landmarks
from gmds.landmarks.files import Landmarks
from gmds.landmarks.soft import SoftLandmarks
from gmds.maps.point_map import Candidate

MESH = icosphere(1)
POINTS = SurfacePoints.at_vertices(MESH, [3, 5])
PAIRS = np.array([[3, 5], [10, 1]])
VALUES = [
    MESH,
    POINTS,
    edges(MESH),
    orientation(MESH),
    embedded(MESH),
    eigenpairs(embedded(MESH), 3),
    GeodesicDistance(embedded(MESH)),
    identity(MESH),
    Candidate(POINTS, 0.5, 1.0),
    Landmarks(("a", "b"), np.array([3, 5])),
    SoftLandmarks(PAIRS),
    place_landmarks(PAIRS, MESH, MESH),
    Contents(MESH.vertices, MESH.faces),
]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_it_is_equal_to_itself_alone_and_can_be_a_key(value: object) -> None:
    other = copy.copy(value)
    assert {value: "it", other: "another"}[value] == "it"
    assert value == value and (value == other) is False


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_it_stays_as_it_was_made(value: object) -> None:
    for name in (field.name for field in dataclasses.fields(value)):  # type: ignore[arg-type]
        with pytest.raises(AttributeError):
            setattr(value, name, None)


def test_what_is_seen_of_it_is_short() -> None:
    assert [repr(value) for value in (MESH, POINTS, identity(MESH))] == [
        "Mesh(42 vertices, 80 faces)",
        "SurfacePoints(2 on Mesh(42 vertices, 80 faces))",
        "Correspondence(42 -> 42 vertices, 42 valid, UNRATED)",
    ]
    assert repr(Mesh(MESH.vertices, MESH.faces)) == repr(MESH)
