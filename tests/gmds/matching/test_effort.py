"""What has to hold before a map is taken without asking other metrics."""

from __future__ import annotations

import numpy as np
import pytest

import gmds
from gmds.evaluation import geodesic_error
from gmds.matching.effort import MOST_GAP, largest_gap
from gmds.matching.pair import SurfacePair
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import assessed
from gmds.registration.settings import SIMPLIFIED
from gmds.shapes import quadruped, truth
from gmds.surface.measured import measure


@pytest.fixture(scope="module")
def both() -> tuple[DeformableMesh, DeformableMesh]:
    return SurfacePair(measure(quadruped(n_vertices=800)), measure(quadruped(n_vertices=800))).simplified


def test_a_surface_on_a_copy_is_nowhere_off(both: tuple[DeformableMesh, DeformableMesh]) -> None:
    source, target = both
    assert largest_gap(source, assessed(source, target, target.mesh.vertices, SIMPLIFIED)) < 1e-6


def test_a_surface_beside_its_copy_is_as_far_off_as_it_was_moved(both: tuple[DeformableMesh, DeformableMesh]) -> None:
    source, target = both
    moved = assessed(source, target, target.mesh.vertices + 2 * np.eye(3)[2], SIMPLIFIED)
    apart = np.linalg.norm(moved.points.positions - moved.y, axis=1)
    assert apart.min() <= largest_gap(source, moved) <= apart.max()


def test_one_foot_that_is_lifted_is_seen(both: tuple[DeformableMesh, DeformableMesh]) -> None:
    source, target = both
    y = target.mesh.vertices.copy()
    low = y[:, 2] < np.quantile(y[:, 2], 0.25)
    foot = low & (y[:, 0] > np.median(y[low, 0])) & (y[:, 1] > np.median(y[low, 1]))
    y[foot, 1] += 0.3
    lifted = assessed(source, target, y, SIMPLIFIED)
    gaps = np.linalg.norm(lifted.points.positions - lifted.y, axis=1)
    everywhere = np.sqrt(source.areas @ gaps**2)
    assert largest_gap(source, lifted) > max(MOST_GAP, 1.5 * everywhere)


def test_a_head_that_lies_turned_round_is_not_decided_early() -> None:
    """Nose and ears were exchanged, a tenth of the points off, and the map called GOOD."""
    source = quadruped("graze", n_vertices=2500, seed=18, ear_scale=0.97, leg_scale=0.89, head_scale=1.03)
    target = quadruped("stand", n_vertices=2500, seed=20, ear_scale=0.78, leg_scale=1.01, head_scale=0.87)
    error = geodesic_error(gmds.match(source, target).points, truth(source, target))
    assert error.mean() < 0.015 and (error > 0.1).mean() < 0.01
