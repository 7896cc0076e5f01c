"""Every figure of the paper is made on built-in shapes, and its numbers keep the promises of the README."""

from __future__ import annotations

import ast
import json
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ROOT

pytest.importorskip("matplotlib")
SCRIPTS = ROOT / "examples" / "paper"


@pytest.fixture
def numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Run a script on small shapes; the numbers it wrote."""
    monkeypatch.syspath_prepend(str(SCRIPTS))

    def run(name: str) -> dict[str, Any]:
        monkeypatch.setattr(sys, "argv", [name, "--small", "-o", str(tmp_path)])
        runpy.run_path(str(SCRIPTS / f"{name}.py"), run_name="__main__")
        assert (tmp_path / f"{name}.png").stat().st_size > 5000
        return json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))

    return run


def test_eigenfunctions_survive_local_scales(numbers) -> None:
    found = numbers("fig2_eigenfunctions")["animal"]
    for copy, least in (("same triangles", 0.95), ("remeshed", 0.85)):
        regular, invariant = found[copy]["regular"], found[copy]["invariant"]
        assert invariant["paired"] >= least and invariant["paired"] > regular["paired"] + 0.1
        assert invariant["rotated"] >= invariant["paired"] - 1e-3


def test_signatures_survive_local_scales(numbers) -> None:
    found = numbers("fig4_signatures")["animal"]
    assert found["same triangles"]["ratio"]["scaled"] <= 0.25
    assert found["remeshed"]["ratio"]["scaled"] <= 0.33  # a thousand vertices are few for curvature; 0.13 on 4,000


def test_voronoi_cells_survive_local_scales(numbers) -> None:
    found = numbers("fig6_voronoi")["animal"]
    assert len(found) == 2
    for copy in found.values():
        assert copy["invariant"]["carried"] >= 0.85
        assert all(copy["invariant"][samples] > copy["regular"][samples] for samples in ("own", "carried"))


def test_gmds_in_the_invariant_metric(numbers) -> None:
    found = numbers("fig7_gmds")["animal"]
    assert found["match"]["error_x100"] <= 2.5
    assert found["match"]["error_x100"] < 0.5 * found["invariant"]["error_x100"] < 15  # 40 and more at random


def test_two_dogs_with_other_ears_are_closer_than_either_is_to_a_cat(numbers) -> None:
    found = numbers("dissimilarity")["built-in"]
    for kind in ("distortion", "bound"):
        assert 0 < found[kind]["dog to dog, at most"] < 0.8 * found[kind]["dog to cat, at least"]
    assert np.array(found["distortion"]["matrix"]).shape == (3, 3)


def test_the_published_table_of_dissimilarities_is_that_of_the_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(SCRIPTS))
    markdown: Any = __import__("dissimilarity_tables").markdown
    about = ast.get_docstring(ast.parse((SCRIPTS / "dissimilarity.py").read_text(encoding="utf-8"))) or ""
    root = SCRIPTS.parents[1]
    found = json.loads((root / "docs" / "paper" / "dissimilarity.json").read_text(encoding="utf-8"))
    table = (root / "benchmarks" / "results" / "dissimilarity.md").read_text(encoding="utf-8")
    assert markdown(about, found) == table
    assert found["collection"]["invariant"]["nearest of the same class, %"]["all"] >= 95
    for where in ("built-in", "TOSCA"):
        for kind in ("distortion", "bound"):
            assert found[where][kind]["dog to dog, at most"] < 0.8 * found[where][kind]["dog to cat, at least"]


def test_metrics_keep_what_their_definition_promises(numbers) -> None:
    found = numbers("section2_arc_lengths")
    assert max(found["equi_affine"]["egg, unimodular map"], found["embedded"]["vase, bent"]) <= 1
    assert max(found["affine"]["egg, unimodular map"], found["affine"]["egg, affine map"]) <= 5
    for metric, change in found.items():
        assert (change["vase, twice as big"] < 0.01) == (metric not in ("embedded", "equi_affine"))
    both = {metric for metric in found if max(found[metric]["vase, twice as big"], found[metric]["vase, bent"]) < 0.5}
    assert both == {"scale_invariant", "gaussian_curvature_length"}  # of the scale-invariant ones, those of |K| alone
    scaled = {metric: change["animal, limbs scaled"] for metric, change in found.items()}
    assert scaled["scale_invariant"] < scaled["min_curvature"] < scaled["embedded"]
