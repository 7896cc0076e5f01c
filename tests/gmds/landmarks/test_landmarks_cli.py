"""Landmarks on the command line: given to match, and carried from one mesh to another."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere

import gmds
from geodesics import Mesh, SurfacePoints, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.errors import LandmarkError, MapError
from gmds.landmarks.checking import place_landmarks
from gmds.landmarks.files import Landmarks, read_landmarks, write_landmarks
from gmds.landmarks.transfer import carry_landmarks, landmark_errors
from gmds.maps.images import image
from gmds.maps.made_with import landmarks_of
from gmds.maps.npz_format import read_meta
from gmds.maps.point_map import MatchStatus

SHAPE = bumpy_sphere(2)
N = SHAPE.n_vertices
LOST = 40  # a vertex of the source without a counterpart
TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
TARGET = Mesh(2 * SHAPE.vertices @ TURN.T, SHAPE.faces)
GIVEN: dict[str, Any] = {}


def answer_of(source: Mesh, target: Mesh, **options: Any) -> Correspondence:
    """Vertex i to vertex i; vertex `LOST` has no counterpart, and confidence falls from 1 to 0 over the vertices."""
    GIVEN.update(options)
    valid = np.arange(N) != LOST
    points = SurfacePoints.at_vertices(target, np.arange(N))
    confidence = np.linspace(1, 0, N)
    return Correspondence.from_points(source, points, valid=valid, confidence=confidence, status=MatchStatus.GOOD)


def run(*args: object) -> Result:
    return CliRunner().invoke(main, [str(arg) for arg in args])


@pytest.fixture
def pair(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    GIVEN.clear()
    monkeypatch.setitem(vars(gmds), "match", answer_of)
    write_mesh(SHAPE, tmp_path / "a.ply")
    write_mesh(TARGET, tmp_path / "b.ply")
    return tmp_path / "a.ply", tmp_path / "b.ply"


def test_landmarks_given_to_match_are_soft_when_that_is_said(pair: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "m.txt").write_text("3 3\n50 50\n")
    command = ["match", *pair, "-o", tmp_path / "m.npz", "--landmarks", tmp_path / "m.txt"]
    assert run(*command).exit_code == 0 and isinstance(GIVEN["landmarks"], np.ndarray)
    assert run(*command, "--tolerance", 0.1).exit_code == 0
    assert GIVEN["landmarks"].tolerance == 0.1 and GIVEN["landmarks"].landmarks.tolist() == [[3, 3], [50, 50]]
    (tmp_path / "m.txt").write_text("3 3 0.2\n50 50 0\n")
    assert run(*command, "--tolerance", 0.1).exit_code == 0
    assert GIVEN["landmarks"].tolerance.tolist() == [0.2, 0]


def test_a_map_gives_the_landmarks_it_was_made_with_and_says_what_moved(tmp_path: Path) -> None:
    write_mesh(SHAPE, tmp_path / "a.ply")
    places = " ".join(map(str, SHAPE.vertices[50] * 1.01))
    other = " ".join(map(str, SHAPE.vertices[3]))
    (tmp_path / "m.txt").write_text(f"{places} {places} 0.1\n{other} {other} 0\n")
    meshes = [tmp_path / "a.ply"] * 2
    first = run("match", *meshes, "-o", tmp_path / "1.npz", "--landmarks", tmp_path / "m.txt")
    assert first.exit_code == 0 and "W301: 1 landmarks of the source moved to its surface, by up to" in first.stderr
    again = run("match", *meshes, "-o", tmp_path / "2.npz", "--config", tmp_path / "1.npz")
    assert again.exit_code == 0, again.output
    made = [read_meta(tmp_path / name)["parameters"]["landmarks"] for name in ("1.npz", "2.npz")]
    assert made[0]["tolerance"] == made[1]["tolerance"] == [0.1, 0.0]
    assert made[0]["source"]["face"] == made[1]["source"]["face"]
    with np.load(tmp_path / "1.npz") as a, np.load(tmp_path / "2.npz") as b:
        assert all(np.array_equal(a[name], b[name]) for name in ("face", "barycentric"))
    Correspondence.from_points(SHAPE, SurfacePoints.at_vertices(SHAPE, np.arange(N))).save(tmp_path / "none.npz")
    none = run("match", *meshes, "--landmarks", tmp_path / "none.npz")
    assert none.exit_code == 1 and "made without landmarks" in none.stderr


def marks(*vertices: int) -> Landmarks:
    return Landmarks(tuple(f"v{i}" for i in vertices), SHAPE.vertices[list(vertices)])


@pytest.mark.parametrize("ending", [".csv", ".mrk.json", ".fcsv", ".pts", ".tps"])
def test_positions_arrive_where_the_map_sends_them(pair: tuple[Path, Path], tmp_path: Path, ending: str) -> None:
    write_landmarks(tmp_path / f"a{ending}", marks(3, 50, 11))
    out = tmp_path / f"b{ending}"
    result = run("landmarks", pair[0], tmp_path / f"a{ending}", pair[1], "-o", out, "--json")
    assert result.exit_code == 0, result.output
    assert np.allclose(read_landmarks(out).at, TARGET.vertices[[3, 50, 11]], atol=1e-9)
    said = json.loads(result.stdout)
    assert [row["vertex"] for row in said["carried"]] == [3, 50, 11]
    assert [row["name"] for row in said["carried"]] == (["1", "2", "3"] if ending == ".tps" else ["v3", "v50", "v11"])
    expected = [1 - i / (N - 1) for i in (3, 50, 11)]
    assert np.allclose([row["confidence"] for row in said["carried"]], expected)


def test_the_frame_of_the_meshes(pair: tuple[Path, Path], tmp_path: Path) -> None:
    a, b = tmp_path / "a.mrk.json", tmp_path / "b.mrk.json"
    write_landmarks(a, Landmarks(("v3",), SHAPE.vertices[[3]] * [-1, -1, 1]), "RAS")
    assert run("landmarks", pair[0], a, pair[1], "-o", b).exit_code == 0
    assert np.allclose(read_landmarks(b).at, TARGET.vertices[[3]])
    assert json.loads(b.read_text())["markups"][0]["coordinateSystem"] == "LPS"
    write_landmarks(a, marks(3), "RAS")
    assert run("landmarks", pair[0], a, pair[1], "-o", b, "--space", "RAS").exit_code == 0
    assert json.loads(b.read_text())["markups"][0]["coordinateSystem"] == "RAS"
    assert np.allclose(read_landmarks(b, "RAS").at, TARGET.vertices[[3]])


def test_vertices_in_and_out_and_a_map_from_a_file(pair: tuple[Path, Path], tmp_path: Path) -> None:
    from geodesics import read_mesh

    answer_of(read_mesh(pair[0]), read_mesh(pair[1])).save(tmp_path / "map.npz")
    GIVEN.clear()
    (tmp_path / "a.vts").write_text("4\n8\n")
    args = ["landmarks", pair[0], tmp_path / "a.vts", pair[1], "-o", tmp_path / "b.vts"]
    assert run(*args, "--map", tmp_path / "map.npz").exit_code == 0
    assert (tmp_path / "b.vts").read_text() == "4\n8\n"
    assert not GIVEN, "nothing was matched"
    assert run(*args, "--seed", 5).exit_code == 0
    assert GIVEN["rng"] == 5


def test_points_without_a_counterpart_are_flagged(pair: tuple[Path, Path], tmp_path: Path) -> None:
    write_landmarks(tmp_path / "a.csv", marks(LOST, 5, N - 1))
    result = run("landmarks", pair[0], tmp_path / "a.csv", pair[1], "-o", tmp_path / "b.csv", "--json")
    said = json.loads(result.stdout)["carried"]
    assert [row["valid"] for row in said] == [False, True, True]
    assert said[0]["confidence"] == 0 and said[2]["confidence"] == 0
    assert "without a counterpart on the target: v40" in result.stderr
    lines = (tmp_path / "b.csv").read_text().splitlines()
    assert lines[0] == "name,x,y,z,moved,confidence,valid"
    assert lines[1].endswith(",0.0,0.0,0") and lines[2].endswith(",0.0,0.9689,1")
    human = run("landmarks", pair[0], tmp_path / "a.csv", pair[1], "-o", tmp_path / "b.csv").stdout
    assert "v40:" in human and "valid False" in human


def test_distance_moved_is_told(pair: tuple[Path, Path], tmp_path: Path) -> None:
    face = SHAPE.vertices[SHAPE.faces[7]]
    normal = np.cross(face[1] - face[0], face[2] - face[0])
    off = face.mean(axis=0) + 0.01 * normal / np.linalg.norm(normal)
    write_landmarks(tmp_path / "a.csv", Landmarks(("off",), off[None]))
    result = run("landmarks", pair[0], tmp_path / "a.csv", pair[1], "-o", tmp_path / "b.csv", "--json")
    row = json.loads(result.stdout)["carried"][0]
    assert row["moved"] == pytest.approx(0.01)
    titles, told = ((tmp_path / "b.csv").read_text().splitlines()[i].split(",") for i in (0, 1))
    assert told[titles.index("moved")] == "0.01"
    assert run("landmarks", pair[0], tmp_path / "a.csv", pair[1], "-o", tmp_path / "b.mrk.json").exit_code == 0
    assert '"description": "moved 0.01, confidence 0.' in (tmp_path / "b.mrk.json").read_text()
    assert np.allclose(row["position"], TARGET.vertices[SHAPE.faces[7]].mean(axis=0))


@pytest.mark.parametrize(
    ("text", "output", "message"),
    [
        ("name,x,y,z\na,9,9,9\n", "b.csv", "E305"),
        ("name,vertex\na,99999\n", "b.csv", "E301"),
        ("name,x,y,z\na,9,9\n", "b.csv", "a.csv, line 2"),
        ("name,vertex\na,9\n", "b.docx", "files that end in"),
    ],
)
def test_mistakes_are_told_before_the_matching(
    pair: tuple[Path, Path], tmp_path: Path, text: str, output: str, message: str
) -> None:
    (tmp_path / "a.csv").write_text(text)
    result = run("landmarks", pair[0], tmp_path / "a.csv", pair[1], "-o", tmp_path / output)
    assert result.exit_code == 1
    assert message in result.stderr
    assert not GIVEN and not (tmp_path / output).exists()


def test_match_takes_a_file_for_each_surface(pair: tuple[Path, Path], tmp_path: Path) -> None:
    write_landmarks(tmp_path / "a.mrk.json", marks(3, 50, 11))
    (tmp_path / "b.csv").write_text("name,vertex\nv11,11\nelse,4\nv3,3\n")
    both = ["--landmarks", tmp_path / "a.mrk.json", "--landmarks", tmp_path / "b.csv"]
    result = run("match", *pair, "-o", tmp_path / "m.npz", *both)
    assert result.exit_code == 0, result.output
    on_source, on_target = GIVEN["landmarks"]
    assert (on_source.at == SHAPE.vertices[[3, 11]]).all() and on_target.at.tolist() == [3, 11]
    assert on_source.names == on_target.names == ("v3", "v11")
    assert "2 landmarks are on one surface only and are not used: v50, else" in result.stderr
    assert run("match", *pair, *both, "--landmarks", tmp_path / "b.csv").exit_code == 2


def test_the_real_match_and_the_real_landmarks(tmp_path: Path) -> None:
    write_mesh(SHAPE, tmp_path / "a.ply")
    write_mesh(TARGET, tmp_path / "b.ply")
    write_landmarks(tmp_path / "a.fcsv", marks(3, 50, 11, 90))
    out = tmp_path / "b.fcsv"
    result = run("landmarks", tmp_path / "a.ply", tmp_path / "a.fcsv", tmp_path / "b.ply", "-o", out)
    assert result.exit_code == 0, result.output
    off = np.linalg.norm(read_landmarks(out).at - TARGET.vertices[[3, 50, 11, 90]], axis=1)
    assert np.median(off) < 0.1 * np.sqrt(TARGET.area)


def test_images_inside_faces_follow_the_map() -> None:
    answer = answer_of(SHAPE, TARGET)
    rng = np.random.default_rng(0)
    points = SurfacePoints(SHAPE, rng.integers(0, SHAPE.n_faces, 50), rng.dirichlet(np.ones(3), 50))
    found, valid, distortion = image(answer, points)
    assert np.allclose(found.positions, 2 * points.positions @ TURN.T, atol=1e-9)
    assert (valid == ~(SHAPE.faces[points.face] == LOST).any(axis=1)).all()
    assert np.allclose(distortion, points.interpolate(answer.distortion))
    with pytest.raises(MapError, match="very mesh"):
        image(answer, found)


def test_in_python_vertices_are_not_moved() -> None:
    carried = carry_landmarks(answer_of(SHAPE, TARGET), Landmarks(("a", "b"), np.array([1, LOST])))
    assert carried.moved.tolist() == [0, 0]
    assert carried.landmarks(vertices=True).at.tolist() == [1, -1] and carried.valid.tolist() == [True, False]
    with pytest.raises(LandmarkError, match="E302"):
        carry_landmarks(answer_of(SHAPE, TARGET), Landmarks(("a", "b"), np.array([1, 1])))


def test_errors_of_landmarks_whose_places_are_known(pair: tuple[Path, Path], tmp_path: Path) -> None:
    """By name, in another order; one is off by an edge, one not known, and of one the map has no counterpart."""
    source, target = pair
    face = TARGET.faces[(TARGET.faces == 7).any(axis=1)][0]
    neighbour = int(face[face != 7][0])
    write_landmarks(tmp_path / "a.csv", Landmarks(("nose", "lost", "tail", "ear"), np.array([3, LOST, 7, 11])))
    true = Landmarks(("ear", "tail", "lost"), TARGET.vertices[[11, neighbour, LOST]])
    write_landmarks(tmp_path / "b.csv", true)
    command = ("landmarks", source, tmp_path / "a.csv", target, "--known", tmp_path / "b.csv", "--json")
    result = run(*command, "-o", tmp_path / "out.csv")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    errors = [row["error"] for row in told["carried"]]
    edge = np.linalg.norm(TARGET.vertices[neighbour] - TARGET.vertices[7]) / np.sqrt(TARGET.area)
    assert errors[:2] == [None, None] and errors[2] == pytest.approx(edge) and errors[3] == pytest.approx(0, abs=1e-9)
    assert told["mean_error_x100"] == pytest.approx(50 * edge)
    lines = (tmp_path / "out.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].endswith("error") and [line.split(",")[-1] for line in lines[1:3]] == ["NA", "NA"]
    write_landmarks(tmp_path / "c.csv", Landmarks(("snout",), TARGET.vertices[[3]]))
    GIVEN.clear()
    other = run(*command[:5], tmp_path / "c.csv", "-o", tmp_path / "no.csv")
    assert other.exit_code != 0 and "E303" in other.stderr and not GIVEN, "before anything is matched"


def test_without_names_errors_go_by_order() -> None:
    answer = answer_of(SHAPE, TARGET)
    carried = carry_landmarks(answer, Landmarks(("1", "2"), np.array([5, 9]), named=False))
    true = Landmarks(("1", "2"), TARGET.vertices[[5, 9]], named=False)
    assert landmark_errors(carried, true) == pytest.approx([0, 0], abs=1e-9)


def test_a_map_keeps_the_names_of_the_landmarks_it_was_made_with(pair: tuple[Path, Path], tmp_path: Path) -> None:
    """From two files that name theirs, in any order, to the page; without names they are numbered."""
    write_landmarks(tmp_path / "a.csv", Landmarks(("nose", "tail"), np.array([3, 50])))
    write_landmarks(tmp_path / "b.csv", Landmarks(("tail", "nose"), TARGET.vertices[[50, 3]]))
    files = ("--landmarks", tmp_path / "a.csv", "--landmarks", tmp_path / "b.csv")
    assert run("match", *pair, "-o", tmp_path / "m.npz", *files).exit_code == 0
    plain = Correspondence.from_points(SHAPE, SurfacePoints.at_vertices(TARGET, np.arange(N)))
    for given, names in ((GIVEN["landmarks"], ["nose", "tail"]), ([[3, 3], [50, 50]], ["1", "2"])):
        answer, _ = place_landmarks(given, SHAPE, TARGET).applied(plain)
        found = landmarks_of(answer)
        assert [name for name, _, _ in found] == names
        assert np.allclose([there for _, _, there in found], TARGET.vertices[[3, 50]])
