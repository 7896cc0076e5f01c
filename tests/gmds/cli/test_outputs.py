"""Outputs: none destroys another or an input, what cannot be written is told first, logs and JSON are for machines."""

from __future__ import annotations

import errno
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere

import gmds
from geodesics import Mesh, SurfacePoints, write_mesh
from geodesics.io import atomic_write
from gmds.cli import main, output
from gmds.correspondence import Correspondence

SHAPE = bumpy_sphere(2)


def run(*args: object) -> Result:
    return CliRunner().invoke(main, [str(arg) for arg in args])


@pytest.fixture
def pair(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    def match(*_: Any, **__: Any) -> Correspondence:
        raise AssertionError("nothing may be computed")

    monkeypatch.setitem(vars(gmds), "match", match)
    write_mesh(SHAPE, tmp_path / "a.ply")
    write_mesh(Mesh(2 * SHAPE.vertices, SHAPE.faces), tmp_path / "b.ply")
    return tmp_path / "a.ply", tmp_path / "b.ply"


def test_two_outputs_are_two_files(pair: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "there").symlink_to(tmp_path)
    for other in (tmp_path / "m.npz", tmp_path / "there" / "m.npz", tmp_path / "." / "m.npz"):
        done = run("match", *pair, "-o", tmp_path / "m.npz", "--report", other)
        assert done.exit_code == 2 and "--output and --report both write" in done.stderr, done.output
    done = run("repair", pair[0], "-o", tmp_path / "c.ply", "--maps", tmp_path / "c.ply")
    assert done.exit_code == 2 and "both write" in done.stderr
    assert "both write" not in run("match", *pair, "-o", "/dev/null", "--report", "/dev/null").stderr
    assert not (tmp_path / "m.npz").exists() and not (tmp_path / "c.ply").exists()


@pytest.mark.parametrize(
    "args",
    [
        ("repair", "a.ply", "-o", "a.ply"),
        ("repair", "a.ply", "-o", "link.ply"),
        ("repair", "a.ply", "-o", "c.ply", "--maps", "a.ply"),
        ("deform", "a.ply", "noise", "-o", "a.ply"),
        ("match", "a.ply", "b.ply", "-o", "m.npz", "--report", "b.ply"),
        ("landmarks", "a.ply", "a.csv", "b.ply", "-o", "a.csv"),
        ("repair", "t.vert", "-o", "t.tri"),
        ("transfer", "m.npz", "--source", "a.ply", "--target", "b.ply", "--texture", "c.png", "-o", "c.obj"),
        ("transfer", "m.npz", "--source", "a.ply", "--target", "b.ply", "--values", "a.csv", "-o", "a.csv"),
    ],
)
def test_no_output_is_an_input(
    pair: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, args: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    os.link(pair[0], "link.ply")
    Path("a.csv").write_text("name,vertex\na,3\n")
    Path("c.png").touch()
    write_mesh(SHAPE, "t.vert")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    done = run(*args)
    assert done.exit_code == 2 and "would overwrite" in done.stderr and "which is read" in done.stderr, done.output
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_folder_that_is_read_only_is_found_out_first(
    pair: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: Any, **__: Any) -> None:
        raise OSError(errno.EROFS, "Read-only file system", "/somewhere/.gmds-1234.tmp")

    monkeypatch.setattr("tempfile.TemporaryFile", refused)
    for option in ("-o", "--report", "--picture"):
        done = run("match", *pair, option, tmp_path / ("x.png" if option == "--picture" else "x.npz"))
        assert done.exit_code == 2 and "cannot be written to the folder" in done.stderr, done.output
        assert "Read-only file system" in done.stderr and ".gmds-" not in done.stderr


def test_errors_of_writing_name_the_file_that_was_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(path: Path, *_: Any) -> int:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    monkeypatch.setattr(os, "open", refused)
    with pytest.raises(PermissionError) as caught, atomic_write(tmp_path / "a.bin"):
        raise AssertionError
    monkeypatch.undo()
    assert caught.value.filename == str(tmp_path / "a.bin")


def test_a_missing_file_has_a_code(tmp_path: Path) -> None:
    done = run("check", tmp_path / "none.ply")
    assert done.exit_code == 1 and done.stderr == f"gmds: E202: {tmp_path / 'none.ply'}: No such file or directory\n"
    missing = run("landmarks", tmp_path / "a.ply", tmp_path / "a.csv", "b", "-o", tmp_path / "c.csv")
    assert missing.exit_code == 1 and missing.stderr.startswith("gmds: E202: ")
    for command in ("compare", "batch"):
        done = run(command, tmp_path / "none", "-o", tmp_path / "out")
        assert done.exit_code == 1 and done.stderr.startswith("gmds: E202: "), done.stderr
    (tmp_path / "a.csv").mkdir()
    write_mesh(SHAPE, tmp_path / "a.ply")
    done = run("landmarks", tmp_path / "a.ply", tmp_path / "a.csv", tmp_path / "a.ply", "-o", tmp_path / "c.csv")
    assert done.stderr == f"gmds: E202: {tmp_path / 'a.csv'}: it is not a regular file\n"


def test_a_batch_tells_how_far_it_is_where_there_is_no_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with output.progress_bar("batch", remaining=True) as progress:
        progress("measured a", 0.05)
        progress("measured b", 0.1)
        progress("3 of 3 pairs", 1.0)
    first, last = capsys.readouterr().err.splitlines()
    assert first.startswith("batch: measured a, 5 %, after 0 s") and last.startswith("batch: 3 of 3 pairs, 100 %")
    with output.progress_bar("match") as progress:
        progress("a", 0.5)
    assert capsys.readouterr().err == ""


def test_json_has_numbers(pair: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def by_index(source: Mesh, target: Mesh, **_: Any) -> Correspondence:
        points = SurfacePoints.at_vertices(target, np.arange(source.n_vertices))
        return Correspondence.from_points(source, points)

    monkeypatch.setitem(vars(gmds), "match", by_index)
    told = json.loads(run("match", *pair, "-o", tmp_path / "m.npz", "--json").stdout)
    assert told["valid"] == told["vertices"] == 162 and told["overlap"] == {"source": 1.0, "target": 1.0}
    plain = run("match", *pair, "-o", tmp_path / "m.npz").stdout
    assert "162 of 162" in plain and "100.0% of the source, 100.0% of the target" in plain


def test_signs_that_no_font_has_make_no_noise(tmp_path: Path, recwarn: pytest.WarningsRecorder) -> None:
    write_mesh(SHAPE, tmp_path / "a.ply")
    identity = SurfacePoints.at_vertices(SHAPE, np.arange(162))
    answer = Correspondence.from_points(SHAPE, identity)
    answer.picture(tmp_path / "a.png", title="股骨 \U00010380")
    assert not [str(warning.message) for warning in recwarn if "Glyph" in str(warning.message)]


def test_of_a_list_every_entry_has_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    output.emit(
        {"name": "x", "candidates": [{"stress": 0.1, "orientation": -0.5}, {"stress": 0.2, "orientation": 1.0}]}, False
    )
    assert capsys.readouterr().out.splitlines() == [
        "name:       x",
        "candidates: stress 0.1, orientation -0.5",
        "            stress 0.2, orientation 1",
    ]
    output.emit({"sizes": [1, 2], "pairs": [["a", "b"], ["c", "d"]], "none": []}, False)
    assert capsys.readouterr().out.splitlines() == ["sizes: 1, 2", "pairs: a, b", "       c, d", "none:  none"]
