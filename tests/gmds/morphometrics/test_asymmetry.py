"""Symmetric shapes have no asymmetry; what is put on one side is found there, with its sign."""

from __future__ import annotations

import numpy as np
import pytest
from generated_shapes import icosphere

from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument, BadShape
from gmds.atlases.sides import side_pairs
from gmds.morphometrics.asymmetry import matching_asymmetry, object_asymmetry
from gmds.morphometrics.pseudolandmarks import even_points, paired_points

BALL = icosphere(3)
MESH = Mesh(BALL.vertices * [0.6, 1.0, 1.4] + 0.2 * np.abs(BALL.vertices[:, [1]]) * [0, 0, 1], BALL.faces)
PARTNER = SurfacePoints.closest(MESH, MESH.vertices * [-1, 1, 1])
EVERY = np.ones((3, MESH.n_vertices), dtype=bool)


def bumped(height: float) -> np.ndarray:
    """The shape with a bump on its right."""
    bump = np.exp(-8 * ((MESH.vertices - [0.6, 0, 0]) ** 2).sum(axis=1))
    return MESH.vertices + height * bump[:, None] * [1, 0, 0]


def test_what_is_symmetric_has_none() -> None:
    found = object_asymmetry(np.stack([MESH.vertices] * 3), MESH.faces, PARTNER, EVERY)
    assert np.abs(found.signed).max() < 1e-9


def test_a_bump_on_one_side_is_directional_there_and_opposite_on_the_other() -> None:
    found = object_asymmetry(np.stack([bumped(h) for h in (0.1, 0.2, 0.3)]), MESH.faces, PARTNER, EVERY)
    right, left = int(MESH.vertices[:, 0].argmax()), int(MESH.vertices[:, 0].argmin())
    assert found.directional[right] > 0.01 and abs(found.directional[right] + found.directional[left]) < 0.003
    assert found.directional.argmax() == np.argmax(np.where(MESH.vertices[:, 0] > 0, found.directional, -1))
    assert found.shares[1] > found.shares[2] > 0 and np.isclose(sum(found.shares), 1)
    assert found.fluctuating[right] > 3 * np.median(found.fluctuating)


def test_bumps_on_either_side_are_fluctuating() -> None:
    other = bumped(0.2) * [-1, 1, 1]
    mirrored = other[PARTNER.nearest_vertices()]
    found = object_asymmetry(np.stack([bumped(0.2), mirrored]), MESH.faces, PARTNER, EVERY[:2])
    assert found.shares[2] > 20 * found.shares[1]


def test_missing_points_are_unknown() -> None:
    there = EVERY.copy()
    there[:, MESH.vertices[:, 2] > 1.0] = False
    found = object_asymmetry(np.stack([bumped(0.1)] * 3), MESH.faces, PARTNER, there)
    assert np.isnan(found.directional[MESH.vertices[:, 2] > 1.2]).all() and np.isfinite(found.directional).sum() > 400
    with pytest.raises(BadShape, match="partners"):
        object_asymmetry(np.stack([bumped(0.1)] * 3), MESH.faces, PARTNER[:5], there)


def test_two_sides_are_compared() -> None:
    left, right = np.stack([bumped(0.2)] * 3), np.stack([MESH.vertices] * 3)
    found = matching_asymmetry(left, right, MESH.faces, EVERY)
    assert found.directional.argmax() in np.flatnonzero(MESH.vertices[:, 0] > 0.4)
    names, one, other = side_pairs(np.array(["a", "a", "b", "c", "c"]), np.array(["l", "r", "l", "r", "l"]))
    assert names == ["a", "c"] and one.tolist() == [0, 4] and other.tolist() == [1, 3]
    with pytest.raises(BadArgument, match="two sides"):
        side_pairs(np.array(["a", "a"]), np.array(["l", "l"]))
    with pytest.raises(BadArgument, match="no individual"):
        side_pairs(np.array(["a", "b"]), np.array(["l", "r"]))


def test_pseudolandmarks_are_evenly_spread_and_come_in_pairs() -> None:
    chosen = even_points(MESH, 30)
    gaps = np.linalg.norm(MESH.vertices[chosen][:, None] - MESH.vertices[chosen], axis=2) + 9 * np.eye(30)
    assert len(set(chosen.tolist())) == 30 and gaps.min() > 0.35 * np.sqrt(MESH.area / 30)
    points, names = paired_points(MESH, PARTNER, 40)
    at = dict(zip(names, points.positions, strict=True))
    pairs = [name for name in names if name[0] == "L"]
    assert len(pairs) > 8 and any(name[0] == "M" for name in names)
    assert all(np.abs(at[name] * [-1, 1, 1] - at["R" + name[1:]]).max() < 1e-6 for name in pairs)
    for count in (4, 9, 40):
        assert len(paired_points(MESH, PARTNER, count)[1]) in (count, count + 1)
    with pytest.raises(BadArgument, match="from 1 to"):
        even_points(MESH, 0)
