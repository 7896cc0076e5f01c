"""Shapes in files of the same name: none is dropped, and each has a name of its own."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from click.testing import CliRunner
from generated_shapes import bumpy_sphere, icosphere

from geodesics import write_mesh
from gmds.batch.collection import Collection, names
from gmds.cli import main
from gmds.comparison.folder import compare_files


def test_names_of_files_that_differ_in_their_ending() -> None:
    assert names([Path("m/a.obj"), Path("m/a.ply"), Path("m/b.ply")]) == ["a.obj", "a.ply", "b"]
    assert names([Path("m/A.off"), Path("m/a.ply")]) == ["A.off", "a.ply"]
    clash = names([Path("m/a.obj"), Path("m/a.ply"), Path("m/a.ply.off"), Path("n/a.ply")])
    assert len(set(clash)) == 4 and clash[0] == "a.obj"


def test_a_folder_gives_every_file(tmp_path: Path) -> None:
    write_mesh(icosphere(1), tmp_path / "a.obj")
    write_mesh(bumpy_sphere(1), tmp_path / "a.ply")
    write_mesh(icosphere(2), tmp_path / "b.ply")
    found = Collection.of(tmp_path)
    assert list(found.shapes) == ["a.obj", "a.ply", "b"] and len(found.pairs) == 3
    assert found.shapes["a.ply"].mesh().n_vertices == bumpy_sphere(1).n_vertices


def test_compare_keeps_them_apart(tmp_path: Path) -> None:
    (tmp_path / "m").mkdir()
    write_mesh(icosphere(2), tmp_path / "m" / "a.obj")
    write_mesh(bumpy_sphere(2), tmp_path / "m" / "a.ply")
    done = CliRunner().invoke(main, ["compare", str(tmp_path / "m"), "-o", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    with (tmp_path / "out" / "matrix.csv").open(newline="") as stream:
        head, *rows = csv.reader(stream)
    assert head == ["", "a.obj", "a.ply"] and float(rows[0][2]) > 0
    again = compare_files(sorted((tmp_path / "m").iterdir()), tmp_path / "out" / "kept")
    assert np.isclose(again.bounds[0, 1], float(rows[0][2]))
