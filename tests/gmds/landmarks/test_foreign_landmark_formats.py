"""What other programs of morphometrics write: several specimens, missing places, scales, comments, decimal commas."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from generated_shapes import bumpy_sphere
from landmark_texts import AVIZO, HEAD, markups, written

from geodesics import Mesh, SurfacePoints, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.errors import LandmarkError
from gmds.landmarks.checking import check_landmarks
from gmds.landmarks.files import BadLandmarkFile, read_landmarks, read_specimens
from gmds.landmarks.files.specimens import belonging_to

PICKED = """<!DOCTYPE PickedPoints>
<PickedPoints>
 <DocumentData><DataFileName name="a.ply"/></DocumentData>
 <point x="1" y="2" z="3" active="1" name="nose &amp; chin"/>
 <point active="0" name="ear" x="0" y="0" z="0"/>
</PickedPoints>
"""
NAN = None


@pytest.mark.parametrize(
    ("name", "text", "names", "places"),
    [
        ("a.pp", PICKED, ("nose & chin", "ear"), [[1, 2, 3], NAN]),
        ("a.landmarkAscii", AVIZO, ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.LANDMARKASCII", AVIZO.replace("Avizo 3D", "AmiraMesh 3D"), ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.nts", '"skull\n1 2L 3 0 DIM=3\nnose ear\n1 2 3\n4 5 6\n', ("nose", "ear"), [[1, 2, 3], [4, 5, 6]]),
        ("a.nts", "1 2 3 1 -999 DIM=3\n1 2 3\n-999 -999 -999\n", ("1", "2"), [[1, 2, 3], NAN]),
        ("a.dta", "1 1L 6 1 9999 dim=3\nskull\n1 2 3 9999 9999 9999\n", ("1", "2"), [[1, 2, 3], NAN]),
        ("a.nts", "1 2L 6 0 dim=3\nnose\near\n1 2 3\n4 5 6\n", ("nose", "ear"), [[1, 2, 3], [4, 5, 6]]),
        ("a.xyz", "1 2 3\n4 5 6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.xyz", "2\n\n1 2 3\n4 5 6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.particles", "1.5 2 3\n", ("1",), [[1.5, 2, 3]]),
        ("a.txt", "# mm\n1,5 2,25 3\nNA NA NA\n", ("1", "2"), [[1.5, 2.25, 3], NAN]),
        ("a.txt", "name x y z\nnose 1 2 3\near 4 5 6\n", ("nose", "ear"), [[1, 2, 3], [4, 5, 6]]),
        ("a.txt", "1 2 3 nose\n4 5 6 ear\n", ("nose", "ear"), [[1, 2, 3], [4, 5, 6]]),
        ("a.txt", "name\tx\ty\tz\nnose\t1\t2\t3\n", ("nose",), [[1, 2, 3]]),
        ("a.txt", "1, 2, 3\n4, 5, 6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.txt", "Version 1.0\n1\nS0 1 2 3\n", ("S0",), [[1, 2, 3]]),
        ("a.csv", "name,x,y,z\nnose,NA,NA,NA\near,4,5,6\n", ("nose", "ear"), [NAN, [4, 5, 6]]),
        ("a.csv", "name,x,y,z\nnose,,,\near,4,5,6\n", ("nose", "ear"), [NAN, [4, 5, 6]]),
        ("a.csv", '"","x","y","z"\n"nose",1,2,3\n', ("nose",), [[1, 2, 3]]),
        ("a.csv", "name;x;y;z\nnose;1,5;-0,25;3\n", ("nose",), [[1.5, -0.25, 3]]),
        ("a.csv", "nose;1,5;-0,25;3,5\n", ("nose",), [[1.5, -0.25, 3.5]]),
        ("a.csv", "ID,X1,Y1,Z1,X2,Y2,Z2\nspec,1,2,3,4,5,6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.csv", "spec;1,5;2;3;4;5;6\n", ("1", "2"), [[1.5, 2, 3], [4, 5, 6]]),
        ("a.txt", "Id\tx1\ty1\tz1\tx2\ty2\tz2\nspec\t1\t2\t3\tNA\tNA\tNA\n", ("1", "2"), [[1, 2, 3], NAN]),
        ("a.json", markups({"label": "F-1", "position": [1, 2, 3]}), ("F-1",), [[1, 2, 3]]),
        ("a.json", '{"markups": [{"controlPoints": [{"label": "F", "position": [1, 2, 3]}]}]}', ("F",), [[1, 2, 3]]),
        ("a.fcsv", HEAD + "1,1,2,3,0,0,0,1,1,1,0,F,,\n2,4,5,6,0,0,0,1,1,1,0,F,,\n", ("F", "F"), [[1, 2, 3], [4, 5, 6]]),
        ("a.pts", "Version 1.0\n2\nS0 1 2 3\nS1 9999 9999 9999\n", ("S0", "S1"), [[1, 2, 3], NAN]),
        ("a.tps", "LM3=2\n1 2 3\nNA NA NA\nID=0\nSCALE=0.5\n", ("1", "2"), [[0.5, 1, 1.5], NAN]),
        ("a.tps", "LM3=2 # two\n1 2 3 # nose\nNA NA NA\nID=a#1\n", ("1", "2"), [[1, 2, 3], NAN]),
        ("a.tps", "# by hand\nCOMMENT=left\nLM3=1\n1,5 2 3\n\nVARIABLES=a\nSCALE=2,0\n", ("1",), [[3, 4, 6]]),
        ("a.tps", "LM=1\n1 2 3\nCURVES=1\nPOINTS=1\n4 5 6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.pts", "1,2,3\n4,5,6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.txt", "//X Y Z Label\n1.0 2.0 3.0 nose\n", ("nose",), [[1, 2, 3]]),
        ("a.txt", "1.0,2.0,3.0,nose\n", ("nose",), [[1, 2, 3]]),
        ("a.csv", "1.0,2.0,3.0,nose\n", ("nose",), [[1, 2, 3]]),
        ("a.csv", "sep=;\nname;x;y;z\nnose;1;2;3\n", ("nose",), [[1, 2, 3]]),
        ("a.csv", "name,x (mm),y [mm],z(mm),\nnose,1,2,3,\n", ("nose",), [[1, 2, 3]]),
        ("a.csv", "ID;1_X;1_Y;1_Z;2_X;2_Y;2_Z\nfox;1;2;3;4;5;6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.csv", "id,LM 1 X,LM 1 Y,LM 1 Z,LM 2 X,LM 2 Y,LM 2 Z\nfox,1,2,3,4,5,6\n", ("LM 1", "LM 2"),
         [[1, 2, 3], [4, 5, 6]]),
        ("a.csv", "id,x1,x2,y1,y2,z1,z2\nfox,1,4,2,5,3,6\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.csv", "id,sex,z1,y1,x1,x2,y2,z2,age\nfox,m,3,2,1,4,5,6,7\n", ("1", "2"), [[1, 2, 3], [4, 5, 6]]),
        ("a.csv", "id,nose.x,nose.y,nose.z,ear.x,ear.y,ear.z\nfox,1,2,3,4,5,6\n", ("nose", "ear"),
         [[1, 2, 3], [4, 5, 6]]),
        ("a.fcsv", "# version = 2\n# label: x,y,z,sel,vis\nP1,-1,-2,3,1,1\n", ("P1",), [[1, 2, 3]]),
        ("a.json", '{"markups": [{"type": "ROI", "controlPoints": [{"position": [0, 0, 0]}]}, '
         '{"controlPoints": [{"label": "F", "position": [1, 2, 3]}]}]}', ("F",), [[1, 2, 3]]),
    ],
)  # fmt: skip
def test_what_others_write(tmp_path: Path, name: str, text: str, names: tuple[str, ...], places: list[object]) -> None:
    for content in (text, "\ufeff" + text.replace("\n", "\r\n"), text.rstrip("\n"), text.encode("utf-16")):
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        found = read_landmarks(tmp_path / name)
        assert found.names == names
        assert [at.tolist() if there else NAN for at, there in zip(found.at, found.defined, strict=True)] == places


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.tps", "LM3=1\n1 2 3\nID=fox\n\nLM3=1\n4 5 6\nID=cow\n"),
        ("a.tps", "LM3=1\n1 2 3\nIMAGE=C:\\scans\\fox.ply\nID=0\nLM3=1\n4 5 6\nIMAGE=cow.ply\nID=1\n"),
        ("a.nts", "1 2L 6 0 dim=3\nfox cow\n1 2 3 7 7 7\n4 5 6 7 7 7\n"),
        ("a.csv", "ID,X1,Y1,Z1,X2,Y2,Z2\nfox,1,2,3,7,7,7\ncow,4,5,6,7,7,7\n"),
        ("a.csv", "specimen,landmark,x,y,z,confidence,valid\nfox,nose,1,2,3,0.5,1\ncow,nose,4,5,6,0.5,1\n"),
    ],
)
def test_several_specimens(tmp_path: Path, name: str, text: str) -> None:
    path = written(tmp_path, name, text)
    assert list(read_specimens(path)) == ["fox", "cow"]
    assert read_landmarks(path, specimen="cow").at[0].tolist() == [4, 5, 6]
    with pytest.raises(BadLandmarkFile, match=r"2 specimens; say which: --specimen NAME.*fox, cow"):
        read_landmarks(path)
    with pytest.raises(BadLandmarkFile, match="no specimen 'dog'; it has fox, cow"):
        read_landmarks(path, specimen="dog")


@pytest.mark.parametrize(
    "header", ["id,x1,x2,y1,y2,z1,w2", "id,x1,y1,z1,x1,y1,z1", "id,a,b,c,d,e,f", "id,x1,y1,z1,x2,y2,q"]
)
def test_titles_that_do_not_say_which_coordinate_is_which_are_refused(tmp_path: Path, header: str) -> None:
    with pytest.raises(BadLandmarkFile, match="a header needs the columns"):
        read_landmarks(written(tmp_path, "a.csv", header + "\nfox,1,2,3,4,5,6\n"))


@pytest.mark.parametrize("absent", ["-1 -1 -1", "-999 -999 -999", "0 0 0"])
def test_a_place_that_stands_for_none_is_named(tmp_path: Path, absent: str) -> None:
    mesh = Mesh(np.add(bumpy_sphere(2).vertices, (7, 5, 3)), bumpy_sphere(2).faces)
    marks = read_landmarks(written(tmp_path, "a.tps", f"LM3=2\n{' '.join(map(str, mesh.vertices[3]))}\n{absent}\n"))
    with pytest.raises(LandmarkError, match=rf"E305: .*all {absent.split()[0]}, as some programs write for one that"):
        check_landmarks((marks, marks), mesh, mesh)


def test_one_surface_has_no_specimens(tmp_path: Path) -> None:
    with pytest.raises(BadLandmarkFile, match="the landmarks of one surface, and there is no specimen 'dog'"):
        read_landmarks(written(tmp_path, "a.xyz", "1 2 3\n"), specimen="dog")


def test_two_sets_of_avizo_are_two_specimens(tmp_path: Path) -> None:
    text = AVIZO.replace("} @1\n", "} @1\nMarkers { float[3] Coordinates2 } @2\n") + "@2\n7 8 9\n1 1 1\n"
    assert read_landmarks(written(tmp_path, "a.landmarkAscii", text), specimen="2").at[0].tolist() == [7, 8, 9]


def test_the_specimen_of_a_mesh_is_found_by_its_name_or_by_its_surface(tmp_path: Path) -> None:
    mesh = bumpy_sphere(2)
    other = Mesh(mesh.vertices * 1.3, mesh.faces)
    rows = [(name, shape.vertices[[3, 60, 90]]) for name, shape in (("fox", mesh), ("cow", other))]
    blocks = ("LM3=3\n" + "\n".join(" ".join(map(repr, at)) for at in p.tolist()) + f"\nID={n}\n" for n, p in rows)
    path = written(tmp_path, "all.tps", "\n".join(blocks))
    specimens = read_specimens(path)
    assert belonging_to(specimens, mesh, Path("FOX.ply")) == ("fox", "it is named as FOX.ply")
    assert belonging_to(specimens, other, Path("scan.ply")) == ("cow", "its landmarks lie on scan.ply")
    assert belonging_to(specimens, Mesh(mesh.vertices * 7, mesh.faces), Path("scan.ply")) is None
    write_mesh(other, tmp_path / "scan.ply")
    identity = SurfacePoints.at_vertices(other, np.arange(other.n_vertices))
    Correspondence.from_points(other, identity).save(tmp_path / "map.npz")
    files = [str(tmp_path / name) for name in ("scan.ply", "all.tps", "scan.ply")]
    args = ["landmarks", *files, "--map", str(tmp_path / "map.npz"), "-o", str(tmp_path / "b.csv")]
    done = CliRunner().invoke(main, args)
    assert done.exit_code == 0, done.output
    assert "all.tps holds 2 specimens; taken is 'cow', as its landmarks lie on scan.ply" in done.stderr
    assert np.allclose(read_landmarks(tmp_path / "b.csv").at, other.vertices[[3, 60, 90]])
    wrong = CliRunner().invoke(main, [*args, "--specimen", "fox"])
    assert wrong.exit_code == 1 and "E305: landmark" in wrong.stderr
