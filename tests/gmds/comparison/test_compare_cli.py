"""gmds compare: tables, a picture and a page; resumed where it stopped; a bad mesh is named and left out."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere, ellipsoid, torus

from geodesics import Mesh, write_mesh
from gmds.cli import main
from gmds.comparison import distortion, profiles
from gmds.deformations import similarity


def run(*args: object) -> Result:
    return CliRunner().invoke(main, ["compare", *map(str, args)])


def table(path: Path) -> list[list[str]]:
    with path.open(newline="") as stream:
        return list(csv.reader(stream))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shapes")
    even = torus(12, 24)
    swell = 1 + 0.3 * np.tanh(even.vertices @ (1, 0.4, 0.3))  # so that no turn leaves it as it is
    ring = Mesh(even.vertices * swell[:, None], even.faces)
    for i in range(2):
        write_mesh(similarity(bumpy_sphere(2, seed=3), largest_scale=4, rng=i)[0], folder / f"blob{i}.ply")
        write_mesh(similarity(ring, largest_scale=4, rng=i)[0], folder / f"ring{i}.off")
    write_mesh(ellipsoid(2), folder / "egg.vert")  # and egg.tri
    (folder / "notes.txt").write_text("not a mesh")
    return folder


@pytest.fixture(scope="module")
def done(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    out = tmp_path_factory.mktemp("compared")
    result = run(folder, "-o", out, "--embed", 1, "--json")
    assert result.exit_code == 0, result.output
    return out, json.loads(result.stdout)


def test_tables_agree_with_each_other(done: tuple[Path, dict]) -> None:
    out, said = done
    names = ["blob0", "blob1", "egg", "ring0", "ring1"]
    rows = table(out / "matrix.csv")
    assert rows[0] == ["", *names] and [row[0] for row in rows[1:]] == names
    matrix = np.array([[float(x) for x in row[1:]] for row in rows[1:]])
    assert np.array_equal(matrix, matrix.T) and (np.diag(matrix) == 0).all()
    assert matrix[0, 1] < 1e-3 and matrix[3, 4] < 1e-3 < 2e-2 < matrix[0, 3]  # congruent, and not
    assert (said["shapes"], said["pairs"], said["left_out"]) == (5, 10, [])
    assert said["nearest_has_same_name"] == 1
    near = table(out / "nearest.csv")
    assert near[0] == ["shape", "rank", "other", "bound", "distortion"] and len(near) == 1 + 5 * 4
    first = {row[0]: row for row in near[1:] if row[1] == "1"}
    assert first["ring0"][2] == "ring1" and float(first["ring0"][4]) < 1e-2
    assert said["embedded_pairs"] == len({frozenset((r[0], r[2])) for r in near[1:] if r[4]}) == 3
    merges = table(out / "tree.csv")[1:]
    assert len(merges) == 4 and merges[-1][3] == "5"
    assert [row[0] for row in table(out / "map.csv")[1:]] == names


def test_the_page_is_one_file_without_scripts_that_names_every_shape(done: tuple[Path, dict]) -> None:
    page = (done[0] / "compare.html").read_text()
    assert "<svg" in page and "<script" not in page and "Content-Security-Policy" in page
    assert not re.search(r'(src|href)="(?!data:|#)', page.replace("xlink:", ""))
    assert all(page.count(name) >= 2 for name in ("blob0", "egg", "ring1"))
    assert "moves sideways" in page  # shown where the screen is narrower than the picture
    assert (done[0] / "compare.png").read_bytes().startswith(b"\x89PNG")


def test_nothing_is_computed_twice(folder: Path, done: tuple[Path, dict], monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> None:
        raise AssertionError("computed again")

    monkeypatch.setattr(profiles, "distance_profile", never)
    monkeypatch.setattr(distortion, "embedding_distortion", never)
    before = (done[0] / "matrix.csv").read_bytes()
    assert run(folder, "-o", done[0], "--embed", 1).exit_code == 0
    assert (done[0] / "matrix.csv").read_bytes() == before


def test_what_was_cut_short_or_changed_is_computed_again(folder: Path, done: tuple[Path, dict], tmp_path: Path) -> None:
    out, shapes = tmp_path / "out", tmp_path / "shapes"
    shutil.copytree(done[0], out)
    shutil.copytree(folder, shapes)
    kept = out / "kept"
    lines = (kept / "distortions.csv").read_text()
    (kept / "distortions.csv").write_text(lines[:-9])
    (kept / "profiles" / "egg.npz").write_bytes(b"PK\x03\x04 not whole")
    write_mesh(ellipsoid(2, (1, 1, 3)), shapes / "ring1.off")  # another shape under an old name
    assert run(shapes, "-o", out, "--embed", 1).exit_code == 0
    new = (kept / "distortions.csv").read_text()
    assert all(re.fullmatch(r"\w{64},\w{64},[^,]+,[\d.e-]+", line) for line in new.splitlines())
    names, *rows = table(out / "matrix.csv")
    assert float(rows[3][names.index("ring1")]) > 0.01  # no longer congruent to ring0


def test_damaged_lines_of_what_is_kept_say_nothing(folder: Path, done: tuple[Path, dict], tmp_path: Path) -> None:
    out = tmp_path / "out"
    shutil.copytree(done[0], out)
    kept = out / "kept" / "distortions.csv"
    first, _, rest = kept.read_bytes().partition(b"\n")
    kept.write_bytes(b"\xff\0,a\n" + first[:-3] + b"x\n" + b",,,nan\n" + rest)
    assert run(folder, "-o", out, "--embed", 1).exit_code == 0
    assert (out / "matrix.csv").read_bytes() == (done[0] / "matrix.csv").read_bytes()


def test_a_bad_mesh_is_named_and_left_out(folder: Path, tmp_path: Path) -> None:
    for name in ("blob0.ply", "ring0.off"):
        shutil.copy(folder / name, tmp_path / name)
    (tmp_path / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    (tmp_path / "tiny.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    result = run(tmp_path, "-o", tmp_path / "out", "--json")
    assert result.exit_code == 3
    assert "left out broken.off" in result.stderr and "E105" in result.stderr and "E113" in result.stderr
    assert json.loads(result.stdout)["left_out"] == ["broken.off", "tiny.off"]
    assert "broken.off" in (tmp_path / "out" / "compare.html").read_text()
    assert len(table(tmp_path / "out" / "matrix.csv")) == 3


def test_names_are_text_on_the_page(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "blob0.ply", tmp_path / "<b>x&y.ply")
    shutil.copy(folder / "ring0.off", tmp_path / "$z_{1}$.off")
    result = run(tmp_path, "-o", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert "<b>" not in (tmp_path / "out" / "compare.html").read_text()


def test_a_folder_without_meshes_is_an_error(tmp_path: Path) -> None:
    assert run(tmp_path).exit_code == 1 and run(tmp_path / "gone").exit_code == 1
    (tmp_path / "broken.off").write_text("OFF\n")
    assert run(tmp_path, "-o", tmp_path / "out").exit_code == 3
    write_mesh(bumpy_sphere(1), tmp_path / "one.ply")
    (tmp_path / "broken.off").unlink()
    assert run(tmp_path, "-o", tmp_path / "out").exit_code == 0  # a single shape is a collection too


def test_by_self_functional_maps_copies_are_the_same_and_others_are_not(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = run(folder, "-o", out, "--by", "self-functional-maps", "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert (said["by"], said["nearest_has_same_name"]) == ("self-functional-maps", 1)
    matrix = np.array([[float(x) for x in row[1:]] for row in table(out / "matrix.csv")[1:]])
    assert np.array_equal(matrix, matrix.T) and matrix[0, 1] < 1e-3 < 0.05 < matrix[0, 3]
    assert (out / "kept" / "self_functional_maps" / "egg.npz").exists()
    assert "self functional maps" in (out / "compare.html").read_text()


def test_shapes_are_compared_by_self_functional_maps(folder: Path, done: tuple[Path, dict], tmp_path: Path) -> None:
    """`--by` compares by something else: congruent shapes are as near, others elsewhere, and nothing is mixed up."""
    out = tmp_path / "out"
    shutil.copytree(done[0], out)  # what is kept of bounds is not taken for something else
    result = run(folder, "-o", out, "--by", "self-functional-maps", "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert (said["by"], done[1]["by"]) == ("self-functional-maps", "distances")
    assert said["nearest_has_same_name"] == 1 and said["embedded_pairs"] == 0
    new, old = (np.array([row[1:] for row in table(each / "matrix.csv")[1:]], dtype=float) for each in (out, done[0]))
    assert np.array_equal(new, new.T) and (np.diag(new) == 0).all()
    assert new[3, 4] < 0.1 * new[0, 3] and not np.allclose(new, old)
    assert run(folder, "-o", out, "--by", "volume").exit_code == 2
