"""Old paths work for one release: they hand out what is at the new ones, and say where that is."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import geodesics.moved_paths
import gmds.moved_paths

MOVED = {**geodesics.moved_paths.MOVED, **gmds.moved_paths.MOVED}


@pytest.mark.parametrize("old", MOVED)
def test_what_was_there_is_found(old: str) -> None:
    module = importlib.import_module(old)
    for new in MOVED[old]:
        there = importlib.import_module(new)
        tree = ast.parse(Path(there.__file__ or "").read_text(encoding="utf-8"))
        for node in tree.body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name not in vars(module):
                with pytest.warns(DeprecationWarning, match=f"{old}.{node.name} is now "):
                    getattr(module, node.name)


def test_the_warning_names_the_new_path() -> None:
    code = "from gmds.solver import solve; import gmds; assert solve is gmds.solve; "
    code += "import geodesics.orientation as old; old.orient_faces"
    done = subprocess.run([sys.executable, "-W", "always", "-c", code], capture_output=True, text=True, check=True)
    assert "gmds.solver.solve is now gmds.mds.solver.solve" in done.stderr
    assert "geodesics.orientation.orient_faces is now geodesics.topology.orientation.orient_faces" in done.stderr


def test_what_was_never_there_is_not() -> None:
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("gmds.no_such_module")
    with pytest.raises(ImportError):
        from gmds.solver import no_such_name  # type: ignore[import-not-found]  # noqa: F401


def test_names_that_left_a_module_are_found_there() -> None:
    with pytest.warns(DeprecationWarning, match="one_ring"):
        from geodesics.curvature import one_ring_areas  # type: ignore[attr-defined]  # noqa: F401
