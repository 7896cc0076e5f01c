"""From a folder of specimens and one landmarked template to tables of landmarks and shapes."""

from __future__ import annotations

import csv
import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ROOT
from scipy.spatial.transform import Rotation

from geodesics import Mesh, write_mesh
from gmds.landmarks.files import Landmarks, read_landmarks, write_landmarks
from gmds.shapes import quadruped, truth

HERE = ROOT / "examples" / "morphometrics"
RNG = np.random.default_rng(4)
TURN = Rotation.from_euler("xyz", [20, 50, -70], degrees=True).as_matrix()


@pytest.fixture(scope="module")
def example() -> Iterator[Any]:
    sys.path.insert(0, str(HERE))
    yield importlib.import_module("landmark_specimens")
    sys.path.remove(str(HERE))


def test_place_size_and_rotation_do_not_matter(example: Any) -> None:
    shape = RNG.standard_normal((7, 3))
    moved = [scale * shape @ TURN.T + shift for scale, shift in ((1.0, 0.0), (1e-3, 5.0), (40.0, -7.0))]
    aligned, mean = example.procrustes.superimposed(np.stack([shape, *moved]))
    assert example.procrustes.distances(aligned, mean).max() < 1e-10
    assert example.procrustes.centroid_size(moved[2]) == pytest.approx(40 * example.procrustes.centroid_size(shape))
    mirrored = shape * [1, 1, -1]
    assert np.abs(example.procrustes.fitted(mirrored, shape) - shape).max() > 0.1


def test_the_mean_is_the_one_that_no_turn_improves(example: Any) -> None:
    shapes = RNG.standard_normal((7, 3)) + 0.15 * RNG.standard_normal((6, 7, 3))
    aligned, mean = example.procrustes.superimposed(shapes)
    assert np.linalg.norm(mean) == pytest.approx(1) and np.abs(mean.sum(axis=0)).max() < 1e-12
    assert np.allclose(np.linalg.norm(aligned, axis=(1, 2)), 1)
    total = ((aligned - aligned.mean(axis=0)) ** 2).sum()
    for _ in range(20):
        other = aligned.copy()
        other[RNG.integers(6)] @= Rotation.from_rotvec(0.02 * RNG.standard_normal(3)).as_matrix()
        assert ((other - other.mean(axis=0)) ** 2).sum() > total


def test_missing_landmarks_have_no_say(example: Any) -> None:
    shapes = RNG.standard_normal((7, 3)) + 0.1 * RNG.standard_normal((5, 7, 3))
    with_gap = np.vstack([shapes, (3 * shapes[2] @ TURN)[None]])
    with_gap[5, 4] = np.nan
    aligned, mean = example.procrustes.superimposed(with_gap)
    assert np.array_equal(mean, example.procrustes.superimposed(shapes)[1])
    assert np.isnan(aligned[5, 4]).all() and np.abs(aligned[5] - aligned[2])[[0, 1, 2, 3, 5, 6]].max() < 0.1
    with pytest.raises(ValueError, match="fewer than two"):
        example.procrustes.superimposed(with_gap[4:])


@pytest.fixture(scope="module")
def done(example: Any, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any, Any, Landmarks]:
    """A template, the same turned and three times as large, one in another pose, half of that, and a broken file."""
    folder, out = tmp_path_factory.mktemp("specimens"), tmp_path_factory.mktemp("out")
    template, marks, _ = example.built_in(500)
    walking = quadruped("walk", n_vertices=500, seed=1)
    half = walking.faces[walking.rest[walking.faces][..., 0].mean(axis=1) > 0]
    write_mesh(template, folder / "template.ply")
    write_mesh(Mesh(3 * template.vertices @ TURN.T, template.faces), folder / "a_turned.ply")
    write_mesh(walking, folder / "b_walking.ply")
    write_mesh(Mesh(walking.vertices, half), folder / "c_half.ply")
    (folder / "d_broken.ply").write_text("ply\n")
    write_landmarks(folder / "template.csv", marks)
    example.main([str(folder), "--template", str(folder / "template.ply"), "--landmarks", str(folder / "template.csv"),
                  "-o", str(out)])  # fmt: skip
    return out, template, walking, marks


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_the_table_holds_the_landmarks_where_they_belong(done: tuple[Path, Any, Any, Landmarks]) -> None:
    out, template, walking, marks = done
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


def test_the_tps_file_has_a_block_for_each_specimen(done: tuple[Path, Any, Any, Landmarks]) -> None:
    blocks = (done[0] / "landmarks.tps").read_text().split("\n\n")
    assert [block.strip().splitlines()[-1] for block in blocks] == [
        "ID=template", "ID=a_turned", "ID=b_walking", "ID=c_half",
    ]  # fmt: skip
    half = read_landmarks(done[0] / "landmarks.tps", specimen="c_half")
    assert 0 < half.defined.sum() < len(half)
    assert np.isnan(read_landmarks(done[0] / "landmarks.csv", specimen="c_half").at[~half.defined]).all()
    first = read_landmarks(done[0] / "landmarks.tps", specimen="a_turned")
    assert np.abs(first.positions - 3 * done[1].vertices[done[3].vertices] @ TURN.T).max() < 1e-6


def test_shapes_have_their_sizes_and_distances(done: tuple[Path, Any, Any, Landmarks]) -> None:
    table = {row["specimen"]: row for row in rows(done[0] / "shapes.csv")}
    place = done[1].vertices[done[3].vertices]
    size = np.linalg.norm(place - place.mean(axis=0))
    assert float(table["a_turned"]["centroid_size"]) == pytest.approx(3 * size)
    assert all(float(row["distance_to_mean"]) >= 0 for row in table.values())


def test_what_needs_a_look_is_told_and_everything_is_drawn(done: tuple[Path, Any, Any, Landmarks]) -> None:
    listed = {row["specimen"] for row in rows(done[0] / "to_look_at.csv")}
    assert "c_half" in listed and "a_turned" not in listed
    pictures = sorted((done[0] / "pictures").iterdir())
    assert [path.name for path in pictures] == ["a_turned.png", "b_walking.png", "c_half.png", "template.png"]
    assert all(path.stat().st_size > 10_000 for path in pictures)


def test_pictures_name_landmarks_as_tables_do(example: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.axes import Axes

    said: list[str] = []
    monkeypatch.setattr(Axes, "text", lambda _, x, y, words, **more: said.append(words))
    template, marks, _ = example.built_in(500)
    places = template.vertices[marks.vertices]
    places[3] = np.nan
    example.drawing.draw(tmp_path / "a.png", template, marks.names, places, np.zeros(len(marks), bool), (0, 0, 1))
    others = {name for i, name in enumerate(marks.names) if i != 3}
    assert set(said) <= others and len(set(said)) >= len(others) - 2  # what is behind in both views has none


def test_a_template_with_undefined_points(example: Any) -> None:
    template, marks, _ = example.built_in(500)
    some = Landmarks(marks.names, np.where(np.arange(len(marks)) == 2, -1, marks.vertices))
    one = example.Specimen.of_template("t", template, some)
    assert one.valid.tolist() == some.defined.tolist() and np.isnan(one.configuration[2]).all()
    assert not list(example.reasons([one], some, np.array([0.1])))
