"""Retrieval: mending, vocabularies, bags and rankings, and what they must not depend on."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere, disc, icosphere, joined, moved, torus

from geodesics import Mesh, eigenpairs, embedded, write_mesh
from gmds.cli import main
from gmds.deformations import bending, deformed, gluing
from gmds.retrieval import (
    INVARIANT,
    REGULAR,
    REGULAR_FREQUENCIES,
    Vocabulary,
    bag,
    bag_distances,
    learn_vocabulary,
    learned,
    pair_bag,
    ranking,
    retrieval_scores,
    retrieve,
    signatures_of,
)
from gmds.retrieval.mending import largest_piece, mended, parted, smoothed, without_small_holes, without_spikes
from gmds.retrieval.vocabulary import k_means
from gmds.shapes import humanoid, quadruped

ALL = (REGULAR, REGULAR_FREQUENCIES, INVARIANT)


@pytest.fixture(scope="module")
def animal() -> Mesh:
    return quadruped(n_vertices=500)


@pytest.fixture(scope="module")
def toys(animal: Mesh) -> dict[str, Mesh]:
    """Three poses of an animal, two of a person, a torus."""
    return {
        "walk": quadruped("walk", n_vertices=500, seed=1),
        "person": humanoid(n_vertices=500),
        "torus": torus(),
        "turn": quadruped("turn", n_vertices=500, seed=2),
        "kick": humanoid("kick", n_vertices=500, seed=1),
    }


def vocabulary(n: int = 6, softness: float = 1.0) -> Vocabulary:
    random = np.random.default_rng(0)
    return Vocabulary(random.standard_normal((n, 3)), np.zeros(3), np.ones(3), softness)


# --- words


def test_assignments_are_shares() -> None:
    weight = vocabulary().assign(np.random.default_rng(1).standard_normal((40, 3)))
    assert weight.shape == (40, 6) and np.all(weight >= 0)
    assert np.allclose(weight.sum(axis=1), 1)


def test_assignment_is_the_formula() -> None:
    words, points = vocabulary(softness=0.7), np.random.default_rng(1).standard_normal((5, 3))
    for point, row in zip(points, words.assign(points), strict=True):
        plain = np.array([np.exp(-(np.linalg.norm(point - w) ** 2) / (2 * 0.7**2)) for w in words.words])
        assert np.allclose(row, plain / plain.sum())


def test_a_hard_assignment_is_the_limit_of_soft_ones() -> None:
    points = np.random.default_rng(2).standard_normal((50, 3))
    hard = vocabulary(softness=0).assign(points)
    assert set(hard.ravel()) == {0.0, 1.0}
    assert np.allclose(vocabulary(softness=1e-3).assign(points), hard)
    nearest = [np.linalg.norm(vocabulary().words - p, axis=1).argmin() for p in points]
    assert np.array_equal(hard.argmax(axis=1), nearest)
    assert np.allclose(vocabulary(softness=1e6).assign(points), 1 / 6)


def test_far_away_there_is_still_a_word() -> None:
    assert np.allclose(vocabulary(softness=0.01).assign(np.full((1, 3), 1e4)).sum(), 1)


def test_clusters_are_found() -> None:
    random = np.random.default_rng(3)
    centres = 10 * random.standard_normal((5, 2))
    points = np.repeat(centres, 40, axis=0) + 0.01 * random.standard_normal((200, 2))
    found = k_means(points, 5, np.random.default_rng(0))
    apart = np.linalg.norm(found[:, None] - centres, axis=2)
    assert len(found) == 5 and apart.min(axis=0).max() < 0.01 and apart.min(axis=1).max() < 0.01


def test_there_are_no_more_words_than_points() -> None:
    assert np.allclose(k_means(np.repeat([[0.0], [1.0]], 5, axis=0), 7, np.random.default_rng(0)).ravel().sum(), 1)
    one = learn_vocabulary([(np.ones((4, 2)), np.ones(4))])
    assert one.words.shape == (1, 2) and np.allclose(one.assign(np.zeros((3, 2))), 1)


@pytest.mark.parametrize("options", [{"samples": []}, {"n_words": 0}, {"softness": -1.0}, {"softness": np.nan}])
def test_a_vocabulary_needs_something_to_learn_from(options: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="vocabulary"):
        learn_vocabulary(**({"samples": [(np.eye(3), np.ones(3))]} | options))


def test_words_come_again_and_depend_on_weights_not_on_density() -> None:
    random = np.random.default_rng(4)
    values = random.standard_normal((500, 2))
    one, again = (learn_vocabulary([(values, np.ones(500))], 5) for _ in range(2))
    assert np.array_equal(one.words, again.words) and one.softness == again.softness
    other = learn_vocabulary([(values, np.ones(500))], 5, rng=1)
    assert not np.array_equal(one.words, other.words)
    weight = np.zeros(500)
    weight[:20] = 1
    assert np.allclose(
        learn_vocabulary([(values, weight)], 1, per_surface=4000).mean, values[:20].mean(axis=0), atol=0.1
    )


# --- bags


def test_bags_are_means_over_the_area() -> None:
    assignment, mass = vocabulary().assign(np.random.default_rng(5).standard_normal((30, 3))), np.arange(30.0)
    plain = sum(m * row for m, row in zip(mass, assignment, strict=True)) / mass.sum()
    assert np.allclose(bag(assignment, mass), plain) and bag(assignment, mass).sum() == pytest.approx(1)


def test_pairs_of_words_add_up_to_words(animal: Mesh) -> None:
    spectrum = eigenpairs(embedded(animal), 60)
    assignment = vocabulary().assign(np.random.default_rng(6).standard_normal((animal.n_vertices, 3)))
    pairs = pair_bag(assignment, spectrum, 0.1)
    assert np.allclose(pairs, pairs.T)
    assert np.allclose(pairs.sum(axis=1), bag(assignment, spectrum.mass))
    # after a long time heat is everywhere: words do not know of one another
    lone = bag(assignment, spectrum.mass)
    assert np.allclose(pair_bag(assignment, spectrum, 1e3), np.outer(lone, lone))


@pytest.fixture(scope="module")
def bags(animal: Mesh, toys: dict[str, Mesh]) -> Any:
    """A bag of features for each of the descriptors."""
    examples = [signatures_of(mesh, ALL) for mesh in (animal, toys["person"], toys["torus"])]
    return {d.name: learned([d], [(parts[i],) for parts in examples], 24) for i, d in enumerate(ALL)}


@pytest.mark.parametrize("name", [d.name for d in ALL])
def test_bags_do_not_know_numbering_place_or_size(animal: Mesh, bags: Any, name: str) -> None:
    one = bags[name](animal)
    assert one.sum() == pytest.approx(1) and np.all(one >= 0)
    order = np.random.default_rng(7).permutation(animal.n_vertices)
    renumbered = Mesh(animal.vertices[order], np.argsort(order)[animal.faces][::-1])
    for other in (renumbered, moved(animal, 1e3, seed=1), moved(animal, 1e-3, seed=2)):
        assert np.abs(bags[name](other) - one).sum() < 1e-3


def test_local_scale_is_nothing_in_the_invariant_metric(animal: Mesh, toys: dict[str, Mesh], bags: Any) -> None:
    grown = deformed(animal, "local-scale", 4, rng=1)[0]
    change = {name: np.abs(one(grown) - one(animal)).sum() for name, one in bags.items()}
    spread = {name: np.abs(one(toys["person"]) - one(animal)).sum() for name, one in bags.items()}
    assert change["invariant HKS"] < 0.5 * spread["invariant HKS"]
    assert change["invariant HKS"] / spread["invariant HKS"] < 0.5 * change["HKS"] / spread["HKS"]


def test_a_pose_is_little_beside_another_shape(animal: Mesh, toys: dict[str, Mesh], bags: Any) -> None:
    bent = bending(animal, 30, rng=1)[0]
    for one in bags.values():
        assert np.abs(one(bent) - one(animal)).sum() < 0.5 * np.abs(one(toys["person"]) - one(animal)).sum()


def test_several_descriptors_share_a_bag(animal: Mesh, toys: dict[str, Mesh]) -> None:
    both = [signatures_of(mesh, ALL[:2]) for mesh in (animal, toys["torus"])]
    together = learned(ALL[:2], both, 8)
    apart = [learned([d], [(parts[i],) for parts in both], 8) for i, d in enumerate(ALL[:2])]
    found = together.of(both[0])
    assert np.allclose(found, np.concatenate([one.of([part]) for one, part in zip(apart, both[0], strict=True)]) / 2)
    assert np.allclose(together(animal), found) and found.sum() == pytest.approx(1)


# --- mending


def euler(mesh: Mesh) -> int:
    edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return len(np.unique(mesh.faces)) - len(np.unique(edges, axis=0)) + mesh.n_faces


def test_what_was_glued_is_parted(animal: Mesh) -> None:
    glued = gluing(animal, 4)[0]
    assert glued.n_vertices < animal.n_vertices and euler(glued) < euler(animal)
    again = parted(glued)
    assert again.n_vertices == animal.n_vertices and euler(again) == euler(animal)
    assert np.array_equal(again.vertices[again.faces], glued.vertices[glued.faces])


def test_a_sound_mesh_is_not_parted(animal: Mesh) -> None:
    for mesh in (animal, disc(), torus()):
        same = parted(mesh)
        assert same.n_vertices == mesh.n_vertices and euler(same) == euler(mesh)
        assert np.allclose(same.vertices[same.faces], mesh.vertices[mesh.faces])


def test_the_largest_piece_is_kept() -> None:
    small, large = icosphere(3), torus()
    piece = largest_piece(joined(small, large))
    assert piece.n_vertices == large.n_vertices and piece.area == pytest.approx(large.area)


def test_small_holes_are_closed_and_large_ones_left() -> None:
    ball = icosphere(3)
    holed = Mesh(ball.vertices, ball.faces[~np.isin(ball.faces, [0, 100, 300]).any(axis=1)])
    closed = largest_piece(without_small_holes(holed))
    assert euler(closed) == 2 and closed.area == pytest.approx(ball.area, rel=0.01)
    corners = closed.vertices[closed.faces]  # all faces still look outwards
    assert np.linalg.det(corners).min() > 0
    assert without_small_holes(disc()) == disc() or without_small_holes(disc()).n_faces == disc().n_faces


def test_spikes_go_and_the_rest_stays() -> None:
    ball = icosphere(4)
    assert np.allclose(without_spikes(ball).vertices, ball.vertices)
    hit = np.array([50, 400, 2000])
    spiky = ball.vertices.copy()
    spiky[hit] *= 1.3
    healed = without_spikes(Mesh(spiky, ball.faces)).vertices
    assert np.abs(np.linalg.norm(healed[hit], axis=1) - 1).max() < 0.02
    assert np.allclose(np.delete(healed, hit, axis=0), np.delete(ball.vertices, hit, axis=0))


def test_smoothing_takes_noise_and_leaves_shape() -> None:
    ball = icosphere(4)
    noise = 0.01 * np.random.default_rng(8).standard_normal(ball.n_vertices)[:, None] * ball.vertices
    rough = Mesh(ball.vertices + noise, ball.faces)
    assert np.abs(smoothed(ball).vertices - ball.vertices).max() < 1e-2
    assert np.linalg.norm(smoothed(rough).vertices - smoothed(ball).vertices) < 0.5 * np.linalg.norm(noise)


def test_mending_scales_with_the_shape(animal: Mesh) -> None:
    damaged = deformed(deformed(animal, "shot-noise", 3)[0], "micro-holes", 1)[0]
    for factor in (1e-4, 1e4):
        other = mended(Mesh(factor * damaged.vertices, damaged.faces))
        assert np.allclose(other.vertices, factor * mended(damaged).vertices, rtol=1e-6, atol=1e-6 * factor)


# --- rankings


def test_the_same_kind_comes_first(animal: Mesh, toys: dict[str, Mesh]) -> None:
    found = retrieve(animal, list(toys.values()))
    assert {list(toys)[i] for i in found.order[:2]} == {"walk", "turn"}
    assert np.all(np.diff(found.distances) >= 0) and found.distances[0] > 0 and found.distances[-1] <= 2
    again = retrieve(animal, list(toys.values()))
    assert np.array_equal(found.distances, again.distances)


def test_features_can_be_any_function(animal: Mesh, toys: dict[str, Mesh]) -> None:
    found = retrieve(animal, list(toys.values()), lambda mesh: [mesh.n_faces])
    assert found.distances[0] == min(abs(mesh.n_faces - animal.n_faces) for mesh in toys.values())


def test_rankings_are_stable_and_may_be_empty() -> None:
    found = ranking(np.array([1.0, 0]), [np.array([0.0, 1]), np.array([1.0, 0]), np.array([0.0, 1])])
    assert found.order.tolist() == [1, 0, 2] and found.distances.tolist() == [0, 2, 2]
    assert len(ranking(np.zeros(2), []).order) == 0
    assert bag_distances([], [np.zeros(2)]).shape == (0, 1)


def test_scores_by_hand() -> None:
    distances = [[0, 1, 2, 3], [0, 0, 0, 0]]
    scores = retrieval_scores(distances, ["a", "b"], ["b", "a", "c", "a"])
    assert scores.nearest_neighbour == 50  # b of a tie comes first
    assert scores.first_tier == pytest.approx(100 * (0.5 + 1) / 2)
    assert scores.mean_average_precision == pytest.approx(100 * ((1 / 2 + 2 / 4) / 2 + 1) / 2)
    others = retrieval_scores(1 - np.eye(3), ["a", "a", "b"], ["a", "a", "b"], leave_out_self=True)
    assert others.queries == 2 and others.nearest_neighbour == 100
    with pytest.raises(ValueError, match="no query"):
        retrieval_scores([[0.0]], ["a"], ["b"])


# --- command line


def run(*args: object) -> Result:
    return CliRunner().invoke(main, [str(arg) for arg in args])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shapes = tmp_path / "shapes"
    shapes.mkdir()
    write_mesh(bumpy_sphere(3), shapes / "same.off")
    write_mesh(moved(bumpy_sphere(3), 3.0, seed=1), shapes / "same-larger.ply")
    write_mesh(torus(), shapes / "torus.obj")
    write_mesh(bumpy_sphere(3), tmp_path / "query.off")
    return shapes


def test_retrieve_ranks_a_folder(folder: Path, tmp_path: Path) -> None:
    result = run("retrieve", tmp_path / "query.off", folder, "--json", "-o", tmp_path / "ranking.csv")
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["ranking"]
    assert [row["mesh"] for row in rows][-1] == "torus.obj" and rows[0]["distance"] < 1e-6
    with (tmp_path / "ranking.csv").open(encoding="utf-8", newline="") as stream:
        assert [row["mesh"] for row in csv.DictReader(stream)] == [row["mesh"] for row in rows]


def test_retrieve_leaves_out_the_query_and_names_what_is_broken(folder: Path) -> None:
    (folder / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n", encoding="utf-8")
    (folder / "notes.txt").write_text("not a mesh", encoding="utf-8")
    result = run("retrieve", folder / "same.off", folder)
    assert result.exit_code == 3
    assert "broken.off" in result.stderr and "1 of 3 meshes" in result.stderr
    assert [line.split()[-1] for line in result.stdout.splitlines()] == ["same-larger.ply", "torus.obj"]


def test_retrieve_needs_a_query_and_something_to_compare(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert run("retrieve", tmp_path / "none.off", folder).exit_code == 1
    assert run("retrieve", tmp_path / "query.off", tmp_path / "empty").exit_code == 1
    assert run("retrieve", tmp_path / "query.off", tmp_path / "none").exit_code == 2
