"""Maps as .csv and .mat: what is in the files is the map, counted as their readers count."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from generated_shapes import bumpy_sphere, icosphere
from scipy.io import loadmat

from geodesics import SurfacePoints, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.maps.export import COLUMNS, UnknownExport, export_map
from gmds.maps.point_map import MatchStatus

SOURCE, TARGET = bumpy_sphere(1), icosphere(2)


@pytest.fixture
def answer() -> Correspondence:
    rng = np.random.default_rng(0)
    n = SOURCE.n_vertices
    points = SurfacePoints(TARGET, rng.integers(0, TARGET.n_faces, n), rng.dirichlet(np.ones(3), n))
    return Correspondence.from_points(
        SOURCE, points, valid=rng.random(n) < 0.7, distortion=rng.random(n), status=MatchStatus.AMBIGUOUS
    )


def test_the_table_holds_the_map_to_the_last_digit(answer: Correspondence, tmp_path: Path) -> None:
    export_map(answer, tmp_path / "map.csv")
    with (tmp_path / "map.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert tuple(rows[0]) == COLUMNS and len(rows) == SOURCE.n_vertices
    column = {name: np.array([float(row[name]) for row in rows]) for name in COLUMNS}
    assert (column["source_vertex"] == np.arange(SOURCE.n_vertices)).all()
    assert (column["target_vertex"] == answer.vertex_map()).all()
    assert (column["face"] == answer.points.face).all()
    weights = np.stack([column[f"weight_{k}"] for k in range(3)], axis=1)
    again = SurfacePoints(TARGET, column["face"].astype(int), weights)
    assert np.allclose(again.positions, np.stack([column[k] for k in "xyz"], axis=1), atol=1e-15)
    assert (column["valid"] == answer.valid).all() and (column["distortion"] == answer.distortion).all()


def test_matlab_counts_from_one(answer: Correspondence, tmp_path: Path) -> None:
    export_map(answer, tmp_path / "map.mat")
    found = loadmat(tmp_path / "map.mat")
    n = SOURCE.n_vertices
    assert found["vertex"].shape == found["face"].shape == found["valid"].shape == found["distortion"].shape == (n, 1)
    assert found["vertex"].dtype == np.float64 and found["vertex"].min() >= 1
    assert (found["vertex"].ravel() - 1 == answer.vertex_map()).all()
    assert (found["face"].ravel() - 1 == answer.points.face).all()
    assert (found["barycentric"] == answer.points.barycentric).all()
    assert (found["position"] == answer.points.positions).all()
    assert (found["valid"].ravel() == answer.valid).all() and (found["distortion"].ravel() == answer.distortion).all()
    assert found["status"].tolist() == ["AMBIGUOUS"]
    assert (found["n_source"].item(), found["n_target"].item()) == (n, TARGET.n_vertices)


def test_on_the_command_line(answer: Correspondence, tmp_path: Path) -> None:
    write_mesh(SOURCE, tmp_path / "a.ply")
    write_mesh(TARGET, tmp_path / "b.ply")
    answer.save(tmp_path / "map.npz")
    args = ["export", tmp_path / "map.npz", "--source", tmp_path / "a.ply", "--target", tmp_path / "b.ply", "--json"]
    result = CliRunner().invoke(main, [*map(str, args), "-o", str(tmp_path / "m.mat")])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["rows"] == SOURCE.n_vertices
    assert (loadmat(tmp_path / "m.mat")["vertex"].ravel() - 1 == answer.vertex_map()).all()
    wrong = CliRunner().invoke(main, [*map(str, args), "-o", str(tmp_path / "m.xls")])
    assert wrong.exit_code == 1 and "E216" in wrong.stderr
    args[3], args[5] = args[5], args[3]
    swapped = CliRunner().invoke(main, [*map(str, args), "-o", str(tmp_path / "n.csv")])
    assert swapped.exit_code == 1 and "E212" in swapped.stderr and not (tmp_path / "n.csv").exists()


def test_other_endings_are_refused_and_leave_nothing(answer: Correspondence, tmp_path: Path) -> None:
    with pytest.raises(UnknownExport, match=r"end in \.csv or \.mat"):
        export_map(answer, tmp_path / "map.txt")
    assert list(tmp_path.iterdir()) == []
