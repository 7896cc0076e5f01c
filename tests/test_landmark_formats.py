"""Landmark files: every format back and forth, what others write, frames, and errors that name the line."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gmds.errors import LandmarkError
from gmds.landmark_files import ENDINGS, BadLandmarkFile, Landmarks, paired, read_landmarks, write_landmarks

AT = np.array([[1.25, -2.5, 3.0], [0.1, 1e-7, -1e6], [1 / 3, 2.0, 5.0]])
MARKS = Landmarks(("nose tip", 'left, "ear"', "Größe;3"), AT)
IN_SPACE = [ending for ending in ENDINGS if ending != ".vts"]
NAMED = [".csv", ".mrk.json", ".fcsv"]
HEAD = "# Markups fiducial file version = 4.13\n# CoordinateSystem = LPS\n# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"  # noqa: E501


def markups(*points: object, frame: str | None = "LPS", schema: str = "1.0.0") -> str:
    markup = {"type": "Fiducial", "controlPoints": list(points), **({"coordinateSystem": frame} if frame else {})}
    return json.dumps({"@schema": f"https://x/markups-schema-v{schema}.json#", "markups": [markup]})


def written(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


@pytest.mark.parametrize("ending", IN_SPACE)
@pytest.mark.parametrize("space", ["LPS", "RAS"])
def test_positions_come_back_to_the_last_digit(tmp_path: Path, ending: str, space: str) -> None:
    path = tmp_path / f"A{ending.upper()}"
    write_landmarks(path, MARKS, space, {"confidence": [0.5, 1.0, 0.25]})  # type: ignore[arg-type]
    back = read_landmarks(path, space)  # type: ignore[arg-type]
    assert (back.at == AT).all()
    if ending in NAMED:
        assert back.names == MARKS.names and back.named


@pytest.mark.parametrize("ending", [".csv", ".vts"])
def test_vertices_come_back(tmp_path: Path, ending: str) -> None:
    write_landmarks(tmp_path / f"a{ending}", Landmarks(("a", "b"), np.array([0, 41])))
    back = read_landmarks(tmp_path / f"a{ending}")
    assert back.at.dtype == np.int64 and back.at.tolist() == [0, 41]
    assert (tmp_path / "a.vts").exists() is False or (tmp_path / "a.vts").read_text() == "1\n42\n"


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    names=st.lists(
        st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=8),
        min_size=1,
        max_size=4,
        unique=True,
    ),
    ending=st.sampled_from(NAMED),
    seed=st.integers(0, 99),
)
def test_names_and_numbers_of_any_kind(tmp_path: Path, names: list[str], ending: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    at = rng.normal(size=(len(names), 3)) * 10.0 ** rng.integers(-30, 30)
    write_landmarks(tmp_path / f"a{ending}", Landmarks(tuple(names), at))
    back = read_landmarks(tmp_path / f"a{ending}")
    assert back.names == tuple(names)
    assert (back.at == at).all()


@pytest.mark.parametrize("ending", [".mrk.json", ".fcsv"])
def test_the_other_frame_turns_x_and_y(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    write_landmarks(path, MARKS, "RAS")
    assert (read_landmarks(path, "LPS").at == AT * [-1, -1, 1]).all()
    write_landmarks(path, MARKS, "LPS")
    assert (read_landmarks(path, "RAS").at == AT * [-1, -1, 1]).all()


@pytest.mark.parametrize(
    ("name", "text", "names", "first"),
    [
        ("a.csv", "x,y,z\n1,2,3\n", ("1",), [1, 2, 3]),
        ("a.csv", "1,2,3\n4,5,6\n", ("1", "2"), [1, 2, 3]),
        ("a.csv", "# by hand\n\nnose,1,2,3\n", ("nose",), [1, 2, 3]),
        ("a.csv", "z;label;y;x;note\n3;nose;2;1;hm\n", ("nose",), [1, 2, 3]),
        ("a.csv", "label,l,p,s,defined\nnose,1,2,3,1\near,0,0,0,0\n", ("nose",), [1, 2, 3]),
        ("a.csv", "label,r,a,s\nnose,1,2,3\n", ("nose",), [-1, -2, 3]),
        ("a.csv", "name,vertex\nnose,7\n", ("nose",), 7),
        ("a.csv", "nose,7\n", ("nose",), 7),
        ("a.csv", "7\n8\n", ("1", "2"), 7),
        ("a.fcsv", HEAD + "vtkMRMLMarkupsFiducialNode_0,1,2,3,0,0,0,1,1,1,0,F-1,,\n", ("F-1",), [1, 2, 3]),
        ("a.fcsv", "# CoordinateSystem = 0\n1,1,2,3,0,0,0,1,1,1,0,F-1,,\n", ("F-1",), [-1, -2, 3]),
        ("a.tps", "LM3=1\n1 2 3\nID=skull\nSCALE=1.0\n", ("1",), [1, 2, 3]),
        ("a.pts", "version: 1\nn_points: 1\n{\n1 2 3\n}\n", ("1",), [1, 2, 3]),
        ("a.pts", "Version 1.0\n1\nS000 1 2 3\n", ("S000",), [1, 2, 3]),
        ("a.pts", "nose 1 2 3\near 4 5 6\n", ("nose", "ear"), [1, 2, 3]),
        ("a.pts", "1 2 3\n", ("1",), [1, 2, 3]),
        ("a.csv", "a, 1\x1c,\x1f2 ,3\n", ("a",), [1, 2, 3]),
        ("a.csv", "name,vertex\na,7\x1c\n", ("a",), 7),
        ("a.mrk.json", markups({"label": "F-1", "position": [1, 2, 3]}, frame=None), ("F-1",), [1, 2, 3]),
        ("a.mrk.json", markups({"label": "F-1", "position": [1, 2, 3]}, frame="RAS"), ("F-1",), [-1, -2, 3]),
    ],
)
def test_what_others_write(tmp_path: Path, name: str, text: str, names: tuple[str, ...], first: object) -> None:
    found = read_landmarks(written(tmp_path, name, text))
    assert found.names == names
    assert found.at[0].tolist() == first
    assert read_landmarks(written(tmp_path, name, "\ufeff" + text.replace("\n", "\r\n"))).at[0].tolist() == first


def test_points_without_a_place_are_told(tmp_path: Path) -> None:
    there = {"label": "a", "position": [1, 2, 3]}
    nowhere = {"label": "b", "position": None, "positionStatus": "undefined"}
    found = read_landmarks(written(tmp_path, "a.mrk.json", markups(nowhere, there)))
    assert (found.names, found.missing) == (("a",), ("b",))
    with pytest.raises(BadLandmarkFile, match="without names"):
        read_landmarks(written(tmp_path, "a.mrk.json", markups({**nowhere, "label": ""}, {**there, "label": ""})))


def test_points_of_faces_come_back(tmp_path: Path) -> None:
    marks = Landmarks(("a", "b"), [[3, 0.25, 0.5, 0.25], [0, 1, 0, 0]])
    write_landmarks(tmp_path / "m.csv", marks, columns={"valid": [1, 0]})
    assert (tmp_path / "m.csv").read_text().splitlines()[1] == "a,3,0.25,0.5,0.25,1"
    again = read_landmarks(tmp_path / "m.csv")
    assert again.names == marks.names and np.array_equal(again.at, marks.at)
    (tmp_path / "bad.csv").write_text("name,face,w0,w1,w2\na,0.5,1,0,0\n")
    with pytest.raises(BadLandmarkFile, match=r"line 2: '0.5' is not a whole number"):
        read_landmarks(tmp_path / "bad.csv")
    with pytest.raises(BadLandmarkFile, match="keeps positions"):
        write_landmarks(tmp_path / "m.pts", marks)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "", "no landmarks"),
        ("a.csv", "name,x,y,z\n", "no landmarks"),
        ("a.csv", "name,x,y,z\na,1,2,3\na,4,5,6\n", "line 3: 'a' is also the name of the landmark at line 2"),
        ("a.csv", "name,x,y,z\na,1,2\n", "line 2: 3 entries where the first line has 4"),
        ("a.csv", "name,x,y,z\na,1,2,nan\n", "line 2: 'nan' is not a number"),
        ("a.csv", "name,x,y,z\na,1,2,1e999\n", "line 2: a coordinate is too large"),
        ("a.csv", "name;x;y;z\na;1,5;2;3\n", "line 2: '1,5' is not a number"),
        ("a.csv", "name,x,y\na,1,2\n", "line 1: a header needs"),
        ("a.csv", "1,2,3,4,5\n", "line 1: 5 entries"),
        ("a.csv", "name,vertex\na,1.5\n", "line 2: '1.5' is not a whole number"),
        ("a.csv", "name,vertex\na,-1\n", "line 2: -1 is below 0"),
        ("a.csv", 'name,x,y,z\n"a,1,2,3\n', "line 2: unexpected end"),
        ("a.fcsv", "1,1,2,3,0,0,0,1,1,1,0,F-1,,\n", "does not say its frame"),
        ("a.fcsv", "# CoordinateSystem = IJK\n", "line 1: the frame is 'IJK'"),
        ("a.fcsv", HEAD + "# CoordinateSystem = RAS\n", "line 4: the frame is 'RAS'"),
        ("a.fcsv", HEAD + "1,1,2,3\n", "line 4: 4 entries"),
        ("a.fcsv", HEAD + "1,1,two,3,0,0,0,1,1,1,0,F-1,,\n", "line 4: 'two' is not a number"),
        ("a.fcsv", "# columns = id,x,y\n", "line 1: the columns must hold"),
        ("a.tps", "LM=2\n1 2\n3 4\n", "line 1: 'LM=2'"),
        ("a.tps", "", "is empty"),
        ("a.tps", "LM3=2\n1 2 3\n", "declares 2 landmarks and holds 1"),
        ("a.tps", "LM3=2\n1 2 3\nID=7\n", "line 3: 1 coordinates"),
        ("a.tps", "LM3=1\n1 2 3\n4 5 6\n", "line 3: '4 5 6' is one more"),
        ("a.tps", "LM3=1\n1 2 3\nLM3=1\n1 2 3\n", "line 3: a second specimen"),
        ("a.tps", "LM3=1\n1 2 3\nSCALE=0.5\n", "line 3: a scale"),
        ("a.pts", "version: 1\nn_points: 2\n{\n1 2 3\n}\n", "declares 2 landmarks and holds 1"),
        ("a.pts", "version: 1\nn_points: 1\n{\n1 2\n}\n", "line 4: 2 coordinates"),
        ("a.pts", "version: 1\nn_points: 1\n1 2 3\n", "between lines with {"),
        ("a.pts", "version: 1\n", "count of landmarks must follow"),
        ("a.pts", "Version 1.0\nmany\n", "line 2: 'many' is not a whole number"),
        ("a.pts", "a 1 2 3 4\n", "line 1: 5 coordinates"),
        ("a.vts", "3\n0\n", "line 2: 0 is below 1"),
        ("a.vts", "3\n1.5\n", "line 2: '1.5'"),
        ("a.mrk.json", "{\n,", "line 2: not JSON"),
        ("a.mrk.json", "[" * 100_000, "not readable JSON|not JSON"),
        ("a.mrk.json", "[]", "not a markups file of schema 1.x"),
        ("a.mrk.json", markups(schema="2.0.0"), "not a markups file of schema 1.x"),
        ("a.mrk.json", markups(), "no landmarks"),
        ("a.mrk.json", markups(frame="IJK"), r"markups\[0\]: coordinateSystem is 'IJK'"),
        ("a.mrk.json", markups({"label": "b", "position": [1, 2]}), r"controlPoints\[0\] \('b'\): the position"),
        ("a.mrk.json", markups({"label": "b", "position": [1, 2, float("nan")]}), "three finite numbers"),
        ("a.mrk.json", markups({"label": "b", "position": [1, 2, 10**400]}), "three finite numbers"),
        ("a.mrk.json", markups({"label": "b", "position": [1, 2, True]}), "three finite numbers"),
        ("a.mrk.json", markups({"label": 3, "position": [1, 2, 3]}), "label is no text"),
        ("a.mrk.json", markups(3), "is no object"),
        ("a.json", "{}", "files that end in"),
    ],
)
def test_errors_name_file_and_line(tmp_path: Path, name: str, text: str, message: str) -> None:
    with pytest.raises(BadLandmarkFile, match=message) as caught:
        read_landmarks(written(tmp_path, name, text))
    assert str(caught.value).startswith("E306") and name in str(caught.value)


def test_bytes_that_are_no_text_and_folders(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(BadLandmarkFile, match="UTF-8"):
        read_landmarks(tmp_path / "a.csv")
    (tmp_path / "b.csv").mkdir()
    with pytest.raises(OSError, match="not a regular file"):
        read_landmarks(tmp_path / "b.csv")


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_file_cut_anywhere_is_an_error_or_shorter(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    write_landmarks(path, Landmarks(("a", "b", "c"), np.array([4, 5, 6]) if ending == ".vts" else AT))
    whole = path.read_bytes()
    for size in range(len(whole)):
        path.write_bytes(whole[:size])
        with contextlib.suppress(BadLandmarkFile):
            assert len(read_landmarks(path)) <= 3


def test_formats_refuse_what_they_can_not_keep(tmp_path: Path) -> None:
    for ending in [*IN_SPACE[1:], ".vts"]:
        marks = MARKS if ending == ".vts" else Landmarks(("a",), np.array([3]))
        with pytest.raises(BadLandmarkFile, match="this format keeps"):
            write_landmarks(tmp_path / f"a{ending}", marks)
        assert list(tmp_path.iterdir()) == []


def test_pairing_by_name_else_by_order() -> None:
    a = Landmarks(("p", "q", "r"), np.array([1, 2, 3]))
    b = Landmarks(("r", "s", "p"), np.array([30, 40, 10]))
    on_a, on_b, alone = paired(a, b)
    assert (on_a.at.tolist(), on_b.at.tolist(), set(alone)) == ([1, 3], [10, 30], {"q", "s"})
    on_a, on_b, alone = paired(a, Landmarks.unnamed(np.array([7, 8, 9])))
    assert (on_a.at.tolist(), on_b.at.tolist(), alone) == ([1, 2, 3], [7, 8, 9], ())
    with pytest.raises(LandmarkError, match="3 landmarks on the source but 1 on the target"):
        paired(a, Landmarks.unnamed(np.array([7])))
    with pytest.raises(LandmarkError, match="share no name: 'p', 'q', 'r' on the source, 'x' on the target"):
        paired(a, Landmarks(("x",), np.array([7])))
    with pytest.raises(BadLandmarkFile, match="more than one landmark is called 'x'"):
        Landmarks(("x", "x"), np.array([1, 2]))
