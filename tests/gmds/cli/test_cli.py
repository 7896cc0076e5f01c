"""The command line: exit codes, stdout for results, stderr for the rest, and nothing heavy at import."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere

import gmds
from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.landmarks.pair_files import BadLandmarkFile, read_landmarks
from gmds.maps.point_map import MatchStatus

COMMANDS = main.command_names


def run(*args: object) -> Result:
    return CliRunner().invoke(main, [str(arg) for arg in args])


def arrays(path: Path) -> dict[str, Any]:
    with np.load(path, allow_pickle=False) as archive:
        return dict(archive)


def by_index(source: Mesh, target: Mesh, **options: Any) -> Correspondence:
    """A stand-in for match: vertex i to vertex i."""
    by_index.options = options  # type: ignore[attr-defined]
    if progress := options.get("progress"):
        progress("standing in", 0.5)
    points = SurfacePoints.at_vertices(target, np.arange(source.n_vertices))
    return Correspondence.from_points(source, points, status=MatchStatus.GOOD)


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(vars(gmds), "match", by_index)


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path]:
    shape = bumpy_sphere(2)
    write_mesh(shape, tmp_path / "a.ply")
    write_mesh(Mesh(2 * shape.vertices, shape.faces), tmp_path / "b.ply")
    return tmp_path / "a.ply", tmp_path / "b.ply"


def test_help_names_every_command() -> None:
    result = run("--help")
    assert result.exit_code == 0
    assert all(f"\n  {name} " in result.stdout for name in COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_explains_itself(name: str) -> None:
    result = run(name, "--help")
    assert result.exit_code == 0
    assert "--debug" in result.stdout
    assert len(result.stdout.splitlines()) > 6


def test_help_is_instant_and_imports_no_numpy() -> None:
    code = (
        "import sys\n"
        "from gmds.cli import main\n"
        "try:\n    main(['--help'])\n"
        "except SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'numba', 'igl', 'rich', 'trimesh', 'matplotlib'} & set(sys.modules)\n"
        "sys.exit(f'imports {heavy}' if heavy else 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_match_writes_the_map_and_says_so(stand_in: None, pair: tuple[Path, Path], tmp_path: Path) -> None:
    result = run("match", *pair, "-o", tmp_path / "map.npz", "--json", "--seed", 7)
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert said["status"] == "GOOD"
    assert said["valid"] == said["vertices"] == 162 and said["overlap"] == {"source": 1.0, "target": 1.0}
    assert (arrays(tmp_path / "map.npz")["vertex"] == np.arange(162)).all()
    assert by_index.options["rng"] == 7  # type: ignore[attr-defined]
    assert by_index.options["distance"] is None  # type: ignore[attr-defined]


def test_the_real_match_on_a_pair_of_files(pair: tuple[Path, Path], tmp_path: Path) -> None:
    views = ["--report", tmp_path / "r.html", "--picture", tmp_path / "p.png"]
    result = run("match", *pair, "-o", tmp_path / "map.npz", *views)
    assert result.exit_code == 0, result.output
    assert (arrays(tmp_path / "map.npz")["vertex"] == np.arange(162)).mean() > 0.9
    assert (tmp_path / "r.html").exists() and (tmp_path / "p.png").exists()


def test_match_passes_its_options_on(stand_in: None, pair: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "marks.txt").write_text("0 0\n5, 5  # the nose\n")
    options = ["--landmarks", tmp_path / "marks.txt", "--samples", 40, "--orientation", "any", "--loss", "huber"]
    result = run("match", *pair, "-o", tmp_path / "m.npz", "--metric", "embedded", "--distance", "geodesic", *options)
    assert result.exit_code == 0, result.output
    given = by_index.options  # type: ignore[attr-defined]
    assert given["landmarks"].tolist() == [[0, 0], [5, 5]]
    assert (given["n_samples"], given["orientation"]) == (40, "any")
    assert given["loss"] == gmds.Huber()
    mesh = bumpy_sphere(1)
    field = given["distance"](mesh).field(SurfacePoints.at_vertices(mesh, [0]))
    assert field.shape == (1, 42)


@pytest.mark.parametrize("distance", ["commute-time", "diffusion", "biharmonic"])
def test_distances_by_name(distance: str) -> None:
    from gmds.cli.choices import chosen_distance

    mesh = bumpy_sphere(1)
    build = chosen_distance("scale-invariant", distance)
    assert build is not None
    field = build(mesh).field(SurfacePoints.at_vertices(mesh, [0, 1]))
    assert field.shape == (2, 42)
    assert np.isfinite(field).all()


def test_evaluate_agrees_with_the_truth(stand_in: None, pair: tuple[Path, Path], tmp_path: Path) -> None:
    run("match", *pair, "-o", tmp_path / "map.npz")
    meshes = ["--source", pair[0], "--target", pair[1]]
    n = np.arange(162)
    np.savez(tmp_path / "truth.npz", src=n, gt=n, gt_sym=n[::-1])
    (tmp_path / "truth.vts").write_text("\n".join(str(i + 1) for i in n))
    (tmp_path / "mirror.vts").write_text("\n".join(str(162 - i) for i in n))
    said = json.loads(
        run("evaluate", tmp_path / "map.npz", *meshes, "--truth", tmp_path / "truth.npz", "--json").stdout
    )
    assert said["direct"]["mean"] == 0
    assert said["sym"]["mean"] > 10
    assert (said["best"], said["curve"][0]) == (0, 1)
    truths = ["--truth", tmp_path / "truth.vts", "--symmetric-truth", tmp_path / "mirror.vts"]
    again = json.loads(run("evaluate", tmp_path / "map.npz", *meshes, *truths, "--json").stdout)
    assert again == said
    itself = json.loads(
        run("evaluate", tmp_path / "map.npz", *meshes, "--truth", tmp_path / "map.npz", "--json").stdout
    )
    assert itself["direct"]["mean"] == 0
    human = run("evaluate", tmp_path / "map.npz", *meshes, "--truth", tmp_path / "truth.npz").stdout
    assert "direct:" in human and "within_010 100" in human


def test_benchmark_reports_failed_pairs_by_its_exit_code(stand_in: None, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    (folder / "corres").mkdir(parents=True)
    for name in "ab":
        write_mesh(bumpy_sphere(2), folder / f"{name}.off")
        (folder / "corres" / f"{name}.vts").write_text("\n".join(str(i) for i in range(1, 163)))
    (folder / "test_pairs.txt").write_text("a b\nb a\n")
    result = run("benchmark", folder, "-o", tmp_path / "rows.csv", "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert [row["direct"] for row in said["rows"]] == [0, 0]
    assert said["rows"][0]["sym"] is None
    assert len((tmp_path / "rows.csv").read_text().splitlines()) == 4
    (folder / "test_pairs.txt").write_text("a b\na gone\n")
    result = run("benchmark", folder)
    assert result.exit_code == 3
    assert "1 of 2 pairs failed" in result.stderr
    assert run("benchmark", folder, "--every", 2).exit_code == 0


def test_demo_leaves_everything_needed_to_look_and_to_judge(stand_in: None, tmp_path: Path) -> None:
    result = run("demo", "-o", tmp_path / "demo", "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert said["regular"]["error_x100"] > 1
    names = {path.name for path in (tmp_path / "demo").iterdir()}
    assert names == {"map.npz", "truth.npz", "source.ply", "target.ply", "report.html", "picture.png"}
    folder = tmp_path / "demo"
    meshes = ["--source", folder / "source.ply", "--target", folder / "target.ply"]
    judged = run("evaluate", folder / "map.npz", *meshes, "--truth", folder / "truth.npz", "--json")
    assert json.loads(judged.stdout)["direct"]["mean"] == pytest.approx(said["match"]["error_x100"])


@pytest.mark.parametrize(
    ("args", "code"),
    [
        (["match", "missing.off", "other.off"], 1),
        (["benchmark", "nowhere"], 1),
        (["match"], 2),
        (["match", "a", "b", "--orientation", "sideways"], 2),
        (["nonsense"], 2),
        (["--nonsense"], 2),
        (["--version"], 0),
    ],
)
def test_exit_codes(args: list[str], code: int) -> None:
    result = run(*args)
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.output
    assert code == 0 or (result.stdout == "" and result.stderr.strip())


def test_a_bad_mesh_is_one_line_and_debug_shows_more(tmp_path: Path, stand_in: None) -> None:
    bad = tmp_path / "bad.off"
    bad.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    result = run("match", bad, bad)
    assert result.exit_code == 1
    assert "E105" in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    for args in (["--debug", "match", bad, bad], ["match", bad, bad, "--debug"]):
        assert isinstance(run(*args).exception, ValueError)


def test_an_internal_error_is_admitted(pair: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise KeyError("lost")

    monkeypatch.setitem(vars(gmds), "match", broken)
    result = run("match", *pair)
    assert result.exit_code == 1
    assert "internal error: KeyError" in result.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupting_ends_with_130(number: signal.Signals, tmp_path: Path) -> None:
    code = (
        "import gmds, signal, time\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # a parent in the background ignores it
        "from gmds.cli import main\n"
        "def match(*a, **k):\n    print('ready', flush=True)\n    time.sleep(60)\n"
        "gmds.match = match\n"
        "main(['match', 'a.off', 'a.off', '-o', 'm.npz'])\n"
    )
    write_mesh(bumpy_sphere(0), tmp_path / "a.off")
    environment = {**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])}
    child = subprocess.Popen(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    started = time.monotonic()
    os.kill(child.pid, number)
    try:
        _, errors = child.communicate(timeout=10)
    finally:
        child.kill()
    assert child.returncode == 130
    assert time.monotonic() - started < 2
    assert "Traceback" not in errors
    assert not (tmp_path / "m.npz").exists()


def test_check_tells_what_is_wrong(tmp_path: Path) -> None:
    (tmp_path / "m.off").write_text("OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n9 9 9\n1 1 0\n3 0 1 2\n3 0 1 2\n")
    result = run("check", tmp_path / "m.off")
    assert result.exit_code == 0
    assert "W201" in result.stdout and "W215" in result.stdout
    said = json.loads(run("check", tmp_path / "m.off", "--json").stdout)
    assert (said["vertices"], said["faces"]) == (5, 2)
    found = {note["code"]: (note["count"], note["indices"], note["repair"]) for note in said["notes"]}
    assert found["W201"] == (1, [1], "yes")
    assert found["W215"] == (2, [3, 4], "yes") and found["W218"][2] is None
    lines = [line.split() for line in result.stdout.splitlines()]
    assert ["W201", "warning", "1", "yes", "1", "faces", "repeat", "an", "earlier", "face", "1"] in lines


def test_repair_drops_what_is_wrong_and_says_where_the_rest_was(tmp_path: Path) -> None:
    (tmp_path / "m.off").write_text("OFF\n5 3 0\n9 9 9\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 1 2 3\n3 1 2 3\n3 2 3 4\n")
    result = run("repair", tmp_path / "m.off", "-o", tmp_path / "n.off", "--maps", tmp_path / "maps.npz", "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert (said["vertices"], said["faces"]) == (4, 2)
    assert {note["code"] for note in said["notes"]} == {"W201", "W204", "W215"}
    maps = arrays(tmp_path / "maps.npz")
    assert maps["vertex"].tolist() == [1, 2, 3, 4]
    assert maps["face"].tolist() == [0, 2]
    assert maps["new_vertex"].tolist() == [-1, 0, 1, 2, 3] and maps["new_face"].tolist() == [0, -1, 1]


def test_repair_turns_faces_when_that_is_asked_for(tmp_path: Path) -> None:
    (tmp_path / "m.off").write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 2 1 3\n")
    result = run("repair", tmp_path / "m.off", "-o", tmp_path / "n.off", "--turn")
    assert result.exit_code == 0, result.output
    assert read_mesh(tmp_path / "n.off").faces.tolist() == [[0, 2, 1], [2, 3, 1]]


def test_repair_reduces(tmp_path: Path) -> None:
    shape = bumpy_sphere(3)
    write_mesh(shape, tmp_path / "m.ply")
    result = run(
        "repair", tmp_path / "m.ply", "-o", tmp_path / "n.ply", "--decimate", 300, "--maps", tmp_path / "maps.npz"
    )
    assert result.exit_code == 0, result.output
    reduced = read_mesh(tmp_path / "n.ply")
    assert abs(reduced.n_faces - 300) < 10
    vertex = arrays(tmp_path / "maps.npz")["vertex"]
    assert np.median(np.linalg.norm(reduced.vertices - shape.vertices[vertex], axis=1)) < 0.2
    assert run("repair", tmp_path / "m.ply", "-o", "x.off", "--remesh", 99, "--maps", "y.npz").exit_code == 2


def test_landmark_files(tmp_path: Path) -> None:
    path = tmp_path / "marks.txt"
    path.write_text("﻿# x y z on both\n0 0 1; 2.5 1e-3 -7\n")
    here, there = read_landmarks(path)
    assert here.tolist() == [[0, 0, 1]]
    assert there.tolist() == [[2.5, 1e-3, -7]]
    path.write_text("3 4\r\n\r\n5,6")
    assert np.asarray(read_landmarks(path)).tolist() == [[3, 4], [5, 6]]
    path.write_text("3 0.5 0.5 0 7 1 0 0")
    assert [side.tolist() for side in read_landmarks(path)] == [[[3, 0.5, 0.5, 0]], [[7, 1, 0, 0]]]
    path.write_text("3 4 0.1\n5 6 0")
    soft = read_landmarks(path)
    assert soft.landmarks.tolist() == [[3, 4], [5, 6]] and soft.tolerance.tolist() == [0.1, 0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no landmarks"),
        ("# nothing\n", "no landmarks"),
        ("1 2 3 4\n", "line 1: 4 entries"),
        ("name,vertex\nnose,3\n", "line 1: 'name' is not a number.*one surface alone.*--landmarks A --landmarks B"),
        ("nose 3\n", "line 1: 'nose' is not a number.*one surface alone"),
        ("0 0 1 2\n", "4 entries.*one surface alone"),
        ("1 2 x\n", "'x' is not a number"),
        ("0.5 1 0 0 3 1 0 0\n", "'0.5' is not a whole number"),
        ("1 2\n\n3\n", "line 3: 1 entries"),
        ("1 2.5\n", "line 1: '2.5' is not a whole number"),
        ("0 0 0 1 1 nan\n", "'nan' is not a number"),
        ("0 0 0 1 1 1e999\n", "too large"),
        ("1 " + "9" * 20, "not a whole number"),
        ("1_0 2", "not a whole number"),
    ],
)
def test_bad_landmark_files_name_the_line(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "marks.txt").write_text(text)
    with pytest.raises(BadLandmarkFile, match=message):
        read_landmarks(tmp_path / "marks.txt")


def test_no_candidates_are_said_to_be_none(stand_in: None, pair: tuple[Path, Path], tmp_path: Path) -> None:
    result = run("match", *pair, "-o", tmp_path / "map.npz")
    assert [line.split() for line in result.stdout.splitlines()][-1] == ["candidates:", "none"]


def test_landmark_files_are_text(tmp_path: Path) -> None:
    (tmp_path / "marks.txt").write_bytes(b"\xff\xfe1 2")
    with pytest.raises(BadLandmarkFile, match="UTF-8"):
        read_landmarks(tmp_path / "marks.txt")
