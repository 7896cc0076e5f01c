"""Landmark files: every format back and forth, what others write, and frames."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from landmark_texts import AT, HEAD, IN_SPACE, MARKS, NAMED, markups, written

from geodesics import Mesh
from gmds.errors import LandmarkError
from gmds.landmarks.checking import check_landmarks, place_on
from gmds.landmarks.files import BadLandmarkFile, Landmarks, read_landmarks, write_landmarks


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
        ("a.csv", "label,l,p,s,defined\nnose,1,2,3,1\near,0,0,0,0\n", ("nose", "ear"), [1, 2, 3]),
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
        ("a.tps", "lm3 = 1\n1 2 3\n\nCURVES=0\nIMAGE=a.png\nscale=1\n", ("1",), [1, 2, 3]),
        ("a.pts", "# by hand\n\n1 2 3\n# more\n4 5 6\n", ("1", "2"), [1, 2, 3]),
        ("a.pts", "VERSION 1.0\n1\n\n1 2 3\n", ("1",), [1, 2, 3]),
        (
            "a.fcsv",
            "# CoordinateSystem = 1\n# columns = label, z, y, x\nF-1,3,2,1\n\nF-2,1,1,1\n",
            ("F-1", "F-2"),
            [1, 2, 3],
        ),
        ("a.vts", " 8\n\n9\n", ("1", "2"), 7),
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


def test_every_list_of_markups_is_read_and_points_may_have_no_label(tmp_path: Path) -> None:
    first, last = markups({"position": [1, 2, 3]}), markups({"position": [4.5, 5, 6]}, frame="RAS")
    content = json.loads(first)
    content["markups"] += [{"type": "Fiducial"}, *json.loads(last)["markups"]]
    found = read_landmarks(written(tmp_path, "a.mrk.json", json.dumps(content)))
    assert found.at.tolist() == [[1, 2, 3], [-4.5, -5, 6]] and not found.named


@pytest.mark.parametrize("status", ["undefined", "missing", "preview"])
def test_points_without_a_place_are_told(tmp_path: Path, status: str) -> None:
    there = {"label": "a", "position": [1, 2, 3], "positionStatus": "defined"}
    nowhere = {"label": "b", "position": None, "positionStatus": status}
    found = read_landmarks(written(tmp_path, "a.mrk.json", markups(nowhere, there)))
    assert (found.names, found.missing, found.named) == (("b", "a"), ("b",), True)
    assert found.status == ("missing" if status == "missing" else "undefined", "defined")
    there["label"] = nowhere["label"] = ""
    found = read_landmarks(written(tmp_path, "a.mrk.json", markups(there, nowhere, there)))
    assert found.defined.tolist() == [True, False, True] and not found.named and found.missing == ("2",)


def test_fiducials_are_written_as_slicer_writes_them(tmp_path: Path) -> None:
    """Not turned, visible, selected, not locked."""
    write_landmarks(tmp_path / "a.fcsv", Landmarks(("F-1",), [[1.5, 2.5, 3.5]]), "LPS")
    assert (tmp_path / "a.fcsv").read_text() == HEAD + "1,1.5,2.5,3.5,0,0,0,1,1,1,0,F-1,,\n"


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


@pytest.mark.parametrize("ending", [".mrk.json", ".fcsv"])
def test_landmarks_that_lie_close_in_the_other_frame_are_refused(tmp_path: Path, ending: str) -> None:
    ball = bumpy_sphere(2)
    mesh = Mesh(ball.vertices * [1, 1.05, 1.1], ball.faces)  # nothing is farther off than 5 % in either frame
    marks = Landmarks(("a", "b", "c"), mesh.vertices[[3, 60, 90]])
    write_landmarks(tmp_path / f"a{ending}", marks, "LPS")
    write_landmarks(tmp_path / f"b{ending}", marks, "RAS")
    right = read_landmarks(tmp_path / f"a{ending}", "LPS"), read_landmarks(tmp_path / f"b{ending}", "RAS")
    wrong = read_landmarks(tmp_path / f"a{ending}", "RAS"), read_landmarks(tmp_path / f"b{ending}", "LPS")
    for good, bad in zip(right, wrong, strict=True):
        assert good.framed and np.allclose(place_on(good, mesh).positions, good.at)
        said = r"E305: the landmarks of the (source|surface) lie .* but 0\.00% with the signs of x and y .*--space RAS"
        for refused in (lambda x=bad: place_on(x, mesh), lambda x=bad: check_landmarks((x, x), mesh, mesh)):
            with pytest.raises(LandmarkError, match=said):
                refused()
        assert (place_on(replace(bad, framed=False), mesh).positions != bad.at).any(), "its file did not say a frame"
        careless = replace(good, at=good.at * 1.04)  # off the surface, in the right frame
        assert len(place_on(careless, mesh)) == 3


def test_where_a_surface_is_the_same_in_both_frames_none_is_refused() -> None:
    u, v = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1, 1, 21))
    corner = (np.arange(20)[:, None] * 21 + np.arange(20)).ravel()
    faces = np.concatenate(
        [np.stack([corner, corner + 1, corner + 22]).T, np.stack([corner, corner + 22, corner + 21]).T]
    )
    for lean in (0.0, 1e-4):  # the same turned by half a circle about z, or nearly so
        mesh = Mesh(np.stack([u.ravel(), v.ravel(), (u**2 + 2 * v**2 + lean * u).ravel()]).T, faces)
        for off in (0.0, 0.05):
            at = mesh.vertices[[50, 120, 333]] + [0, 0, off]
            for marks in (at, at * [-1, -1, 1]):
                assert len(place_on(Landmarks(("a", "b", "c"), marks, framed=True), mesh)) == 3
