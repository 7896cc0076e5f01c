"""Landmarks that are missing: on the template, or because the map has no counterpart for them; and equal names."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from generated_shapes import bumpy_sphere

from geodesics import Mesh, SurfacePoints, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.errors import LandmarkError
from gmds.landmarks.checking import check_landmarks
from gmds.landmarks.files import ENDINGS, BadLandmarkFile, Landmarks, paired, read_landmarks, write_landmarks
from gmds.landmarks.transfer import carry_landmarks
from gmds.maps.point_map import MatchStatus

SHAPE = bumpy_sphere(2)
TARGET = Mesh(SHAPE.vertices * 3, SHAPE.faces)
LOST = 40  # the vertex without a counterpart
NAMES = ("nose", "unset", "lost", "gone", "tail")
STATUS = ("defined", "undefined", "defined", "missing", "defined")
AT = SHAPE.vertices[[3, 0, LOST, 0, 60]]
MARKS = Landmarks(NAMES, AT, status=STATUS)  # type: ignore[arg-type]


def answer() -> Correspondence:
    points = SurfacePoints.at_vertices(TARGET, np.arange(SHAPE.n_vertices))
    valid = np.arange(SHAPE.n_vertices) != LOST
    sure = np.ones(SHAPE.n_vertices)
    return Correspondence.from_points(SHAPE, points, valid=valid, status=MatchStatus.GOOD, confidence=sure)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_mesh(SHAPE, tmp_path / "a.ply")
    write_mesh(TARGET, tmp_path / "b.ply")
    answer().save(tmp_path / "map.npz")
    return tmp_path


def carried(folder: Path, marks: str, output: str, *more: str) -> str:
    place = [str(folder / name) for name in ("a.ply", marks, "b.ply")]
    done = CliRunner().invoke(
        main, ["landmarks", *place, "--map", str(folder / "map.npz"), "-o", str(folder / output), *more]
    )
    assert done.exit_code == 0, done.output
    return done.output


def test_a_place_that_is_missing_is_no_number() -> None:
    assert np.isnan(MARKS.at[[1, 3]]).all() and MARKS.defined.tolist() == [True, False, True, False, True]
    assert MARKS.missing == ("unset", "gone")
    assert Landmarks(("a", "b"), np.array([4, -1])).status == ("defined", "missing")


def test_markups_keep_all_points_in_their_places(folder: Path) -> None:
    write_landmarks(folder / "a.mrk.json", MARKS)
    carried(folder, "a.mrk.json", "b.mrk.json")
    points = json.loads((folder / "b.mrk.json").read_text())["markups"][0]["controlPoints"]
    assert [point["label"] for point in points] == list(NAMES)
    assert [point["positionStatus"] for point in points] == ["defined", "undefined", "missing", "missing", "defined"]
    assert points[2]["position"] == [0, 0, 0]
    assert np.allclose(points[4]["position"], TARGET.vertices[60])


@pytest.mark.parametrize("ending", [e for e in ENDINGS if e not in (".fcsv", ".vts")])
def test_every_format_says_what_is_missing(folder: Path, ending: str) -> None:
    write_landmarks(folder / f"a{ending}", MARKS)
    carried(folder, f"a{ending}", f"b{ending}")
    found = read_landmarks(folder / f"b{ending}")
    assert found.defined.tolist() == [True, False, False, False, True]
    assert np.allclose(found.at[found.defined], TARGET.vertices[[3, 60]])
    if ending in (".csv", ".tps", ".pts"):
        moved = 2 * (ending == ".csv")  # what has no place on the source was not moved either
        assert (folder / f"b{ending}").read_text().count("NA") == 9 + moved


def test_fiducials_are_left_out_and_vertices_say_na(folder: Path) -> None:
    write_landmarks(folder / "a.csv", MARKS)
    said = carried(folder, "a.csv", "b.fcsv")
    assert "3 landmarks without a place are left out, as .fcsv has no word for them" in said
    assert read_landmarks(folder / "b.fcsv").names == ("nose", "tail")
    write_landmarks(folder / "a.csv", Landmarks(NAMES, [3, -1, LOST, -1, 60]))
    carried(folder, "a.csv", "b.vts")
    assert (folder / "b.vts").read_text() == "4\nNA\nNA\nNA\n61\n"
    assert read_landmarks(folder / "b.vts").at.tolist() == [3, -1, -1, -1, 60]


def test_json_has_null_and_says_why(folder: Path) -> None:
    write_landmarks(folder / "a.csv", MARKS)
    rows = json.loads(CliRunner().invoke(main, [
        "landmarks", *(str(folder / n) for n in ("a.ply", "a.csv", "b.ply")), "--map", str(folder / "map.npz"),
        "-o", str(folder / "b.csv"), "--json",
    ]).stdout)["carried"]  # fmt: skip
    assert [row["position"] is None for row in rows] == [False, True, True, True, False]
    assert [row["moved"] is None for row in rows] == [False, True, False, True, False]
    said = carried(folder, "a.csv", "b.csv")
    assert "without a counterpart on the target: lost\n" in said
    assert "2 landmarks have no place on the source: unset, gone\n" in said


def test_what_is_missing_is_paired_with_nothing() -> None:
    other = Landmarks(("tail", "nose", "unset"), np.array([7, -1, 9]))
    ours, theirs, alone = paired(MARKS, other)
    assert ours.names == theirs.names == ("tail",) and set(alone) == {"nose", "lost", "unset"}
    by_order = Landmarks.unnamed(np.array([5, 6, -1, 8, 9]))
    ours, theirs, alone = paired(MARKS, by_order)
    assert ours.names == ("nose", "tail") and theirs.at.tolist() == [5, 9] and alone == ("unset", "lost", "gone")
    with pytest.raises(LandmarkError, match="no landmark has a place on both"):
        paired(Landmarks.unnamed(np.array([1, -1])), Landmarks.unnamed(np.array([-1, 1])))


def test_equal_names_are_kept_and_told_apart_by_their_order(folder: Path) -> None:
    (folder / "a.csv").write_text("name,vertex\nF,3\nF,50\nF (2),60\n")
    found = read_landmarks(folder / "a.csv")
    assert found.names == ("F", "F", "F (2)") and found.distinct_names == ("F", "F (3)", "F (2)")
    said = carried(folder, "a.csv", "b.csv")
    assert [line.split(":")[0] for line in said.splitlines() if line.startswith("landmark ")] == [
        "landmark F", "landmark F (3)", "landmark F (2)",
    ]  # fmt: skip
    assert read_landmarks(folder / "b.csv").names == found.names
    ours, theirs, _ = paired(found, Landmarks(("F (2)", "F", "F"), np.array([1, 2, 4])))
    assert ours.at.tolist() == [3, 50, 60] and theirs.at.tolist() == [2, 4, 1]
    with pytest.raises(LandmarkError, match="2 landmarks of the source are called 'F' and 1 of the target"):
        paired(found, Landmarks(("F",), np.array([1])))


def test_nothing_to_carry() -> None:
    with pytest.raises(LandmarkError, match="E300: none of the landmarks has a place"):
        carry_landmarks(answer(), Landmarks(("a",), np.array([-1])))


def test_landmarks_in_the_other_frame_are_told_by_name(folder: Path) -> None:
    off = Mesh(SHAPE.vertices * [1, 2, 3] + [50, 20, 0], SHAPE.faces)
    write_mesh(off, folder / "off.ply")
    write_landmarks(folder / "ras.csv", Landmarks(("a", "b"), off.vertices[[3, 60]] * [-1, -1, 1]))
    args = [str(folder / "off.ply"), str(folder / "ras.csv"), str(folder / "b.ply"), "-o", str(folder / "c.csv")]
    done = CliRunner().invoke(main, ["landmarks", *args])
    assert done.exit_code == 1
    assert "E305: landmark 'a' lies" in done.stderr or "E305: landmark 'b' lies" in done.stderr
    assert "with the signs of x and y changed all lie on it" in done.stderr and "--space RAS" in done.stderr
    with pytest.raises(BadLandmarkFile, match="only read; landmarks are written to"):
        write_landmarks(folder / "c.nts", MARKS)


def test_landmarks_of_files_are_taken_as_they_are_and_named_in_errors() -> None:
    theirs = Landmarks(("tail", "nose"), TARGET.vertices[[60, 3]])
    with pytest.raises(LandmarkError, match=r"E303: 1 landmarks are on one surface only \(lost\); .*paired"):
        check_landmarks((MARKS, theirs), SHAPE, TARGET)
    both = check_landmarks((MARKS[MARKS.defined][[0, 2]], theirs), SHAPE, TARGET)
    assert np.allclose(both[0].positions * 3, both[1].positions)
    with pytest.raises(LandmarkError, match="E305: landmark 'tail' lies"):
        check_landmarks(
            (MARKS[[0, 4]], Landmarks(("nose", "tail"), TARGET.vertices[[3, 60]] * [[1], [1.5]])), SHAPE, TARGET
        )
    with pytest.raises(LandmarkError, match="E300: landmarks without a place: unset, gone"):
        check_landmarks((MARKS, np.arange(5)), SHAPE, TARGET)


def test_curves_stay_curves_and_what_is_excluded_stays_so(tmp_path: Path) -> None:
    def point(i: int, **others: object) -> dict[str, object]:
        return {"label": f"P{i}", "position": (-SHAPE.vertices[i] * [1, 1, -1]).tolist(), **others}

    fiducials = [point(0), point(1, selected=False), point(2, positionStatus="missing")]
    curve = [point(3), point(LOST), point(5, positionStatus="undefined"), point(6)]
    lists = [
        {"type": "Fiducial", "coordinateSystem": "RAS", "controlPoints": fiducials},
        {"type": "ROI", "controlPoints": [point(7)]},
        {"type": "ClosedCurve", "name": "rim", "coordinateSystem": "RAS", "controlPoints": curve},
    ]
    schema = "https://raw.githubusercontent.com/slicer/slicer/master/markups-schema-v1.0.3.json#"
    (tmp_path / "a.mrk.json").write_text(json.dumps({"@schema": schema, "markups": lists}))
    given = read_landmarks(tmp_path / "a.mrk.json")
    write_landmarks(tmp_path / "b.mrk.json", carry_landmarks(answer(), given).landmarks())
    first, rim = json.loads((tmp_path / "b.mrk.json").read_text())["markups"]
    assert (first["type"], rim["type"], rim["name"]) == ("Fiducial", "ClosedCurve", "rim")
    assert [one["selected"] for one in first["controlPoints"]] == [True, False, True]
    words = [one["positionStatus"] for one in (*first["controlPoints"], *rim["controlPoints"])]
    assert words == ["defined", "defined", "missing", "defined", "missing", "undefined", "defined"]
    assert np.allclose(rim["controlPoints"][3]["position"], TARGET.vertices[6])
    some = read_landmarks(tmp_path / "b.mrk.json")[np.array([0, 3, 6])]
    assert [(one.kind, one.size) for one in some.lists] == [("Fiducial", 1), ("ClosedCurve", 2)]
    assert given[np.array([6, 0])].lists == ()
    with pytest.raises(BadLandmarkFile, match="more or fewer"):
        Landmarks(NAMES, AT, status=STATUS, selected=(True,))  # type: ignore[arg-type]
