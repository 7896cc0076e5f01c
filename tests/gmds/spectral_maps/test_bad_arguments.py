"""Scalings, functional maps and bounds answer what cannot be with an error that has a code and names the argument."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import geodesics
import gmds
from geodesics import GeodesicDistance, SurfacePoints
from gmds.shapes import quadruped

DOG, WOLF = quadruped(n_vertices=60), quadruped("walk", n_vertices=70, seed=1)
HERE, THERE = GeodesicDistance(DOG), GeodesicDistance(WOLF)
START = np.arange(60)
ROUGH = gmds.functional_map(DOG, WOLF, points=START, count=4)
X, Y = (np.random.default_rng(seed).random((5, 3)) for seed in (0, 1))
D, E = (np.linalg.norm(x[:, None] - x, axis=2) for x in (X, Y))
F, G = (np.random.default_rng(2).random((n, 3)) for n in (60, 70))

WRONG: list[tuple[str, str, Callable[[], Any]]] = [
    ("no count", "E604: count", lambda: geodesics.eigenpairs(DOG, None)),  # type: ignore[arg-type]
    ("half a function", "E604: count", lambda: gmds.self_functional_map(DOG, 1.5)),  # type: ignore[arg-type]
    ("one metric", "E604: metrics", lambda: gmds.self_functional_map(DOG, 5, metrics=(geodesics.embedded,))),  # type: ignore[arg-type]
    ("half a count", "E604: count", lambda: gmds.functional_map(DOG, WOLF, count=1.5)),  # type: ignore[arg-type]
    ("one descriptor", "E604: descriptors", lambda: gmds.functional_map(DOG, WOLF, (F,))),  # type: ignore[arg-type]
    ("no columns", "E604: .*the same", lambda: gmds.functional_map(DOG, WOLF, (F[:, :0], G[:, :0]))),
    ("constant", "E604: .*source are the same", lambda: gmds.functional_map(DOG, WOLF, (np.ones(60), np.ones(70)))),
    ("complex", "E107: descriptors", lambda: gmds.functional_map(DOG, WOLF, (F + 1j, G))),
    ("words", "E107: descriptors", lambda: gmds.functional_map(DOG, WOLF, (F.astype(str), G))),
    ("masked", "E107: descriptors", lambda: gmds.functional_map(DOG, WOLF, (np.ma.masked_less(F, 0.5), G))),
    ("a list", "E604: orientation", lambda: gmds.functional_map(DOG, WOLF, orientation=[])),  # type: ignore[arg-type]
    (
        "elsewhere",
        "E105",
        lambda: gmds.functional_map(DOG, WOLF, points=SurfacePoints.at_vertices(DOG, START), count=4),
    ),
    ("negative size", "E604: each of sizes", lambda: ROUGH.zoomed_out(9, sizes=[-1])),
    ("a size too large", "E604: each of sizes", lambda: ROUGH.zoomed_out(9, sizes=[99])),
    ("a cube", "E108: values", lambda: ROUGH.pull_back(np.ones((70, 2, 2)))),
    ("holes", "E604: values", lambda: ROUGH.pull_back(np.full(70, np.nan))),
    ("half a dimension", "E604: dimension", lambda: gmds.canonical_form(HERE, 1.5)),  # type: ignore[arg-type]
    ("half a vertex", "E106", lambda: gmds.canonical_form(HERE, samples=[0.5, 1])),
    ("no sample", "E604: samples", lambda: gmds.canonical_form(HERE, samples=[])),
    ("one sample", "E604: samples", lambda: gmds.canonical_form(HERE, samples=1)),
    ("twice", "E604: samples", lambda: gmds.canonical_form(HERE, samples=[3, 3])),
    ("weights", "E604: weights", lambda: gmds.canonical_form(HERE, samples=9, weights=-np.ones(9), method="spectral")),
    ("too many", "E604: dimension", lambda: gmds.canonical_form(HERE, 99, samples=9, method="spectral")),
    ("short start", "E108: there must be 60", lambda: gmds.spectral_gmds(HERE, THERE, [0, 1], count=4)),
    ("no samples", "E604: samples", lambda: gmds.spectral_gmds(HERE, THERE, START, count=4, samples=None)),  # type: ignore[arg-type]
    ("turned start", "E604: the source of start", lambda: gmds.spectral_gmds(THERE, HERE, ROUGH, count=4)),
    ("negative", "E604: distances", lambda: gmds.gromov_hausdorff_bounds(-D, E)),
    ("one way", "E604: distances", lambda: gmds.gromov_hausdorff_bounds(np.triu(D), E)),
    ("not 0", "E604: distances", lambda: gmds.gromov_wasserstein_bounds(D + np.eye(5), E)),
    ("huge", "E604: distances", lambda: gmds.gromov_wasserstein_bounds(1e300 * D, E)),
    ("ragged", "E108: distances", lambda: gmds.gromov_wasserstein_bounds([[0, 1], [1]], E)),
    ("nowhere", "E604: start", lambda: gmds.gromov_hausdorff_bounds(D, E, start=[0.5] * 5)),
    ("no permutation", "E604: start", lambda: gmds.gromov_wasserstein_bounds(D, E, start=[0] * 5)),
    ("nearer than near", "E604: covering", lambda: gmds.gromov_hausdorff_bounds(D, E, covering=(-1, 0))),
]


@pytest.mark.parametrize(("what", "told", "call"), WRONG, ids=[what for what, _, _ in WRONG])
def test_what_cannot_be_is_named(what: str, told: str, call: Callable[[], Any]) -> None:
    with pytest.raises(ValueError, match=told):
        call()


def test_a_path_is_no_surface() -> None:
    for call in (gmds.self_functional_map, gmds.canonical_form):
        with pytest.raises(TypeError, match="not "):
            call("dog.ply")  # type: ignore[operator]


def test_the_scale_of_descriptors_does_not_matter_however_large() -> None:
    plain, huge = (gmds.functional_map(DOG, WOLF, (s * F, s * G), count=4).matrix for s in (1.0, 1e300))
    assert np.allclose(plain, huge)
    assert np.isfinite(gmds.functional_map(DOG, WOLF, count=1).matrix).all()


def test_what_is_nowhere_on_the_surface_has_no_say() -> None:
    lonely = geodesics.Mesh(np.vstack([WOLF.vertices, [[9, 9, 9]]]), WOLF.faces)
    found = gmds.functional_map(DOG, lonely, points=START, count=4)
    values = np.r_[WOLF.vertices[:, 0], np.nan]
    assert np.allclose(found.pull_back(values), found.pull_back(np.nan_to_num(values)))
