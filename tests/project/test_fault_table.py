"""The judge of the fault table: what counts as what, kindly; and rows that are kept from run to run."""

from __future__ import annotations

import csv
import importlib
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from file_cases import F, V
from odd_shapes import BALL
from places import ROOT

from geodesics import Mesh, embedded, stiffness

SCRIPTS = ROOT / "benchmarks"


@pytest.fixture(scope="module")
def scripts() -> Any:
    """Imports a script by its name."""
    return lambda name: importlib.import_module(f"benchmarks.faults.{name}")


@pytest.fixture(scope="module")
def cases(scripts: Any) -> Any:
    """All cases by their names."""
    module = scripts("cases")
    return {**module.ARRAYS, **module.FILES}


@pytest.fixture(scope="module")
def judge(scripts: Any, cases: Any) -> Any:
    """`judge(case name, **result)`."""
    judged = scripts("judge").judge
    return lambda name, **result: judged(cases[name], result)


def as_lists(matrix: Any) -> dict[str, Any]:
    found = sp.coo_matrix(matrix)
    return {"matrix": [found.row.tolist(), found.col.tolist(), found.data.tolist()], "shape": found.shape}


def test_a_meaning_is_given_only_where_there_is_one(scripts: Any) -> None:
    """Every reference is finite at the vertex it is measured from, and nothing means what cannot be."""
    for case in scripts("cases").ARRAYS.values():
        for shape in case.shapes:
            assert len(shape.distances) == len(shape.vertices)
            assert len(shape.vertices) == 0 or shape.distances[case.source] == 0
        if case.row in ("V01", "V02", "V06", "V07", "V08", "V09"):
            assert case.shapes == []


def test_distances(judge: Any, cases: Any) -> None:
    two = "G08 two components"
    right = cases[two].shapes[0].distances
    assert np.array_equal(np.isfinite(right), np.arange(len(right)) < BALL().n_vertices)
    for mark in (np.inf, np.nan, -1.0, 1e30):
        assert judge(two, values=np.where(np.isfinite(right), right, mark).tolist()) == "right"
    assert judge(two, values=np.where(np.isfinite(right), right, 0.0).tolist()) == "wrong, silently"
    assert judge(two, values=(1.2 * right).tolist()) == "not finite, silently"
    assert judge(two, values=np.where(np.isfinite(right), 1.04 * right, -1).tolist()) == "right"
    assert judge(two, values=[0.0, 1.0]) == "wrong, silently"
    ball = cases["lists"].shapes[0].distances
    assert judge("lists", values=(1.2 * ball).tolist()) == "wrong, silently"
    assert judge("lists", values=(1.2 * ball).tolist(), printed="the mesh is odd") == "unclear error"
    assert judge("lists", values=np.full(len(ball), np.nan).tolist()) == "not finite, silently"


def test_meanings_of_what_is_refused(judge: Any) -> None:
    sound = [0, *[np.sqrt(8)] * 3]
    assert judge("V14 refused 40", values=sound) == "right"  # under the mask
    assert judge("V12 refused 35", values=sound) == "right"  # a quad
    assert judge("V03 refused 3", values=[1e300 * d for d in sound]) == "right"
    assert judge("V03 refused 3", values=[0.0] * 4) == "wrong, silently"
    assert judge("V05 refused 10", values=[0, np.inf, np.inf, np.inf]) == "right"
    assert judge("V05 refused 10", values=[0, 0, 0, 0]) == "wrong, silently"
    assert judge("V06 refused 12", values=sound) == "wrong, silently"
    assert judge("V01 refused 0", values=[0, np.nan, 1, 1]) == "not finite, silently"


def test_laplacians(judge: Any) -> None:
    ball = BALL()
    twice = Mesh(ball.vertices, np.concatenate([ball.faces, ball.faces[[3, 7, 7, 90]], ball.faces[5:6, [1, 2, 0]]]))
    right = stiffness(embedded(ball)).tocsr()
    assert judge("lists", **as_lists(right)) == "right"
    assert judge("G01 duplicate faces", **as_lists(stiffness(embedded(twice)))) == "right"
    assert judge("lists", **as_lists(2 * right)) == "wrong, silently"
    assert judge("lists", **as_lists(right + sp.eye_array(ball.n_vertices))) == "wrong, silently"
    assert judge("lists", **as_lists(right[:-1, :-1])) == "wrong, silently"
    assert judge("lists", **as_lists(right * np.nan)) == "not finite, silently"
    isolated = np.zeros((165, 165))
    assert judge("G07 isolated vertices", **as_lists(isolated)) == "wrong, silently"
    assert judge("V05 refused 10", **as_lists(np.eye(4))) == "right"


def test_files(judge: Any) -> None:
    whole = {"vertices": V.tolist(), "faces": F.tolist()}
    assert judge("short.off", **whole) == "right"
    assert judge("short.off", vertices=V.tolist(), faces=F[:3].tolist()) == "wrong, silently"
    assert judge("degree2.off", vertices=V.tolist(), faces=F[:3].tolist()) == "right"
    moved = V.copy()
    moved[1, 1] = np.nan
    assert judge("token0.off", vertices=moved.tolist(), faces=F.tolist()) == "right"
    assert judge("token3.off", vertices=moved.tolist(), faces=F.tolist()) == "not finite, silently"
    assert judge("empty.obj", vertices=[], faces=[]) == "right"
    assert judge("short.off", vertices=[], faces=[]) == "wrong, silently"
    outside = F.copy()
    outside[3, 1] = 4
    assert judge("index0.off", vertices=V.tolist(), faces=outside.tolist()) == "wrong, silently"


def test_errors_and_ends(judge: Any) -> None:
    assert judge("count4.off", error="ValueError", message="invalid literal for int(): 'four'") == "clear error"
    assert judge("short.off", error="RuntimeError", message="failed: short.off") == "unclear error"
    assert judge("short.off", error="RuntimeError", message="failed in line 7") == "clear error"
    assert judge("lists", error="TypeError", message="verts should be a numpy array") == "clear error"
    assert judge("V06 refused 12", nothing=True, printed="face 2: index out of range") == "clear error"
    assert judge("V06 refused 12", nothing=True, printed="") == "unclear error"
    assert judge("V06 refused 12", crash=-11) == "crash"
    assert judge("V06 refused 12", hang=True) == "hang"


def test_rows_of_other_libraries_are_kept(scripts: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    faults = scripts("faults")

    def made(library: str, seconds: float) -> Any:
        return faults.Row(
            library, "1.0", f"{library}_read", "F01", "empty.off", "E201", "clear error", None, seconds, ""
        )

    monkeypatch.setattr(faults, "installed", lambda names: list(names))
    for names, seconds in (("trimesh,libigl", 1.0), ("libigl", 2.0)):
        monkeypatch.setattr(faults, "run", lambda library, folder, seconds=seconds: iter([made(library, seconds)]))
        monkeypatch.setattr(sys, "argv", ["faults.py", "--libraries", names, "--output", str(tmp_path)])
        assert faults.main() == 0
    rows = faults.read_rows(tmp_path / "faults.csv")
    assert [(row.library, row.seconds, row.kept) for row in rows] == [("trimesh", 1.0, None), ("libigl", 2.0, None)]
    (tmp_path / "old.csv").write_text("library,entry\ntrimesh,trimesh_read\n")
    assert faults.read_rows(tmp_path / "old.csv") == faults.read_rows(tmp_path / "none.csv") == []


def test_the_published_page_is_that_of_the_published_rows(scripts: Any) -> None:
    faults, results = scripts("faults"), SCRIPTS / "results"
    rows = faults.read_rows(results / "faults.csv")
    assert (results / "faults.md").read_text(encoding="utf-8") == scripts("tables").page(rows)
    with (results / "faults.csv").open(newline="", encoding="utf-8") as stream:
        assert {line["library"] for line in csv.DictReader(stream)} == set(faults.LIBRARIES)


def test_readme_has_the_published_table(scripts: Any) -> None:
    faults, tables = scripts("faults"), scripts("tables")
    rows = faults.read_rows(SCRIPTS / "results" / "faults.csv")
    readme = (SCRIPTS.parent / "README.md").read_text(encoding="utf-8")
    shown = re.search(r"<!-- faults: begin -->\n(.*?)\n<!-- faults: end -->", readme, re.DOTALL)
    assert shown is not None
    assert "\n".join(tables.summary(rows, list(dict.fromkeys(row.library for row in rows)))).strip() in shown[1]
