"""Links between specimens: carried one way and back points come home, and together they say more than one of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geodesics import Mesh, SurfacePoints
from gmds.atlases import links
from gmds.atlases.fusion import Fused
from gmds.atlases.links import Link, agreed
from gmds.atlases.registered import MIRROR
from gmds.atlases.sides import is_mirror, mirror_image
from gmds.atlases.template_maps import TemplateMaps
from gmds.correspondence import Correspondence
from gmds.shapes import Figure, quadruped, truth

N = 300


@pytest.fixture(scope="module")
def animals() -> dict[str, Figure]:
    poses = {"a": "stand", "b": "walk", "c": "graze", "d": "turn"}
    return {name: quadruped(pose, n_vertices=N + 5 * i, seed=i) for i, (name, pose) in enumerate(poses.items())}


def row(places: np.ndarray, valid: np.ndarray | None = None) -> Fused:
    there = np.ones(len(places), bool) if valid is None else valid
    return Fused(places, there, np.full(len(places), np.nan), np.ones(len(places)))


def link(source: Mesh, places: np.ndarray, valid: np.ndarray | None = None) -> Link:
    n = source.n_vertices
    return Link(source.vertices, places, source.faces, np.ones(n, bool) if valid is None else valid, np.ones(n))


def off(found: np.ndarray, right: np.ndarray, mesh: Mesh) -> float:
    return float(np.linalg.norm(found - right, axis=1).mean() / np.sqrt(mesh.area))


def slid(mesh: Mesh, places: np.ndarray, phase: float) -> np.ndarray:
    """Places moved along the surface, smoothly, by an error of its own for each phase."""
    size = np.sqrt(mesh.area)
    waves = np.sin(places[:, [1, 2, 0]] * (6 / size) + phase * np.array([1.0, 2.1, 3.7]))
    return SurfacePoints.closest(mesh, places + 0.03 * size * waves).positions


def test_one_way_and_back_points_come_home(animals: dict[str, Figure]) -> None:
    a, b = animals["a"], animals["b"]
    there = link(a, truth(a, b).positions)
    start = SurfacePoints(a, np.arange(50), np.full((50, 3), 1 / 3)).positions
    on = there.onward(start)
    assert on.valid.all() and np.abs(there.back(on.places).places - start).max() < 1e-9


def test_where_a_link_knows_nothing_it_says_nothing_of(animals: dict[str, Figure]) -> None:
    a, b = animals["a"], animals["b"]
    valid = a.vertices[:, 2] > 1.0
    there = link(a, truth(a, b).positions, valid)
    corners = there.faces[valid[there.faces].all(axis=1)]
    carried = there.onward(a.vertices[~valid]).places
    assert np.isin(np.flatnonzero(valid), corners).any()
    assert (np.linalg.norm(carried - truth(a, b).positions[valid].mean(axis=0), axis=1) < 1.5).all()
    nothing = link(a, truth(a, b).positions, np.zeros(N, bool)).onward(a.vertices)
    assert not nothing.valid.any()


def test_errors_that_differ_from_map_to_map_are_averaged_out_and_the_template_stays(
    animals: dict[str, Figure],
) -> None:
    first = animals["a"]
    right = {name: truth(first, mesh).positions for name, mesh in animals.items()}
    phases = {("a", "b"): 0.3, ("a", "c"): 1.7, ("a", "d"): 2.9, ("b", "c"): 4.1, ("c", "d"): 5.3, ("d", "b"): 0.9}
    made = {
        pair: link(animals[pair[0]], slid(animals[pair[1]], truth(*(animals[n] for n in pair)).positions, phase))
        for pair, phase in phases.items()
    }
    rows = {"a": row(first.vertices), **{n: row(made["a", n].there) for n in "bcd"}}
    found = agreed(rows, {pair: lambda one=one: one for pair, one in made.items()}, "a", animals.__getitem__)
    assert found["a"].places is rows["a"].places and found["a"].spread.max() == 0
    before, after = (np.mean([off(x[n].places, right[n], animals[n]) for n in "bcd"]) for x in (rows, found))
    assert after < 0.9 * before
    assert all(0.001 < found[n].spread.mean() < 0.1 for n in "bcd")


def test_a_link_that_could_not_be_made_and_a_specimen_without_any_change_nothing(animals: dict[str, Figure]) -> None:
    first, b = animals["a"], animals["b"]
    valid = first.vertices[:, 2] > 0.5
    rows = {
        "a": row(first.vertices),
        "b": row(truth(first, b).positions, valid),
        "c": row(truth(first, animals["c"]).positions),
    }
    found = agreed(rows, {("a", "b"): lambda: None, ("b", "x"): lambda: None}, "a", animals.__getitem__)
    assert found["b"] is rows["b"] and found["c"] is rows["c"]
    told = agreed(rows, {("a", "b"): lambda: link(first, rows["b"].places)}, "a", animals.__getitem__)
    assert np.array_equal(told["b"].valid, valid) and np.abs(told["b"].places - rows["b"].places).max() < 1e-6


def test_of_many_links_some_are_heard_evenly(animals: dict[str, Figure]) -> None:
    pairs = [("a", str(i)) for i in range(100)]
    some = links._some(pairs)
    assert len(some) == links.MOST and some[0] == pairs[0] and some[-1] == pairs[-1]
    assert links._some(pairs[:5]) == pairs[:5]


def test_the_link_of_a_specimen_of_the_other_side_is_mirrored(animals: dict[str, Figure], tmp_path: Path) -> None:
    a, b = animals["a"], animals["b"]
    image = mirror_image(b)
    points = truth(a, b)
    on_image = SurfacePoints(image, points.face, points.barycentric[:, [0, 2, 1]])
    (tmp_path / "pairs").mkdir()
    Correspondence.from_points(a, on_image).save(tmp_path / "pairs" / "a__b.npz")
    maps = TemplateMaps(tmp_path, [("a", "b")], {"a": a}, {"b": image}.__getitem__)
    assert np.abs(maps.said("b").places - points.positions * MIRROR).max() < 1e-9
    assert np.abs(maps.links(frozenset({"b"}))["a", "b"]().there - points.positions).max() < 1e-9  # type: ignore[union-attr]
    everywhere = np.ones(N, bool)
    one_sided = a.vertices + 0.5 * a.vertices[:, [0]] * np.maximum(a.vertices[:, [1]], 0)
    assert is_mirror(one_sided, one_sided * MIRROR, everywhere) and not is_mirror(one_sided, one_sided, everywhere)
