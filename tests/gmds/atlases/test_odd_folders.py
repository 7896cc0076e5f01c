"""Folders that are not what one hopes for: two meshes, twins, other units, folders inside, names that no file can have
as part of its name, nowhere to write; every command says what is the matter."""

from __future__ import annotations

import contextlib
import errno
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

import gmds.batch
from geodesics import Mesh, write_mesh
from gmds.atlases.registered import Atlas
from gmds.cli import main
from gmds.shapes import quadruped

pytest.importorskip("distributed", reason="the extra `batch` is not installed")

N = 150  # vertices: a match takes a second


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with gmds.batch.local_client(1) as client:
        yield client


def run(client: Any, *args: object) -> Result:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gmds.batch, "local_client", lambda workers: contextlib.nullcontext(client))
        return CliRunner().invoke(main, [*map(str, args)])


@pytest.fixture(scope="module")
def twins(client: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The atlas of an animal and its copy."""
    place = tmp_path_factory.mktemp("twins")
    (place / "meshes").mkdir()
    for name in ("one", "other"):
        write_mesh(quadruped(n_vertices=N), place / "meshes" / f"{name}.ply")
    done = run(client, "atlas", place / "meshes", "-o", place / "atlas", "--json")
    assert done.exit_code == 0, done.output
    assert "one and other are the same shape" in done.stderr
    return place


def test_twins_are_one_shape(twins: Path) -> None:
    made = Atlas.load(twins / "atlas" / "atlas.npz")
    assert made.names == ("one", "other") and made.superposition.distances.max() < 1e-6
    assert np.abs(made.growth).max() < 1e-6


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (("model",), "the shapes are all the same"),
        (("groups", "--column", "size"), "2 shapes are too few"),
    ],
)
def test_where_nothing_varies_there_is_nothing_to_find(
    client: Any, twins: Path, tmp_path: Path, command: tuple[str, ...], says: str
) -> None:
    refused = run(client, command[0], twins / "atlas" / "atlas.npz", *command[1:], "-o", tmp_path / "out")
    assert refused.exit_code == 1 and "E604" in refused.stderr and says in refused.stderr
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_points_and_sides_of_twins(client: Any, twins: Path, tmp_path: Path) -> None:
    atlas = twins / "atlas" / "atlas.npz"
    points = run(client, "pseudolandmarks", atlas, "--count", 8, "-o", tmp_path / "p.tps")
    assert points.exit_code == 0 and (tmp_path / "p.tps").read_text().count("ID=") == 2
    sides = run(client, "asymmetry", atlas, "-o", tmp_path / "sides", "--json")
    assert sides.exit_code == 0, sides.output
    shares = json.loads(sides.stdout)["shares_of_variation"]
    assert shares["fluctuating"] < 1e-3 and shares["among_specimens"] < 1e-3


def test_specimens_in_other_units_and_places_are_the_shapes_they_are(client: Any, tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    for i, (name, unit) in enumerate({"metres": 1.0, "millimetres": 1000.0}.items()):
        mesh = quadruped(n_vertices=N + 10 * i, leg_scale=1 + 0.2 * i, seed=i)
        write_mesh(Mesh(mesh.vertices * unit + 7 * unit, mesh.faces), tmp_path / "meshes" / f"{name}.ply")
    (tmp_path / "meshes" / "broken.obj").write_text("v 0 0\nf 1 2 3\n")
    done = run(client, "atlas", tmp_path / "meshes", "-o", tmp_path / "atlas", "--json")
    assert done.exit_code == 3 and "left out broken: E2" in done.stderr
    assert "metres is" in done.stderr and "in other units?" in done.stderr
    made = Atlas.load(tmp_path / "atlas" / "atlas.npz")
    sizes = dict(zip(made.names, made.superposition.sizes, strict=True))
    assert 900 < sizes["millimetres"] / sizes["metres"] < 1200
    assert np.isfinite(made.growth).all() and np.abs(np.median(made.growth, axis=1)).max() < 0.1
    model = run(client, "model", tmp_path / "atlas" / "atlas.npz", "-o", tmp_path / "model", "--json")
    assert model.exit_code == 0 and json.loads(model.stdout)["components"] == 1
    large = run(client, "model", tmp_path / "atlas" / "atlas.npz", "--keep-size", "-o", tmp_path / "large")
    assert "in other units? Then the first component is that" in large.stderr
    (tmp_path / "t.csv").write_text("name,kind\nmetres,a\nmillimetres,b\n")
    known = ("--table", tmp_path / "t.csv", "--column", "kind", "-o", tmp_path / "groups")
    alone = run(client, "groups", tmp_path / "atlas" / "atlas.npz", *known)
    assert alone.exit_code == 1 and "too few for a test: each of the 2 groups has one (a, b)" in alone.stderr
    few = run(client, "groups", tmp_path / "atlas" / "atlas.npz", "--column", "size", "-o", tmp_path / "groups")
    assert few.exit_code == 1 and "2 shapes are too few" in few.stderr


def test_specimens_and_templates_of_any_name(client: Any, tmp_path: Path) -> None:
    meshes = tmp_path / "süße Hunde"
    meshes.mkdir()
    for name in ("Käfer  1.ply", "a b.ply", "a_b.ply"):
        write_mesh(quadruped(n_vertices=N), meshes / name)
    write_mesh(quadruped(n_vertices=N), tmp_path / "a b.ply")
    (tmp_path / "marks.csv").write_text("name,vertex\nnose,5\ntail,40\near,100\n")
    where = ("--template", tmp_path / "a b.ply", "--landmarks", tmp_path / "marks.csv", "-o", tmp_path / "aus gabe")
    done = run(client, "landmarks", meshes, *where, "--json")
    assert done.exit_code == 0 and json.loads(done.stdout)["specimens"] == 3, done.output
    names = {line.split(",")[0] for line in (tmp_path / "aus gabe" / "landmarks.csv").read_text().splitlines()[1:]}
    assert len(names) == 4 and "Käfer_1" in names


def test_folders_inside_are_told(client: Any, tmp_path: Path) -> None:
    inner = tmp_path / "meshes" / "left"
    inner.mkdir(parents=True)
    write_mesh(quadruped(n_vertices=N), inner / "one.ply")
    out = tmp_path / "atlas"
    none = run(client, "atlas", tmp_path / "meshes", "-o", out)
    assert none.exit_code == 1 and "E200" in none.stderr and "folders that have: left" in none.stderr
    write_mesh(quadruped(n_vertices=N), tmp_path / "meshes" / "other.ply")
    one = run(client, "atlas", tmp_path / "meshes", "-o", out)
    assert one.exit_code == 1 and "are not read: left" in one.stderr and "E507" in one.stderr
    mesh = run(client, "atlas", inner / "one.ply", "-o", out)
    assert mesh.exit_code == 1 and "one.ply is one mesh; name a folder" in mesh.stderr


@pytest.mark.parametrize("command", ["atlas", "model", "groups", "asymmetry", "batch"])
def test_where_nothing_can_be_written_is_found_out_first(
    client: Any, twins: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    given = twins / ("meshes" if command in ("atlas", "batch") else "atlas/atlas.npz")
    (tmp_path / "file").touch()
    for place in (tmp_path / "file", tmp_path / "file" / "inside"):
        refused = run(client, command, given, "-o", place)
        assert refused.exit_code == 2 and "is a file" in refused.stderr, refused.output

    def read_only(*_: Any, **__: Any) -> None:
        raise OSError(errno.EROFS, "Read-only file system", "/somewhere")

    monkeypatch.setattr("tempfile.TemporaryFile", read_only)
    refused = run(client, command, given, "-o", tmp_path / "new" / "out")
    assert refused.exit_code == 2 and "Read-only file system" in refused.stderr and not (tmp_path / "new").exists()


def test_the_folder_of_an_atlas_stands_for_its_file(client: Any, twins: Path, tmp_path: Path) -> None:
    for atlas in (twins / "atlas", twins / "atlas" / "atlas.npz"):
        told = run(client, "pseudolandmarks", atlas, "--count", "5", "-o", tmp_path / "points.csv")
        assert told.exit_code == 0 and (tmp_path / "points.csv").is_file(), told.output
        (tmp_path / "points.csv").unlink()
    refused = run(client, "model", twins / "meshes", "-o", tmp_path / "model")
    assert refused.exit_code == 1 and "E234" in refused.stderr and "atlas.npz" in refused.stderr
