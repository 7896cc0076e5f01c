"""Distortion: the share by which lengths change; nothing where none do, at any size, place and handedness."""

from __future__ import annotations

import numpy as np
import pytest

from gmds.maps.distortion import edge_distortion
from tests.support.generated_shapes import bumpy_sphere, rectangle


@pytest.mark.parametrize("scale", [1e-6, 1.0, 40.0])
@pytest.mark.parametrize("mirror", [1, -1])
def test_copies_have_none(scale: float, mirror: int) -> None:
    mesh = bumpy_sphere(2)
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    assert edge_distortion(mesh, scale * mesh.vertices * (mirror, 1, 1) @ turn + 7 * scale).max() < 1e-9


def test_a_sheet_that_is_bent_has_nearly_none_and_one_that_is_stretched_its_share() -> None:
    mesh = rectangle(60, 30)
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    bent = np.column_stack([np.sin(x), y, np.cos(x)])
    assert edge_distortion(mesh, bent).max() < 0.01
    half = x > np.median(x)
    stretched = mesh.vertices * np.where(half, 2.0, 1.0)[:, None]
    found = edge_distortion(mesh, stretched)
    away = np.abs(x - np.median(x)) > 0.2 * np.ptp(x)
    assert np.ptp(found[away & half]) < 1e-9 and np.ptp(found[away & ~half]) < 1e-9
    assert sorted([found[away & half].mean(), found[away & ~half].mean()])[1] == pytest.approx(0.5, abs=1e-9)


def test_what_collapses_is_wholly_distorted() -> None:
    mesh = rectangle(10, 10)
    assert (edge_distortion(mesh, np.zeros((mesh.n_vertices, 3))) == 1).all()
