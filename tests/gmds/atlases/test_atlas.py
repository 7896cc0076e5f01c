"""An atlas of a folder: one triangulation, whatever is broken named, the same bytes when it goes on, maps agree."""

from __future__ import annotations

import contextlib
import csv
import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

import gmds
import gmds.atlases.neighbours
import gmds.batch
from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from gmds.atlases.fusion import Said, fused
from gmds.atlases.registered import Atlas
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.errors import AtlasFileError, NoAtlas
from gmds.morphometrics.shape_model import ShapeModel
from gmds.shapes import Figure, quadruped, truth

pytest.importorskip("distributed", reason="the extra `batch` is not installed")

N = 250  # vertices: a match takes a second
SCALES = {"a": 0.8, "b": 1.0, "c": 1.25}


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with gmds.batch.local_client(1) as client:
        yield client


def animals() -> dict[str, Figure]:
    return {
        name: quadruped(n_vertices=N + 10 * i, leg_scale=scale, seed=i)
        for i, (name, scale) in enumerate(SCALES.items())
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three animals, one of them mirrored, and a file that is no mesh."""
    place = tmp_path_factory.mktemp("animals")
    for name, mesh in animals().items():
        other = Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, [0, 2, 1]]) if name == "c" else mesh
        write_mesh(other, place / f"{name}.ply")
    (place / "broken.ply").write_text("ply\nformat ascii 1.0\n")
    return place


def run(client: Any, monkeypatch: pytest.MonkeyPatch, *args: object) -> Result:
    monkeypatch.setattr(gmds.batch, "local_client", lambda workers: contextlib.nullcontext(client))
    return CliRunner().invoke(main, [*map(str, args)])


@pytest.fixture(scope="module")
def made(client: Any, folder: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    out = tmp_path_factory.mktemp("atlas") / "out"
    with pytest.MonkeyPatch.context() as patch:
        return out, run(client, patch, "atlas", folder, "-o", out, "--mirror", "c", "--json")


def test_every_specimen_has_the_same_faces_and_what_is_broken_is_named(made: tuple[Path, Result]) -> None:
    out, result = made
    assert result.exit_code == 3 and "left out broken: E204" in result.stderr
    told = json.loads(result.stdout)
    assert told["left_out"] == ["broken"] and told["specimens"] == 3 and told["mirrored"] == ["c"]
    meshes = [read_mesh(out / "registered" / f"{name}.ply") for name in SCALES]
    assert all(np.array_equal(mesh.faces, read_mesh(out / "mean.ply").faces) for mesh in meshes)
    with (out / "summary.csv").open() as stream:
        rows = {row["name"]: row for row in csv.DictReader(stream)}
    assert rows["broken"]["code"] == "E204" and rows[told["template"]]["status"] == "TEMPLATE"
    assert all(float(rows[name]["gap"]) < 0.02 and float(rows[name]["valid"]) == 1 for name in SCALES)


def test_vertices_are_the_same_points(made: tuple[Path, Result]) -> None:
    atlas, known = Atlas.load(made[0] / "atlas.npz"), animals()
    first = atlas.templates[0]
    for name in SCALES:
        place = atlas.configurations[atlas.index(name)]
        true = truth(known[first], known[name]).positions
        assert np.linalg.norm(place - true, axis=1).mean() < 0.05 * np.sqrt(known[name].area)
    gained = beside_trunk(atlas.growth[atlas.index("c")] - atlas.growth[atlas.index("a")], known[first])
    assert abs(gained - np.log(1.25 / 0.8)) < 0.2


def beside_trunk(values: np.ndarray, figure: Figure) -> float:
    """By how much values on the legs exceed those on the trunk, in the median."""
    legs, trunk = figure.rest[:, 2] < 0.6, (np.abs(figure.rest[:, 0]) < 0.35) & (figure.rest[:, 2] > 0.75)
    return float(np.nanmedian(values[legs]) - np.nanmedian(values[trunk]))


def test_a_run_that_goes_on_writes_the_same_bytes(
    made: tuple[Path, Result], client: Any, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, result = made
    half = tmp_path / "half"
    shutil.copytree(out, half)
    (half / "atlas.npz").unlink()
    template = json.loads(result.stdout)["template"]
    lost = sorted(path for path in (half / "maps" / "pairs").iterdir() if path.suffix == ".npz")[0]
    assert lost.name.startswith(template)
    lost.unlink()
    assert run(client, monkeypatch, "atlas", folder, "-o", half, "--mirror", "c").exit_code == 3
    for name in ("atlas.npz", "mean.ply", "summary.csv", "variation.csv", "registered/b.ply"):
        assert (half / name).read_bytes() == (out / name).read_bytes(), name


def test_a_second_round_uses_the_workers_there_are_and_neighbours_and_goes_on_where_it_was(
    made: tuple[Path, Result], client: Any, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gmds.atlases.neighbours, "FEWEST", 2)
    shutil.copytree(made[0], tmp_path / "out")
    entered = contextlib.contextmanager(lambda: (yield client))  # as `local_client`: to be entered once
    again = gmds.atlas(folder, tmp_path / "out", mirror=["c"], rounds=2, client=entered())
    assert len(again.changes) == 1 and again.changes[0] < 0.05 and again.names == tuple(SCALES)
    assert np.isfinite(again.spread).all() and 0 < again.spread.mean() < 0.05
    settled = sorted((tmp_path / "out" / "maps-2" / "settled").iterdir())
    assert len(settled) == 3  # each of three from another
    settled[0].write_bytes(settled[0].read_bytes()[:1000])  # as one that was killed leaves it on some drives
    on = gmds.atlas(folder, tmp_path / "out", mirror=["c"], rounds=2, client=client)
    assert np.array_equal(on.positions, again.positions) and np.array_equal(on.spread, again.spread)


def test_around_any_circle_points_come_home(made: tuple[Path, Result]) -> None:
    atlas = Atlas.load(made[0] / "atlas.npz")
    there = atlas.map("a", "b").vertex_map()
    assert np.array_equal(
        atlas.map("c", "a").vertex_map()[atlas.map("b", "c").vertex_map()[there]], np.arange(len(there))
    )
    start = SurfacePoints(atlas.registered[0], np.arange(20), np.full((20, 3), 1 / 3)).positions
    home = atlas.carry(atlas.carry(atlas.carry(start, "a", "b"), "b", "c"), "c", "a")
    assert np.abs(home - start).max() < 1e-9


def test_a_model_of_it_on_the_command_line(
    made: tuple[Path, Result], client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = run(client, monkeypatch, "model", made[0] / "atlas.npz", "-o", tmp_path / "model", "--json")
    assert result.exit_code == 0, result.output
    names = {path.name for path in (tmp_path / "model").iterdir()}
    assert {"model.npz", "mean.vtp", "mode1-plus.ply", "scores.csv", "modes.png", "model.html"} <= names
    page = (tmp_path / "model" / "model.html").read_text()
    assert "sha256-" in page and "<script src" not in page
    model = ShapeModel.load(tmp_path / "model" / "model.npz")
    order = np.argsort([SCALES[name] for name in model.names_])
    assert abs(np.corrcoef(model.scores_[order, 0], [0, 1, 2])[0, 1]) > 0.9
    with pytest.raises(AtlasFileError, match="E234"):
        Atlas.load(tmp_path / "model" / "model.npz")


def test_one_mesh_is_no_atlas(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_mesh(quadruped(n_vertices=N), tmp_path / "one.ply")
    alone = run(client, monkeypatch, "atlas", tmp_path, "-o", tmp_path / "out")
    assert alone.exit_code == 1 and "E507" in alone.stderr
    (tmp_path / "two.ply").write_text("")
    one = run(client, monkeypatch, "atlas", tmp_path, "-o", tmp_path / "out")
    assert one.exit_code == 1 and "E507" in one.stderr and "two: E201" in one.stderr
    (tmp_path / "none").mkdir()
    assert run(client, monkeypatch, "atlas", tmp_path / "none", "-o", tmp_path / "out").exit_code == 1
    with pytest.raises(NoAtlas):
        gmds.atlas({"one": quadruped(n_vertices=N)}, client=client)
    with pytest.raises(ValueError, match="no specimen 'three'"):
        gmds.atlas([tmp_path / "one.ply", tmp_path / "two.ply"], template="three", client=client)


def test_the_majority_is_heeded_and_doubt_is_told() -> None:
    mesh = quadruped(n_vertices=N)
    here = np.arange(N)
    right = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, here))
    wrong = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.roll(here, 40)))
    said = [Said.by(one) for one in (right, wrong, right)]
    voted = fused(said, mesh)
    assert np.abs(voted.places - mesh.vertices).max() < 0.01 * np.sqrt(mesh.area)
    assert voted.spread.mean() > 0.05 and fused([said[0]] * 3, mesh).spread.max() < 1e-9
    assert np.isnan(fused(said[:1], mesh).spread).all()
    sure, unsure = (replace(one, confidence=np.full(N, sure)) for one, sure in ((right, 0.9), (wrong, 0.3)))
    weighed = fused([Said.by(sure), Said.by(unsure), Said.by(unsure)], mesh)
    assert np.abs(weighed.places - mesh.vertices).max() < 0.01 * np.sqrt(mesh.area)


def test_groups_asymmetry_and_points_on_the_command_line(
    made: tuple[Path, Result], client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    atlas = made[0] / "atlas.npz"
    (tmp_path / "t.csv").write_text("name,legs\na,0.8\nb,1\nc,1.25\n")
    groups = run(client, monkeypatch, "groups", atlas, "--table", tmp_path / "t.csv", "--column", "legs", "-o", tmp_path / "g", "--json")  # fmt: skip # noqa: E501
    assert groups.exit_code == 0, groups.output
    assert json.loads(groups.stdout)["growth"]["r_squared"] > 0.8
    with (tmp_path / "g" / "points.csv").open() as stream:
        slope = np.array([float(row["slope"] or "nan") for row in csv.DictReader(stream)])
    with (tmp_path / "g" / "growth.csv").open() as stream:
        assert stream.readline() == "vertex,a,b,c\n" and len(stream.readlines()) == len(slope)
    template = animals()[json.loads(made[1].stdout)["template"]]
    assert 0.6 < beside_trunk(slope, template) < 1.6  # the logarithm of length grows by about 1 a unit of scale
    side = run(client, monkeypatch, "asymmetry", atlas, "-o", tmp_path / "s", "--json")
    assert side.exit_code == 0, side.output
    assert {p.name for p in (tmp_path / "s").iterdir()} == {
        "asymmetry.csv",
        "specimens.csv",
        "asymmetry.png",
        "mean.ply",
    }
    points = run(client, monkeypatch, "pseudolandmarks", atlas, "--count", 12, "--symmetric", "-o", tmp_path / "p.csv")
    assert points.exit_code == 0 and "L1" in (tmp_path / "p.csv").read_text()
    slid = run(
        client, monkeypatch, "pseudolandmarks", atlas, "--count", 9, "--slide", "bending", "-o", tmp_path / "q.csv"
    )
    assert slid.exit_code == 0, slid.output
    with (tmp_path / "q.csv").open() as stream:
        rows = [row for row in csv.DictReader(stream) if row["specimen"] == "c"]
    places = np.array([[float(row[axis]) for axis in "xyz"] for row in rows])
    on = SurfacePoints.closest(Atlas.load(atlas).registered[2], places).positions
    assert len(rows) == 9 and np.abs(on - places).max() < 1e-9
    wrong = run(client, monkeypatch, "groups", atlas, "--table", tmp_path / "t.csv", "--column", "arms", "-o", tmp_path)
    assert wrong.exit_code == 1 and "E235" in wrong.stderr
