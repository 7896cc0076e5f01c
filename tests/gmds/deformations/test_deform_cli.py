"""gmds deform: its files hold what the library computes, and the truth is exact."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from geodesics import Mesh, read_mesh, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.deformations import KINDS, compose, deformed, noise
from gmds.shapes import quadruped


def run(*args: object) -> Result:
    return CliRunner().invoke(main, ["deform", *map(str, args)])


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("deform") / "animal.ply"
    write_mesh(quadruped(n_vertices=600), path)
    return path


@pytest.fixture(scope="module")
def animal(path: Path) -> Mesh:
    return read_mesh(path)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_grows_with_its_strength(animal: Mesh, kind: str) -> None:
    def change(strength: int) -> float:
        mesh, truth = deformed(animal, kind, strength, rng=1)
        assert truth.mesh is mesh and len(truth) == animal.n_vertices
        ratio = np.log(np.linalg.norm(mesh.vertices, axis=1).max() / np.linalg.norm(animal.vertices, axis=1).max())
        lost = animal.n_vertices - mesh.n_vertices
        return lost + abs(ratio) + float(((truth.positions - animal.vertices) ** 2).sum())

    assert 0 < change(1) < change(5)
    assert all(len(values) == 5 for values in KINDS[kind].table.values())
    assert set(KINDS[kind].table) <= set(KINDS[kind].types)


def test_unknown_kinds_and_strengths_are_refused(animal: Mesh) -> None:
    with pytest.raises(ValueError, match="isometry, topology"):
        deformed(animal, "dents", 1)
    with pytest.raises(ValueError, match="not 6"):
        deformed(animal, "noise", 6)


def test_kinds_are_applied_in_order_with_a_seed_each(path: Path, animal: Mesh, tmp_path: Path) -> None:
    out = tmp_path / "new.ply"
    result = run(path, "isometry:2", "noise", "noise:strength=0.3", "-o", out, "--strength", 4, "--seed", 7, "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert said["steps"][0] == {"kind": "isometry", "angle": 20, "count": 4}
    assert said["steps"][2] == {"kind": "noise", "strength": 0.3}
    chain = compose(
        lambda m: deformed(m, "isometry", 2, 7),
        lambda m: deformed(m, "noise", 4, 8),
        lambda m: noise(m, 0.3, rng=9),
    )
    assert np.allclose(read_mesh(out).vertices, chain(animal)[0].vertices, atol=1e-5)


def test_the_truth_goes_through_growth_and_remeshing(path: Path, animal: Mesh, tmp_path: Path) -> None:
    out, truth = tmp_path / "new.ply", tmp_path / "truth.npz"
    kinds = ["scale:factor=3", "local-scale:2"]
    assert run(path, *kinds, "-o", tmp_path / "same.ply").exit_code == 0
    result = run(path, *kinds, "--remesh", 1000, "-o", out, "--truth", truth, "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert said["vertices"] == read_mesh(out).n_vertices == pytest.approx(1000, abs=5)
    answer = Correspondence.load(truth, animal, read_mesh(out))
    where = read_mesh(tmp_path / "same.ply").vertices  # vertex i is vertex i before the remeshing
    edge = np.linalg.norm(where[animal.faces[:, 0]] - where[animal.faces[:, 1]], axis=1).mean()
    gap = np.linalg.norm(answer.points.positions - where, axis=1)
    assert gap.mean() < 0.5 * edge and gap.max() < 2 * edge  # new triangles cut the tips off


def test_what_is_cut_off_is_not_valid_in_the_truth(path: Path, animal: Mesh, tmp_path: Path) -> None:
    out, truth = tmp_path / "part.ply", tmp_path / "truth.npz"
    kinds = ["isometry:2", "cut:share=0.4,normal=-1:0:0", "scale:factor=2"]
    result = run(path, *kinds, "-o", out, "--truth", truth, "--json")
    assert result.exit_code == 0, result.output
    part = read_mesh(out)
    assert json.loads(result.stdout)["steps"][1] == {"kind": "cut", "share": 0.4, "normal": [-1, 0, 0]}
    answer = Correspondence.load(truth, animal, part)
    assert answer.valid.sum() == part.n_vertices < 0.7 * animal.n_vertices
    bent, _ = deformed(animal, "isometry", 2, rng=0)
    assert np.allclose(answer.points.positions[answer.valid], 2 * bent.vertices[answer.valid], atol=1e-5)
    assert run(path, "scan:direction=0:1:0", "-o", out).exit_code == 0
    assert read_mesh(out).n_vertices < animal.n_vertices


def test_the_same_seed_gives_the_same_file(path: Path, tmp_path: Path) -> None:
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        assert run(path, "shot-noise", "-o", tmp_path / f"{name}.ply", "--seed", seed).exit_code == 0
    a, b, c = ((tmp_path / f"{name}.ply").read_bytes() for name in "abc")
    assert a == b != c


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ("dents", "'dents' is no kind"),
        ("noise:9", "strength from 1 to 5"),
        ("noise:12", "strength from 1 to 5"),
        ("noise:amount=2", "has no parameter 'amount'; it has strength"),
        ("noise:strength=loud", "must be a number, not 'loud'"),
        ("topology:count=1.5", "must be a whole number"),
        ("scan:direction=1:0", "must be three numbers x:y:z"),
    ],
)
def test_misuse_names_the_word(path: Path, tmp_path: Path, kind: str, message: str) -> None:
    result = run(path, kind, "-o", tmp_path / "x.ply")
    assert result.exit_code == 2 and message in result.stderr and not (tmp_path / "x.ply").exists()


def test_what_cannot_be_done_is_one_line(path: Path, tmp_path: Path) -> None:
    for kind in ("scale:factor=-1", "micro-holes:radius=9", "cut:share=1", "scan:direction=0:0:0"):
        result = run(path, kind, "-o", tmp_path / "x.ply")
        assert result.exit_code == 1 and len(result.stderr.splitlines()) == 1, result.output


def test_a_surface_with_many_holes_can_be_remeshed(path: Path, animal: Mesh, tmp_path: Path) -> None:
    result = run(path, "micro-holes:count=90", "-o", tmp_path / "x.ply", "--remesh", 300)  # many of them touch
    assert result.exit_code == 0, result.output
    glued = run(path, "remesh:n_vertices=500", "topology:1", "-o", tmp_path / "x.ply")
    assert glued.exit_code == 0, glued.output
    result = run(path, "topology:1", "-o", tmp_path / "x.ply", "--remesh", 500)
    assert result.exit_code == 1 and "remesh before" in result.stderr
