"""Tables, tests, models and files of atlases that cannot be used are told from those that can."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geodesics.errors import BadArgument, MeshError
from gmds.atlases.registered import Atlas
from gmds.errors import AtlasFileError, BadGroups, ModelFileError
from gmds.morphometrics.group_tests import design, shape_test
from gmds.morphometrics.shape_model import ShapeModel
from gmds.morphometrics.specimen_tables import read_column
from gmds.shapes import quadruped

NAMES = ("a", "rex_v2", "käfer.b")
DOG = quadruped(n_vertices=60)


def read(tmp_path: Path, text: str, column: str = "group") -> np.ndarray:
    path = tmp_path / "t.csv"
    path.write_bytes(text.encode("utf-8-sig"))
    return read_column(path, column, NAMES)


@pytest.mark.parametrize("part", [",", ";", "\t"])
@pytest.mark.parametrize("ending", ["", ".ply", ".vtk.gz"])
def test_specimens_go_by_the_names_of_their_files(tmp_path: Path, part: str, ending: str) -> None:
    rows = [f"{name}{ending}{part}{word}" for name, word in (("a", "x"), ("rex v2", "y"), ("käfer.b", "x"))]
    assert read(tmp_path, "\r\n".join([f"name{part}group", *rows])).tolist() == ["x", "y", "x"]


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ("a,x\nrex_v2,y\n", "nothing of käfer.b"),
        ("a,x\nrex_v2,y\nkäfer,y\n", "nothing of käfer.b"),  # another specimen
        ("a,1\nrex_v2,NA\nkäfer.b,3\n", "nothing of rex_v2"),
        ("a,1\nrex_v2,NaN\nkäfer.b,3\n", "nothing of rex_v2"),
        ("a,1\nrex_v2,inf\nkäfer.b,3\n", "rex_v2 is inf"),
        ("a,x\na,y\nrex_v2,y\nkäfer.b,y\n", "row 3: a is y here and x before"),
        ("a.ply,x\na.obj,y\nrex_v2,y\nkäfer.b,y\n", "nothing of a "),  # which of the two?
        ("foo,1\nbar,2\n", "nothing of a under group .*of 3 of 3 .*rows are of foo, bar$"),
        ("a,1\nrex_v2,2\nkäfer.b,3O\n", "group of käfer.b is '3O', no number, and others are numbers"),
        ("a,x\n\0,y\n", "nothing of|no table"),
    ],
)
def test_what_a_table_does_not_say_is_named(tmp_path: Path, rows: str, told: str) -> None:
    with pytest.raises(BadGroups, match=f"E235: .*{told}"):
        read(tmp_path, f"name,group\n{rows}")


def test_two_columns_of_one_title(tmp_path: Path) -> None:
    with pytest.raises(BadGroups, match="2 columns"):
        read(tmp_path, "name,group,group\na,x,y\nrex_v2,x,y\nkäfer.b,x,x\n")


@pytest.mark.parametrize("values", [[1.0, 1.0, 1.0], [1.0, np.nan, 2.0], ["x", "x", "x"]])
def test_what_does_not_vary_explains_nothing(values: list[object]) -> None:
    with pytest.raises(BadArgument, match="E604"):
        design(np.array(values))


def test_twins_are_neither_tested_nor_a_model() -> None:
    twins = np.stack([DOG.vertices] * 4)
    with pytest.raises(BadArgument, match="all the same"):
        shape_test(twins, np.array([[0.0], [1], [0], [1]]))
    with pytest.raises(BadArgument, match="all the same"):
        ShapeModel().fit(twins + np.arange(4)[:, None, None])


def test_configurations_and_counts_are_checked() -> None:
    with pytest.raises(MeshError, match="E107"):
        ShapeModel().fit(np.full((3, 4, 3), "a"))
    with pytest.raises(BadArgument, match="E604: n_components"):
        ShapeModel(0).fit(np.random.default_rng(0).random((3, 4, 3)))


def test_files_whose_arrays_disagree_are_refused(tmp_path: Path) -> None:
    places = np.stack([DOG.vertices, 1.1 * DOG.vertices, DOG.vertices * [1, 1, 1.2]])
    there, none = np.ones((3, 60), dtype=bool), np.full((3, 60), np.nan)
    words = ("TEMPLATE", "GOOD", "GOOD")
    made = Atlas(NAMES, DOG.faces, places, there, np.zeros(3, dtype=bool), none, np.zeros(3), words, ("a",))
    made.save(tmp_path / "atlas.npz")
    assert Atlas.load(tmp_path / "atlas.npz").names == NAMES
    ShapeModel.from_atlas(made).save(tmp_path / "model.npz")
    assert ShapeModel.load(tmp_path / "model.npz").names_ == NAMES
    for kind, load, error in (("atlas", Atlas.load, AtlasFileError), ("model", ShapeModel.load, ModelFileError)):
        with np.load(tmp_path / f"{kind}.npz") as file:
            whole = dict(file)
        key = {"atlas": "valid", "model": "scores"}[kind]
        for change in (
            {"version": np.array(99)},
            {key: whole[key][:1]},
            {"names": np.array("a")},
            {"faces": 99 + DOG.faces},
        ):
            np.savez(tmp_path / "bad.npz", **{**whole, **change})
            with pytest.raises(error, match=r"E23[34]: .*bad\.npz"):
                load(tmp_path / "bad.npz")


def test_an_archive_of_something_else_is_no_atlas(tmp_path: Path) -> None:
    np.savez(tmp_path / "other.npz", names=["a"])
    with pytest.raises(AtlasFileError, match=r"E234: .*it has no array 'status'"):
        Atlas.load(tmp_path / "other.npz")
