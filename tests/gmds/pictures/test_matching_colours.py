"""Limbs of a target are told apart by their colours, in any pose, by the colour blind as well."""

from __future__ import annotations

import time
from itertools import combinations

import numpy as np
import pytest
from colour_difference import ciede2000, lab
from generated_shapes import icosphere
from scipy.spatial.transform import Rotation

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from gmds.pictures.colours import MISSING, oklab_to_rgb
from gmds.pictures.matching_colours import TIPS, extremities, matching_colours
from gmds.shapes import humanoid, humanoid_poses, quadruped, quadruped_poses

# CIEDE2000: 1 is just seen; 10 is seen at a glance, also in the light and shade of a picture
APART = {"all cones": 22, "deuteranopia": 14, "protanopia": 14}
ANIMALS = [
    (quadruped, pose, scales) for pose in quadruped_poses for scales in ({}, {"head_scale": 2.0}, {"leg_scale": 1.5})
]
PEOPLE = [(humanoid, pose, scales) for pose in humanoid_poses for scales in ({}, {"hand_scale": 2.0})]


def limbs(shape: object, rest: Floats) -> list[Integers]:
    """Vertices at the ends of four legs, or of arms and legs, by where they stand at rest."""
    x, y, z = rest.T
    if shape is quadruped:
        ends = [(z < 0.12) & (s * x > 0) for s in (1, -1)]
    else:
        ends = [z < 0.08, (z > 0.5) & (np.abs(y) > 0.6)]
    return [np.flatnonzero(end & (s * y > 0)) for end in ends for s in (1, -1)]


def closest(colours: list[Floats], eyes: str) -> float:
    return min(float(ciede2000(lab(a, eyes), lab(b, eyes))) for a, b in combinations(colours, 2))


@pytest.mark.parametrize(("shape", "pose", "scales"), ANIMALS + PEOPLE)
def test_four_limbs_have_four_colours(shape: object, pose: str, scales: dict[str, float]) -> None:
    mesh = shape(pose, n_vertices=800, **scales)  # type: ignore[operator]
    for turn in (np.eye(3), Rotation.random(random_state=3).as_matrix()):
        colours = matching_colours(Mesh(mesh.vertices @ turn.T, mesh.faces))
        ends = [colours[rows].mean(axis=0) for rows in limbs(shape, mesh.rest)]
        for eyes, least in APART.items():
            assert closest(ends, eyes) > least, eyes


def test_colours_of_tips_are_far_from_each_other_and_from_grey() -> None:
    tips = oklab_to_rgb(TIPS)
    for eyes, least in {"all cones": 30, "deuteranopia": 19, "protanopia": 19}.items():
        assert closest(list(tips), eyes) > least
        assert min(ciede2000(lab(tips, eyes), lab([MISSING], eyes))) > 12


def test_the_difference_of_colours_is_that_of_the_published_table() -> None:
    """Sharma, Wu, Dalal 2005, table 1: rows 1, 7, 11, 20, 34."""
    first = [[50, 2.6772, -79.7751], [50, 0, 0], [50, 2.5, 0], [60.2574, -34.0099, 36.2677], [2.0776, 0.0795, -1.135]]
    second = [[50, 0, -82.7485], [50, -1, 2], [50, 0, -2.5], [60.4626, -34.1751, 39.4387], [0.9033, -0.0636, -0.5514]]
    assert np.allclose(ciede2000(first, second), [2.0425, 2.3669, 4.3065, 1.2644, 0.9082], atol=1e-4)


def test_colours_change_little_from_vertex_to_vertex() -> None:
    mesh = quadruped("walk", n_vertices=5000)
    colours = matching_colours(mesh)
    steps = [ciede2000(lab(colours[a]), lab(colours[b])) for a, b in (mesh.faces[:, :2].T, mesh.faces[:, 1:].T)]
    assert np.quantile(np.concatenate(steps), 0.99) < 10
    assert colours.min() >= 0 and colours.max() <= 1


def test_extremities_are_found_on_what_has_some_and_nothing_fails_elsewhere() -> None:
    mesh = quadruped(n_vertices=1500)
    tips, distances = extremities(mesh)
    assert len(tips) == 8 and (distances[np.arange(8), tips] == 0).all()
    sphere = icosphere(2)
    triangle = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    two = Mesh(np.concatenate([mesh.vertices, sphere.vertices + 9]), np.concatenate([mesh.faces, sphere.faces + 1500]))
    assert np.array_equal(np.sort(extremities(two)[0]), np.sort(tips)), "those of the body, not of the ball"
    for one in (sphere, two, triangle):
        assert np.isfinite(matching_colours(one)).all() and matching_colours(one).shape == one.vertices.shape


def test_a_large_surface_is_coloured_in_a_moment() -> None:
    mesh = quadruped(n_vertices=12_000)
    start = time.process_time()
    matching_colours(mesh)
    assert time.process_time() - start < 1.0
