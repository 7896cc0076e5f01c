"""The example of a study recovers what was put into its specimens."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ROOT

from gmds.batch import local_client

pytest.importorskip("distributed", reason="the extra `batch` is not installed")
pytest.importorskip("matplotlib", reason="the extra `viz` is not installed")

HERE = ROOT / "examples" / "study"


@pytest.fixture(scope="module")
def example() -> Iterator[Any]:
    sys.path.insert(0, str(HERE))
    yield importlib.import_module("study")
    sys.path.remove(str(HERE))


def test_specimens_are_what_they_are_said_to_be(example: Any) -> None:
    made = example.species.specimens(4, 300)
    assert [one.name for one in made] == ["short1", "long1", "short2", "long2"]
    assert [one.mirrored for one in made] == [False, False, True, False]
    assert made[1].mesh.n_vertices < 307 and made[0].mesh.n_vertices == 300
    assert np.abs(made[2].places(made[2].mesh.vertices) - made[2].figure.rest).max() == 0


def test_what_was_put_in_is_found(example: Any, tmp_path: Path) -> None:
    with local_client(1) as client:
        found = example.study(tmp_path, 4, 300, client)
    assert found["ears: correlation of growth with the truth"] > 0.85
    assert found["legs: correlation of growth with the truth"] > 0.85
    put_in = found["ears: difference of species, put in"]
    assert abs(found["ears: difference of species, found"] - put_in) < 0.25
    assert found["share of the specimen without a leg that is missing"] > 0
    assert {"atlas", "groups", "growth.png", "meshes", "model", "specimens.csv"} <= {p.name for p in tmp_path.iterdir()}
    assert found["points.tps, read back: largest difference"] == 0
    assert found["points.wide.csv, read back: largest difference"] == 0
    assert found.get("points.tps, read back by ktch: largest difference", 0.0) == 0
