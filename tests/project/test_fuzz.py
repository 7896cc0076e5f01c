"""A few damaged files for every reader; `benchmarks/fuzzing/fuzz.py` runs as many as one has patience for."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import pytest

FILES = 150
READERS = [
    "OFF", "OBJ", "PLY, text", "PLY, binary", "STL, text", "STL, binary", "PLY, lists and strips", "GLB", "GLB, scenes",
    "glTF", "VTK, text", "VTK, binary", "VTP, text", "VTP, packed", "GIFTI", "FreeSurfer", "FreeSurfer, text",
    "polygons", "packed by gzip", "inside gzip",
    *(f"habits of programs, {ending}" for ending in (".ply", ".obj", ".off", ".stl", ".vtk", ".glb")),
    "TOSCA", "measured surface",
    "colours, .obj", "colours, .ply", "colours, .glb", "scenes, .glb", "texture",
    "map", "map, meta inside", "map, face inside",
    "map, barycentric inside", "map, valid inside", "map, distortion inside", "landmarks of a map", "settings of a map",
    "map, kept by a batch", "landmarks, .csv", "landmarks, .mrk.json", "landmarks, .fcsv", "landmarks, .tps",
    "landmarks, .pts", "landmarks, .vts", "landmarks, .pp", "specimens, .tps", "specimens, .csv", "specimens, .fcsv",
    "specimens, .pts", "specimens, .nts",
    "specimens, .txt", "specimens, .landmarkAscii", "landmark pairs", "pair list", "settings", "values, .csv",
    "values, .txt",
    "values, .npy", "truth, .vts", "truth, .npz", "pairs of a benchmark", "pairs.json",
]  # fmt: skip


@pytest.fixture(scope="module")
def fuzz() -> Any:
    """The script."""
    return importlib.import_module("benchmarks.fuzzing.fuzz")


def test_every_reader_is_fuzzed(fuzz: Any) -> None:
    assert list(fuzz.TARGETS) == READERS


@pytest.mark.parametrize("name", READERS)
def test_damaged_files_are_refused_or_read_rightly(fuzz: Any, name: str, tmp_path: Path) -> None:
    target = fuzz.TARGETS[name]
    for content in target.sound():
        fuzz.lay_beside(target, tmp_path)
        (tmp_path / target.name).write_bytes(target.packed(content))
        if name not in ("map", "TOSCA"):  # some of theirs are only there to be mixed with the others
            assert fuzz.outcome(target, tmp_path / target.name) == "answered"
    found = fuzz.run(name, 1, range(FILES), tmp_path)
    assert found["failures"] == []
    assert found["answered"] + found["refused"] == FILES
    assert found["slowest"] < 5
