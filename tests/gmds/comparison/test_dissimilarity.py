"""Dissimilarity is a distance between shapes, and knows neither pose nor size; profiles bound it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, torus

from geodesics import Mesh, read_mesh
from gmds import dissimilarity, distance_profile, least_distortion
from gmds.comparison import distortion
from gmds.comparison.clustering import families, leaf_order, nearest, neighbour_accuracy, plane_map, tree
from gmds.comparison.distortion import _one_way, descended, embedding_distortion
from gmds.comparison.profiles import EQUAL_AREA_SAMPLES, equal_area_samples, views
from gmds.deformations import similarity
from gmds.initialization import shortlist
from gmds.shapes import humanoid, quadruped


def shuffled(mesh: Mesh) -> Mesh:
    order = np.random.default_rng(5).permutation(mesh.n_vertices)
    rank = np.argsort(order)
    return Mesh(mesh.vertices[order], rank[mesh.faces][::-1])


@pytest.fixture(scope="module")
def family() -> dict[str, Mesh]:
    return {
        "animal": quadruped(n_vertices=900),
        "again": quadruped("walk", n_vertices=900, seed=1),
        "small, large ears": quadruped("turn", ear_scale=1.6, n_vertices=900, seed=2),
        "large, small ears": quadruped("graze", ear_scale=0.65, n_vertices=900, seed=3),
        "person": humanoid(n_vertices=900),
        "sphere": bumpy_sphere(3, seed=2),
        "torus": torus(20, 40),
    }


@pytest.fixture(scope="module")
def profiles(family: dict[str, Mesh]) -> dict[str, np.ndarray]:
    return {name: distance_profile(mesh) for name, mesh in family.items()}


def test_the_bound_is_a_distance(profiles: dict[str, np.ndarray]) -> None:
    values = list(profiles.values())
    d = np.array([[least_distortion(a, b) for b in values] for a in values])
    assert np.allclose(d, d.T) and (np.diag(d) == 0).all()
    assert (d[~np.eye(len(d), dtype=bool)] > 0).all()
    assert (d[:, None, :] <= d[:, :, None] + d[None, :, :] + 1e-12).all()  # the triangle inequality


def test_moved_resized_mirrored_and_renumbered_copies_are_no_distance_apart(family: dict[str, Mesh]) -> None:
    animal = family["animal"]
    mine = distance_profile(animal)
    turned = similarity(animal, largest_scale=5, rng=3)[0]
    mirrored = Mesh(animal.vertices * (1, -1, 1), animal.faces[:, [0, 2, 1]])
    for copy in (turned, mirrored, shuffled(animal), Mesh(1e-6 * animal.vertices, animal.faces)):
        assert least_distortion(mine, distance_profile(copy)) < 1e-3


def test_poses_and_sizes_of_parts_matter_less_than_being_another_thing(profiles: dict[str, np.ndarray]) -> None:
    within = ["animal", "again", "small, large ears", "large, small ears"]
    for name in within:
        near = max(least_distortion(profiles[name], profiles[other]) for other in within)
        for other in ("person", "sphere", "torus"):
            assert near < 0.8 * least_distortion(profiles[name], profiles[other]), (name, other)


def test_shares_stand_for_equal_areas(family: dict[str, Mesh]) -> None:
    for view in views(family["animal"]):
        places, mass = equal_area_samples(view), view.spectrum.mass
        assert len(places) == EQUAL_AREA_SAMPLES and (mass[places] > 0).all()
        moment = mass @ view.functions[:, 1:6] ** 2  # 1, as eigenfunctions are orthonormal
        assert np.allclose((view.functions[places, 1:6] ** 2).mean(axis=0), moment, rtol=0.25)


def test_embeddings_distort_other_things_more(family: dict[str, Mesh]) -> None:
    animal, again, person = (family[name] for name in ("animal", "again", "person"))
    to_pose, to_person = dissimilarity(animal, again), dissimilarity(animal, person)
    assert to_pose < 0.4 * to_person
    assert dissimilarity(animal, similarity(animal, largest_scale=3, rng=1)[0]) < 5e-3


def test_a_part_fits_into_the_whole_but_the_whole_does_not_fit_into_a_part() -> None:
    """Why both ways are asked for: one way alone, next to nothing would be near everything."""
    whole = np.random.default_rng(4).standard_normal((40, 3))
    ours = np.linalg.norm(whole[:, None] - whole, axis=2)
    part = ours[:9, :9]
    start = np.arange(9)
    start[[2, 5]] = 20, 30  # wrong places, to be left
    back = descended(ours, part, ours[:, :9].argmin(axis=1))
    assert descended(part, ours, start) == 0 and back > 0.2 * ours.mean()


def test_sweeps_lower_the_mean_absolute_stress_to_where_no_single_move_lowers_it() -> None:
    rng = np.random.default_rng(0)
    points, others = rng.random((15, 2)), rng.random((25, 2))
    ours, theirs = (np.linalg.norm(p[:, None] - p, axis=2) for p in (points, others))

    def stress(places: np.ndarray) -> float:
        return float(np.mean([abs(ours[i, j] - theirs[places[i], places[j]]) for i in range(15) for j in range(15)]))

    start = rng.integers(0, 25, 15)
    found = descended(ours, theirs, start)
    best = start.copy()
    for _ in range(6):  # the same, by trying every move
        before = stress(best)
        for x in range(15):
            best[x] = min(range(25), key=lambda y: stress(np.where(np.arange(15) == x, y, best)))
        if stress(best) > 0.99 * before:
            break
    assert found == pytest.approx(stress(best), rel=1e-12) and found < 0.8 * stress(start)


def test_both_ways_are_asked_for(family: dict[str, Mesh], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shortlist, "TRIED", 4)  # enough for what is tested here
    monkeypatch.setattr(distortion, "IMPROVED_STARTS", 1)
    ours, theirs = views(family["sphere"]), views(family["animal"])
    there, back = np.array(_one_way(ours, theirs)), np.array(_one_way(theirs, ours))
    assert (np.maximum(there, back) > 1.1 * np.minimum(there, back)).any()  # so that it matters here
    for pair in ((ours, theirs), (theirs, ours)):
        assert embedding_distortion(*pair) == np.maximum(there, back).mean()


def test_the_plane_map_of_points_in_a_plane_is_exact() -> None:
    points = np.random.default_rng(0).standard_normal((8, 2))
    d = np.linalg.norm(points[:, None] - points, axis=2)
    places = plane_map(d)
    assert np.allclose(np.linalg.norm(places[:, None] - places, axis=2), d)
    assert plane_map(np.zeros((1, 1))).tolist() == [[0, 0]]


def test_the_tree_joins_what_is_near_and_its_leaves_lie_in_that_order() -> None:
    spots = np.array([0.0, 10, 0.2, 10.1, 0.1])
    d = np.abs(spots[:, None] - spots)
    linkage = tree(d)
    assert linkage[-1, 3] == 5 and linkage[-1, 2] == pytest.approx(9.95)  # the mean over pairs, average linkage
    order = leaf_order(linkage)
    assert set(order[:3]) in ({0, 2, 4}, {1, 3, order[2]}) and (np.diff(spots[order]) > 0).sum() in (0, 4)
    assert tree(np.zeros((1, 1))).shape == (0, 4) and leaf_order(tree(np.zeros((1, 1)))).tolist() == [0]
    assert nearest(d)[:, 0].tolist() == [4, 3, 4, 1, 0]


def test_families_are_read_from_names() -> None:
    assert families(["cat0", "cat12", "dog_3", "b-7", "42", "wolf"]) == ["cat", "cat", "dog", "b", "42", "wolf"]
    d = np.abs(np.subtract.outer([0.0, 1, 9, 10, 20], [0.0, 1, 9, 10, 20]))
    assert neighbour_accuracy(d, list("aabbc")) == 1
    assert neighbour_accuracy(d, list("abbac")) == 0
    assert neighbour_accuracy(d, list("abcde")) is None


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="needs GMDS_DATA")
def test_nearest_neighbours_of_published_shapes_are_of_their_class() -> None:
    folder = Path(os.environ["GMDS_DATA"]) / "tosca_nonrigid_3k"
    names = ["cat0", "cat5", "dog0", "dog6", "horse0", "horse6", "wolf0", "wolf2", "gorilla1", "gorilla5"]
    found = [distance_profile(read_mesh(folder / f"{name}.vert")) for name in names]
    matrix = np.array([[least_distortion(a, b) for b in found] for a in found])
    assert neighbour_accuracy(matrix, families(names)) == 1
