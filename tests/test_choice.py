"""Which map to believe."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapes
from matched import bumpy, mirror_vertices, surface

from gmds.choice import Evidence, evidence
from gmds.surface import Surface, measure

FAIR = Evidence(stress=0.05, curvature=0.8, orientation=0.4, dirichlet_energy=1.3)
LOBED = shapes.ellipsoid(2, (1.0, 1.4, 2.0))


def weighed(mine: Surface, images: np.ndarray) -> Evidence:
    views = mine.regular, mine.regular
    return evidence(mine, mine, views, mine.regular.samples(100), images)


@pytest.mark.parametrize("sense", [1, 0, -1])
@pytest.mark.parametrize(("name", "worse"), [("stress", 0.08), ("curvature", 0.6), ("dirichlet_energy", 1.8)])
def test_a_worse_part_is_a_larger_loss(name: str, worse: float, sense: int) -> None:
    assert replace(FAIR, **{name: worse}).loss(sense) > FAIR.loss(sense)


def test_orientation_counts_as_it_is_asked_for() -> None:
    kept, mixed, turned = (replace(FAIR, orientation=score) for score in (0.4, 0.0, -0.4))
    assert kept.loss(1) < mixed.loss(1) < turned.loss(1)
    assert kept.loss(-1) > mixed.loss(-1) > turned.loss(-1)
    assert kept.loss(0) == turned.loss(0) < mixed.loss(0)
    assert kept.loss(1) == pytest.approx(turned.loss(-1))


def test_the_loss_of_each_part_adds_up() -> None:
    change = {"stress": 0.1, "curvature": 0.2, "dirichlet_energy": 2.0}
    each = sum(replace(FAIR, **{name: value}).loss(1) - FAIR.loss(1) for name, value in change.items())
    assert replace(FAIR, **change).loss(1) - FAIR.loss(1) == pytest.approx(each)


def test_the_loss_is_finite_for_perfect_and_for_hopeless_maps() -> None:
    for sense in (1, 0, -1):
        for extreme in (Evidence(0.0, 1.0, 1.0, 0.0), Evidence(9.0, -1.0, -1.0, 99.0), Evidence(0.0, 0.0, 0.0, 1.0)):
            assert np.isfinite(extreme.loss(sense))


def test_the_identity_has_nothing_against_it() -> None:
    mine = surface(bumpy())
    found = weighed(mine, np.arange(bumpy().n_vertices))
    assert found.stress == pytest.approx(0, abs=1e-7)
    assert found.curvature == pytest.approx(1)
    assert found.orientation > 0.99
    assert found.dirichlet_energy == pytest.approx(1)


def test_no_map_has_less_loss_than_the_identity() -> None:
    mine, rng = surface(bumpy()), np.random.default_rng(0)
    same = np.arange(bumpy().n_vertices)
    best = weighed(mine, same).loss(1)
    near = bumpy().faces[np.searchsorted(np.sort(bumpy().faces.ravel()), same) // 3, 0]
    for other in (rng.permutation(same), np.zeros_like(same), near, same[::-1]):
        assert weighed(mine, other).loss(1) > best + 0.5


def test_a_constant_map_has_no_energy_but_all_the_stress() -> None:
    found = weighed(surface(bumpy()), np.zeros(bumpy().n_vertices, dtype=np.int64))
    assert found.dirichlet_energy == 0
    assert found.stress == pytest.approx(1)
    assert found.curvature == pytest.approx(0, abs=1e-9)
    assert found.orientation == 0


def test_a_torn_map_has_more_energy_than_a_whole_one() -> None:
    mine = surface(bumpy())
    torn = np.random.default_rng(1).permutation(bumpy().n_vertices)
    assert weighed(mine, torn).dirichlet_energy > 3


def test_a_mirrored_map_loses_when_orientation_is_kept_and_wins_when_it_is_reversed() -> None:
    mine, same = measure(LOBED), np.arange(LOBED.n_vertices)
    mirror = mirror_vertices(LOBED, 1)
    kept, turned = weighed(mine, same), weighed(mine, mirror)
    assert turned.stress == pytest.approx(0, abs=1e-6)  # distances and curvature can not tell them apart
    assert turned.curvature == pytest.approx(1, abs=1e-6)
    assert turned.orientation == pytest.approx(-kept.orientation, abs=1e-6)
    assert turned.loss(1) > kept.loss(1) + 1
    assert turned.loss(-1) < kept.loss(-1) - 1
    assert turned.loss(0) == pytest.approx(kept.loss(0), abs=0.1)


def test_curvature_knows_the_inside_from_the_outside() -> None:
    dented = shapes.bumpy_sphere(2, seed=3)
    mine = measure(dented)
    order = np.argsort(mine.squashed_curvature)
    upside_down = np.empty(len(order), dtype=np.int64)
    upside_down[order] = order[::-1]  # the most convex place goes to the most hollow one
    assert weighed(mine, upside_down).curvature < -0.5
