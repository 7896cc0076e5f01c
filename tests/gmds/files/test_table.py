"""Tables: no writer lets a name be run as a formula, all end lines alike, and names come back as they were."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from generated_shapes import bumpy_sphere
from hypothesis import given
from hypothesis import strategies as st
from known_maps import make_answer
from places import ROOT

from benchmarks.accuracy import collection, runs, symmetry
from geodesics import write_mesh
from gmds.batch.agreement import write_cycles
from gmds.batch.cycles import Consistency, Cycle
from gmds.batch.manifest import write_summary
from gmds.batch.records import PairRecord
from gmds.benchmarking.run import BenchmarkRow, write_csv
from gmds.cli import main
from gmds.cli.fields import write_field
from gmds.comparison.folder import Compared, _Distortions
from gmds.comparison.output import write_comparison
from gmds.files.table import read_table, table_text, unguarded, write_table
from gmds.files.values import read_values
from gmds.landmarks.files import Landmarks, read_landmarks, write_landmarks
from gmds.maps.export import export_map

NAME = "=1+1"
DANGEROUS = (NAME, "+1+1", "-1+1", "@sum", "\t=1+1", "\r=1+1", " =1+1", "\uff1d1+1")
AT = np.array([[0.5, -1e-3, 2.0], [-1.0, 0.0, 3.0]])


def compare(folder: Path, name: str) -> None:
    pytest.importorskip("matplotlib")
    matrix = np.array([[0.0, 1, 2], [1, 0, 3], [2, 3, 0]])
    write_comparison(Compared((name, "b", "c"), matrix, np.full((3, 3), np.nan)), folder)


def retrieve(folder: Path, name: str) -> None:
    meshes = folder / "meshes"
    meshes.mkdir()
    for file in (f"{name}.off", "b.off"):
        write_mesh(bumpy_sphere(1), meshes / file)
    said = CliRunner().invoke(main, ["retrieve", str(meshes / "b.off"), str(meshes), "-o", str(folder / "a.csv")])
    assert said.exit_code == 0, said.output


def landmarks(ending: str) -> Callable[[Path, str], None]:
    def write(folder: Path, name: str) -> None:
        marks = Landmarks((name, "b"), AT)
        write_landmarks(folder / f"a{ending}", marks, columns={NAME: [name, "x"]})

    return write


WRITERS: dict[str, Callable[[Path, str], Any]] = {
    "benchmark": lambda folder, name: write_csv(folder / "a.csv", [BenchmarkRow(name, name, name, direct=-0.5)]),
    "batch, summary": lambda folder, name: write_summary(folder / "a.csv", [PairRecord(name, name, name, 1.0)]),
    "batch, cycles": lambda folder, name: write_cycles(
        folder / "a.csv", Consistency((Cycle((name, "b", "c"), True, 0.1, 0.5, 0.7),))
    ),
    "compare": compare,
    "compare, kept": lambda folder, name: _Distortions(folder / "a.csv").get(name, name, lambda: 0.5),
    "export": lambda folder, name: export_map(make_answer(), folder / "a.csv"),
    "values": lambda folder, name: write_field(folder / "a.csv", {}, {name: np.array([name, "b"])}),
    "retrieve": retrieve,
    "landmarks, .csv": landmarks(".csv"),
    "landmarks, .fcsv": landmarks(".fcsv"),
    "accuracy": lambda folder, name: runs.write_rows(
        folder / "a.csv", name, {(name, name): BenchmarkRow(name, "", name, direct=1.0)}
    ),
    "symmetry": lambda folder, name: symmetry.write(folder / "a.csv", [{"shape": name, "scale": "plain"}]),
    "collection": lambda folder, name: collection.add_row(folder / "a.csv", {name: name}),
}
WITHOUT_NAMES = ("export",)


@pytest.mark.filterwarnings("ignore:Glyph")  # names that the font of the picture lacks
@pytest.mark.parametrize("name", DANGEROUS)
@pytest.mark.parametrize("writer", WRITERS)
def test_no_name_stands_bare_at_the_start_of_a_cell(writer: str, name: str, tmp_path: Path) -> None:
    if writer == "retrieve" and "\r" in name:
        pytest.skip("no such file name everywhere")
    WRITERS[writer](tmp_path, name)
    tables = [path for path in tmp_path.iterdir() if path.suffix in (".csv", ".fcsv")]
    seen = set()
    for path in tables:
        content = path.read_bytes()
        assert b"\r" not in content and content.endswith(b"\n")
        lines = [line for line in content.decode().splitlines() if not line.startswith("# ")]
        for cell in (cell for row in csv.reader(lines) for cell in row):
            assert re.fullmatch(r"[+-]?[\d.]+(e[+-]?\d+)?|[^=+\-@\t\uff1d].*|", cell.strip(" ")), cell
            seen.add(unguarded(cell).strip().partition(".off")[0].partition(" ")[0])
    assert writer in WITHOUT_NAMES or name.strip() in seen


@pytest.mark.parametrize("name", [*DANGEROUS, "'=1", "''", "'tis", "-5", "'-5", "-", "a,b", 'say "a"', "#1"])
@pytest.mark.parametrize("ending", [".csv", ".fcsv"])
def test_landmarks_keep_their_names(name: str, ending: str, tmp_path: Path) -> None:
    write_landmarks(tmp_path / f"a{ending}", Landmarks((name, "b"), AT))
    back = read_landmarks(tmp_path / f"a{ending}")
    assert back.names == (name.strip(), "b") and (back.at == AT).all()


def test_a_landmark_that_others_quoted_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("name,x,y,z\n'=1+1,1,2,3\n'tis,4,5,6\n", encoding="utf-8")
    assert read_landmarks(tmp_path / "a.csv").names == (NAME, "'tis")


def test_labels_keep_their_names(tmp_path: Path) -> None:
    labels = np.array([NAME, "'=1", "ear", "-"])
    write_field(tmp_path / "a.csv", {}, {"value": labels})
    assert read_values(tmp_path / "a.csv", 4, labels=True).tolist() == labels.tolist()
    (tmp_path / "a.txt").write_text("\n".join(labels), encoding="utf-8")
    assert read_values(tmp_path / "a.txt", 4, labels=True).tolist() == labels.tolist()


@given(
    st.lists(st.lists(st.text(), min_size=2, max_size=2), max_size=4),
    st.text(st.sampled_from("'=+-@\t 1e."), max_size=6),
)
def test_a_table_comes_back(tmp_path_factory: pytest.TempPathFactory, rows: list[list[str]], odd: str) -> None:
    path = tmp_path_factory.mktemp("table") / "a.csv"
    rows = [
        [" ".join(cell.encode("utf-8", "replace").decode().splitlines()) for cell in row] for row in [*rows, [odd, "b"]]
    ]
    write_table(path, ["=a", "b"], rows)
    assert read_table(path) == [{"=a": one, "b": other} for one, other in rows]


def test_numbers_are_numbers() -> None:
    row = [-0.1, np.float64(-1e-300), -3, True, None, "-4.5e-3", float("nan"), -float("inf")]
    assert table_text([row]) == "-0.1,-1e-300,-3,True,,-4.5e-3,nan,-inf\n"
    assert table_text([row], digits=1) == "-0.1,-1e-300,-3,True,,-4.5e-3,nan,-inf\n"
    assert table_text([[1 / 3, "1/3"]], digits=6) == "0.333333,1/3\n"


def test_a_table_is_the_old_one_or_the_new_one(tmp_path: Path) -> None:
    write_table(tmp_path / "a.csv", ["a"], [[1]])
    with pytest.raises(ZeroDivisionError):
        write_table(tmp_path / "a.csv", ["a"], ([1 / i] for i in (1, 0)))
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"] and read_table(tmp_path / "a.csv") == [{"a": "1"}]


def test_nobody_else_writes_tables() -> None:
    alone = {
        "gmds/files/table.py",
        "benchmarks/mutation/mutants.py",  # what it imports cannot be mutated
        "benchmarks/stability/same_maps.py",  # runs in checkouts that have no such module
    }
    files = [path for name in ("gmds", "geodesics", "benchmarks", "examples") for path in (ROOT / name).rglob("*.py")]
    writers = {
        str(path.relative_to(ROOT)) for path in files if re.search(r"csv\.(Dict)?[wW]riter", path.read_text("utf-8"))
    }
    assert writers == alone
