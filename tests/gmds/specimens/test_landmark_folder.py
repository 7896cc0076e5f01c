"""From a folder of specimens and one landmarked template to tables of landmarks and shapes."""

from __future__ import annotations

import contextlib
import csv
import json
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import docs_files
import numpy as np
import pytest
from click.testing import CliRunner, Result
from places import ROOT
from scipy.spatial.transform import Rotation

import gmds.batch
from geodesics import Mesh, write_mesh
from gmds.cli import main
from gmds.landmarks.files import Landmarks, read_landmarks
from gmds.pictures.named import AWAY, LETTER, leftwards, seen
from gmds.shapes import quadruped, truth

TURN = Rotation.from_euler("xyz", [20, 50, -70], degrees=True).as_matrix()
Done = tuple[Path, Path, Any, Any, Landmarks]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Done:
    """A template, the same turned and three times as large, one in another pose, half of that, and a broken file."""
    folder, out = tmp_path_factory.mktemp("specimens"), tmp_path_factory.mktemp("out")
    example = runpy.run_path(str(ROOT / "examples" / "morphometrics" / "landmark_specimens.py"))
    example["write_animals"](folder, 300)
    for path in folder.glob("*.ply"):
        if path.name != "template.ply":
            path.unlink()
    marks, template = read_landmarks(folder / "template.csv"), quadruped(n_vertices=300)
    walking = quadruped("walk", n_vertices=300, seed=1)
    half = walking.faces[walking.rest[walking.faces][..., 0].mean(axis=1) > 0]
    write_mesh(Mesh(3 * template.vertices @ TURN.T, template.faces), folder / "a_turned.ply")
    write_mesh(walking, folder / "b_walking.ply")
    write_mesh(Mesh(walking.vertices, half), folder / "c_half.ply")
    (folder / "d_broken.ply").write_text("ply\n")
    told = gmds_landmarks(folder, out)
    assert told.exit_code == 3, told.output  # as one is left out
    assert "d_broken" in told.stderr and "3 of 4 pairs" in told.stderr and json.loads(told.stdout)["specimens"] == 3
    lines = [line for line in told.stderr.splitlines() if " pairs, " in line]
    assert len(lines) == 4 and sum("d_broken: failed" in line for line in lines) == 1, "a line a pair, by its name"
    return out, folder, template, walking, marks


@pytest.fixture(scope="module")
def worker() -> Iterator[Any]:
    """A cluster that is there already, and small pictures; `done` starts a cluster, and draws as large as users see."""
    with gmds.batch.local_client(1) as client, pytest.MonkeyPatch.context() as patch:
        patch.setattr(gmds.batch, "local_client", lambda workers: contextlib.nullcontext(client))
        patch.setattr("gmds.specimens.drawing.software", docs_files.small_pictures)
        yield


def gmds_landmarks(folder: Path, out: Path, template: str | Path | None = None) -> Result:
    named = ["--template", template or folder / "template.ply", "--landmarks", folder / "template.csv", "-o", out]
    return CliRunner().invoke(main, ["landmarks", *map(str, [folder, *named]), "--workers", "1", "--json"])


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_the_table_holds_the_landmarks_where_they_belong(done: Done) -> None:
    out, _, template, walking, marks = done
    table = rows(out / "landmarks.csv")
    assert [row["landmark"] for row in table] == [*marks.names] * 4
    assert list(dict.fromkeys(row["specimen"] for row in table)) == ["template", "a_turned", "b_walking", "c_half"]
    lost = [row for row in table if row["valid"] == "0"]
    assert {row["specimen"] for row in lost} == {"c_half"} and all(row["x"] == row["z"] == "NA" for row in lost)
    known = [[float(row[axis].replace("NA", "nan")) for axis in "xyz"] for row in table]
    own, *places = np.array(known).reshape(4, len(marks), 3)
    assert np.array_equal(own, template.vertices[marks.vertices])
    assert np.abs(places[0] - 3 * template.vertices[marks.vertices] @ TURN.T).max() < 1e-6
    true = truth(template, walking)[marks.vertices].positions
    off = np.linalg.norm(places[1] - true, axis=1) / np.sqrt(walking.area)
    trusted = np.array([float(row["confidence"]) >= 0.5 for row in table[2 * len(marks) : 3 * len(marks)]])
    assert trusted.sum() >= 6 and off[trusted].max() < 0.06  # the ears of so coarse an animal are doubtful, and told


def test_the_tps_file_has_a_block_for_each_specimen(done: Done) -> None:
    blocks = (done[0] / "landmarks.tps").read_text().split("\n\n")
    assert [block.strip().splitlines()[-1] for block in blocks] == [
        "ID=template", "ID=a_turned", "ID=b_walking", "ID=c_half",
    ]  # fmt: skip
    half = read_landmarks(done[0] / "landmarks.tps", specimen="c_half")
    assert 0 < half.defined.sum() < len(half)
    assert np.isnan(read_landmarks(done[0] / "landmarks.csv", specimen="c_half").at[~half.defined]).all()
    first = read_landmarks(done[0] / "landmarks.tps", specimen="a_turned")
    assert np.abs(first.positions - 3 * done[2].vertices[done[4].vertices] @ TURN.T).max() < 1e-6


def test_shapes_have_their_sizes_and_distances(done: Done) -> None:
    table = {row["specimen"]: row for row in rows(done[0] / "shapes_wide.csv")}
    place = done[2].vertices[done[4].vertices]
    size = np.linalg.norm(place - place.mean(axis=0))
    assert float(table["a_turned"]["centroid_size"]) == pytest.approx(3 * size)
    assert all(float(row["distance_to_mean"]) >= 0 for row in table.values())
    long, wide = rows(done[0] / "shapes.csv"), table["b_walking"]
    for row in long:
        if row["specimen"] == "b_walking":
            assert [row[axis] for axis in "xyz"] == [wide[f"{row['landmark']}.{axis}"] for axis in "xyz"]
    lost = {row["landmark"] for row in long if row["x"] == "NA"}
    assert lost and {row["specimen"] for row in long if row["x"] == "NA"} == {"c_half"}
    raw = {row["specimen"]: row for row in rows(done[0] / "landmarks_wide.csv")}
    assert list(raw) == ["template", "a_turned", "b_walking", "c_half"]
    assert float(raw["template"]["nose.x"]) == place[0, 0]


def test_what_needs_a_look_is_told_and_everything_is_drawn(done: Done) -> None:
    listed = {row["specimen"] for row in rows(done[0] / "to_look_at.csv")}
    assert {"c_half", "d_broken"} <= listed and "a_turned" not in listed
    pictures = sorted((done[0] / "pictures").iterdir())
    assert [path.name for path in pictures] == ["a_turned.png", "b_walking.png", "c_half.png", "template.png"]
    assert all(path.stat().st_size > 10_000 for path in [*pictures, done[0] / "sheet.png"])


def test_other_units_and_other_names_are_told(done: Done, worker: None, tmp_path: Path) -> None:
    """A specimen in micrometres among millimetres is listed; so is what a file is called whose name cannot stay."""
    folder = tmp_path / "folder"
    folder.mkdir()
    mesh = quadruped(n_vertices=300)
    for name, scale in (("template", 1.0), ("second", 1.1), ("third (scan #2)", 1000.0)):
        write_mesh(Mesh(scale * mesh.vertices, mesh.faces), folder / f"{name}.ply")
    (folder / "template.csv").write_text("name,vertex\na,3\nb,100\nc,200\nd,290\n")
    told = gmds_landmarks(folder, tmp_path / "out")
    assert told.exit_code == 0, told.output
    assert "third_scan_2 for 'third (scan #2).ply'" in told.stderr and "second for" not in told.stderr
    reasons = [row["why"] for row in rows(tmp_path / "out" / "to_look_at.csv") if row["specimen"] == "third_scan_2"]
    assert any("times as large as the median: in other units?" in why for why in reasons)


def test_it_goes_on_where_it_was_and_makes_nothing_again(done: Done, worker: None) -> None:
    maps = {path.name: path.stat().st_mtime_ns for path in (done[0] / "maps" / "pairs").iterdir()}
    before = (done[0] / "landmarks.csv").read_bytes()
    gone = next(iter(maps))
    (done[0] / "maps" / "pairs" / gone).unlink()
    assert gmds_landmarks(done[1], done[0]).exit_code == 3
    again = {path.name: path.stat().st_mtime_ns for path in (done[0] / "maps" / "pairs").iterdir()}
    assert {name for name in maps if again[name] != maps[name]} == {gone}
    assert (done[0] / "landmarks.csv").read_bytes() == before


@pytest.mark.parametrize("name", ["template", "template.ply"])
def test_the_template_goes_by_its_name_in_the_folder(done: Done, worker: None, name: str) -> None:
    before = (done[0] / "landmarks.csv").read_bytes()
    assert gmds_landmarks(done[1], done[0], name).exit_code == 3  # as with its path: one file is broken
    assert (done[0] / "landmarks.csv").read_bytes() == before


def test_a_name_of_no_specimen_is_told(done: Done, tmp_path: Path) -> None:
    told = gmds_landmarks(done[1], tmp_path / "out", "tenplate")
    assert told.exit_code != 0 and "tenplate" in told.output


def test_only_what_can_be_seen_is_named() -> None:
    """A landmark on the far side of a body has no name in that view, whatever its depth is beside the others'."""
    mesh = quadruped(n_vertices=800)
    side = np.array([np.linalg.norm(mesh.rest - [0, y, 1], axis=1).argmin() for y in (-0.3, 0.3)])  # both flanks
    toward = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # the viewer stands at -y
    camera = mesh.rest @ toward.T
    assert seen(camera, mesh.faces, camera[side]).tolist() == [True, False]
    assert seen(camera, mesh.faces, np.full((1, 3), np.nan)).tolist() == [False]


def test_wrong_use_is_told(tmp_path: Path) -> None:
    for args in (["a.ply"], ["a.ply", "b.csv"], ["f", "b.csv", "--template", "t.ply", "--landmarks", "l.csv"],
                 ["f", "--template", "t.ply"]):  # fmt: skip
        assert CliRunner().invoke(main, ["landmarks", *args, "-o", str(tmp_path / "out")]).exit_code == 2


@pytest.mark.parametrize("name", ["nose", "left fore foot"])
def test_names_stand_on_the_outer_side_and_within_the_view(name: str) -> None:
    wide, long = 560, LETTER * len(name) + AWAY
    for x in range(0, wide, 5):
        left, right = (x - long, x) if leftwards(x, name, wide) else (x, x + long)
        assert left >= 0 and right <= wide
        outward = x < wide / 2 if x > long and x + long <= wide else None
        assert outward is None or leftwards(x, name, wide) == outward
