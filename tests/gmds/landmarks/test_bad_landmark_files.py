"""Landmark files that are none: errors name the file and the line; names and places pair up or not."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest
from landmark_texts import AT, AVIZO, HEAD, IN_SPACE, MARKS, markups, written

from gmds.errors import LandmarkError
from gmds.landmarks.files import ENDINGS, BadLandmarkFile, Landmarks, paired, read_landmarks, write_landmarks


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "", "no landmarks"),
        ("a.csv", "name,x,y,z\n", "no landmarks"),
        ("a.csv", "name,x,y,z\na,1,2\n", "line 2: 3 entries where the first line has 4"),
        ("a.csv", "name,x,y,z\na,1,2,nan\n", "line 2: 'nan' is not a number"),
        ("a.csv", "name,x,y,z\na,1,2,1e999\n", "line 2: a coordinate is too large"),
        ("a.csv", "name;x;y;z\na;1,5;2.5;3\n", "line 2: '1,5' is not a number"),
        ("a.csv", "name;x;y;z\na;1,5,2;2;3\n", "line 2: '1,5,2' is not a number"),
        ("a.csv", "name,x,y,z\na,NA,NA,NA\n", "none of its 1 landmarks has a place"),
        ("a.csv", "name,x,y,z\na,1,NA,3\n", "line 2: 'NA' is not a number"),
        ("a.csv", "s,1,2,3,4,5,6\nt,1,2,3\n", "line 2: 4 entries where the first line has 7"),
        ("a.csv", "ID,X1,Y1,Z1,X2,Y2,Z2\n", "no landmarks"),
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
        ("a.fcsv", HEAD + '1,1,2,3,0,0,0,1,1,1,0,"F-1,,\n', "line 4: unexpected end"),
        ("a.fcsv", HEAD + "\n", "holds no landmarks"),
        ("a.mrk.json", markups().replace('"markups": [', '"marks": ['), "not a markups file"),
        ("a.mrk.json", '{"@schema": 1, "markups": []}', r"not a markups file .*is 1\)"),
        ("a.mrk.json", markups().replace('"controlPoints": []', '"controlPoints": {}'), "no list of controlPoints"),
        ("a.mrk.json", markups().replace('"markups": [{', '"markups": [3, {'), r"markups\[0\]: no list"),
        ("a.fcsv", "# columns = id,x,y\n", "line 1: the columns must hold"),
        ("a.tps", "LM=2\n1 2\n3 4\n", "line 2: 2 coordinates"),
        ("a.tps", "1 2 3\n", "line 1: '1 2 3'; a specimen in space begins with"),
        ("a.tps", "", "holds no landmarks"),
        ("a.tps", "LM3=2\n1 2 3\n", "declares 2 landmarks and holds 1"),
        ("a.tps", "LM3=2\n1 2 3\nID=7\n", "line 3: it declares 2 landmarks and holds 1"),
        ("a.tps", "LM3=1\n1 2 3\n4 5 6\n", "line 3: '4 5 6' is one more"),
        ("a.tps", "LM3=1\n1 2 3\nID=a\nLM3=1\n1 2 3\nID=b\n", "holds 2 specimens; say which: .*they are a, b"),
        ("a.tps", "LM3=1\n1 2 3\nSCALE=-1\n", "line 3: the scale '-1'"),
        ("a.pts", "version: 1\nn_points: 2\n{\n1 2 3\n}\n", "declares 2 landmarks and holds 1"),
        ("a.pts", "version: 1\nn_points: 1\n{\n1 2\n}\n", "line 4: 2 coordinates"),
        ("a.pts", "version: 1\nn_points: 1\n1 2 3\n", "between lines with {"),
        ("a.pts", "version: 1\n", "count of landmarks must follow"),
        ("a.pts", "Version 1.0\nmany\n", "line 2: 'many' is not a whole number"),
        ("a.tps", "LM3=1\n1 2 3\nPOINTS=4\n", "line 3: it declares 5 landmarks and holds 1"),
        ("a.tps", "LM3=1\n1 2 3\nSCALE=mm\n", "line 3: the scale 'mm'"),
        ("a.tps", "LM3=1\n1 2 3\nlm=0\n", "holds no landmarks"),
        ("a.tps", "LM3=many\n1 2 3\n", "line 1: 'many' is not a whole number"),
        ("a.tps", "LM3=0\n", "holds no landmarks"),
        ("a.pts", "version: 1\nn_points: 1 2\n{\n1 2 3\n}\n", "line 2: n_points: and a count"),
        ("a.pts", "version: 1\npoints: 1\n{\n1 2 3\n}\n", "line 2: n_points: and a count"),
        ("a.pts", "version: 1\nn_points: 1\n1 2 3\n4 5 6\n}\n", "between lines with {"),
        ("a.pts", "version: 1\nn_points: 1\n{\n1 2 3\n4 5 6\n", "between lines with {"),
        ("a.pts", "version: 1\nn_points: 0\n{\n}\n", "holds no landmarks"),
        ("a.pts", "Version 1.0\n1 2\n1 2 3\n", "line 2: '1 2' is not a whole number"),
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
        ("a.json", "{}", "not a markups file"),
        ("a.docx", "{}", "files that end in"),
        ("a.pp", "<PickedPoints>", "no XML"),
        ("a.pp", "<Points/>", "holds no PickedPoints"),
        ("a.pp", "<PickedPoints/>", "holds no landmarks"),
        ("a.pp", '<PickedPoints>\n<point x="1" y="2"/></PickedPoints>', "line 2: '\\?' is not a number"),
        ("a.pp", '<!DOCTYPE P [<!ENTITY a "aa">]><PickedPoints/>', "line 1: it declares entities"),
        ("a.pp", '<!DOCTYPE P [<!ENTITY a SYSTEM "/etc/hostname">]><PickedPoints>&a;</PickedPoints>', "entities"),
        ("a.nts", "1 2 3 4\n", "no parameter line"),
        ("a.nts", "1 2 4 0 dim=2\n1 2 3 4 5 6 7 8\n", "line 1: landmarks in 2 dimensions"),
        ("a.nts", "1 2 6 0 dim=3\n1 2 3 4 5 6 7\n", "7 numbers where 2 times 6 are declared"),
        ("a.landmarkAscii", "1 2 3\n", "does not begin as a text file of Avizo"),
        ("a.landmarkAscii", "# Avizo 3D ASCII 2.0\n", "is no landmark set"),
        ("a.landmarkAscii", AVIZO.replace("Markers 2", "Markers 3"), "declares 3 landmarks and section @1 holds 2"),
        ("a.landmarkAscii", AVIZO.replace("\n@1", "\n@2"), "no data section @1"),
        ("a.xyz", "2\n1 2 3\n", "declares 2 landmarks and holds 1"),
        ("a.xyz", "1 2\n", "line 1: 2 coordinates"),
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


def test_landmarks_have_a_name_and_a_place_each_and_keep_them() -> None:
    for names, at in (
        (("a",), [[1, 2]]),
        (("a",), [[1, 2, 3, 4, 5]]),
        (("a",), [1, 2]),
        (("a", "b"), [[1, 2, 3]]),
        ((), [1]),
    ):
        with pytest.raises(BadLandmarkFile, match=f"{len(names)} names for landmarks of shape"):
            Landmarks(names, np.array(at))
    at = np.array([[1.0, 2, 3]])
    marks = Landmarks.unnamed(at)
    at[0] = 0
    assert marks.positions.tolist() == [[1, 2, 3]] and not marks.named and marks.missing == ()
    with pytest.raises(BadLandmarkFile, match="1 words of status for 2 landmarks"):
        Landmarks(("a", "b"), np.array([1, 2]), status=("defined",))
    with pytest.raises(BadLandmarkFile, match="or one without place"):
        Landmarks(("a",), np.array([[np.nan, 1, 2]]), status=("defined",))
    with pytest.raises(ValueError, match="read-only"):
        marks.at[0] = 0
    with pytest.raises(LandmarkError, match=r"'a', 'b', 'c', \.\.\. on the source"):
        paired(Landmarks(tuple("abcd"), np.arange(4)), Landmarks(("x",), np.array([7])))
