"""Every recipe of CONTRIBUTING, followed to the letter in a copy of the project, passes the tests of its kind."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from generated_shapes import tetrahedron
from places import ROOT

from geodesics import write_mesh

pytest.importorskip("ruff")
pytestmark = pytest.mark.skipif(not (ROOT / "gmds").is_dir(), reason="the packages do not lie beside the tests")
RECIPE = re.compile(r"^## Adding an? ([^\n]+)\n(.*?)(?=^## )", re.MULTILINE | re.DOTALL)
RECIPES = dict(RECIPE.findall((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")))
TESTS = {  # of pytest, and words that choose among them what is new
    "metric": ("tests/geodesics/test_metrics.py", "squared_mean_curvature"),
    "loss": (
        "tests/gmds/mds/test_losses.py tests/gmds/mds/test_solver.py tests/gmds/cli/test_settings.py",
        "LogCosh or log-cosh",
    ),
    "start": ("tests/gmds/initialization/test_initialization.py", "principal_axes"),
    "landmark format": ("tests/gmds/landmarks/test_landmark_formats.py", "lmk or names_and_numbers"),
    "command": ("tests/gmds/cli/test_cli_help.py", "area or section"),
    "deformation": ("tests/gmds/deformations", "twisting or cli"),
    "energy": ("tests/gmds/registration/test_energies.py", "BoundedSizes"),
    "dataset": ("tests/gmds/benchmarking/test_faust.py", ""),
}
BLOCK = re.compile(r"^```(python|diff)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def copied(folder: Path) -> Path:
    """The parts of the project that its own tests need, to be changed at will."""
    for name in ("geodesics", "gmds", "tests"):
        shutil.copytree(ROOT / name, folder / name)
    for name in ("README.md", "CONTRIBUTING.md", "pyproject.toml"):
        shutil.copy2(ROOT / name, folder / name)
    for name in ("benchmarks", "docs", "examples"):
        (folder / name).symlink_to(ROOT / name)
    return folder


def followed(recipe: str, folder: Path) -> list[str]:
    """The files that a recipe makes and changes, after it was followed there."""
    touched = []
    for kind, block in BLOCK.findall(recipe):
        if kind == "python":
            head, text = block.split("\n", 1)
            path = head.removeprefix("# ")
            assert not (folder / path).exists(), path
            (folder / path).write_text(text, encoding="utf-8")
            touched.append(path)
            continue
        for path, changes in re.findall(r"^--- (\S+)\n(.*?)(?=^--- |\Z)", block, re.MULTILINE | re.DOTALL):
            text = (folder / path).read_text(encoding="utf-8")
            for change in re.split(r"^@@\n", changes, flags=re.MULTILINE):
                lines = change.splitlines(keepends=True)
                old, new = ("".join(line[1:] for line in lines if line[0] in marks) for marks in (" -", " +"))
                assert text.count(old) == 1, f"{path} does not have once:\n{old}"
                text = text.replace(old, new)
            (folder / path).write_text(text, encoding="utf-8")
            touched.append(path)
    return touched


def run(folder: Path, *command: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    done = subprocess.run(
        [sys.executable, "-m", *command], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def test_every_recipe_is_tested() -> None:
    assert set(RECIPES) == set(TESTS)


@pytest.mark.parametrize("kind", RECIPES)
def test_a_recipe_works_as_it_stands(kind: str, tmp_path: Path) -> None:
    folder = copied(tmp_path)
    touched = followed(RECIPES[kind], folder)
    run(folder, "ruff", "check", "--no-cache", *touched)
    run(folder, "ruff", "format", "--no-cache", "--check", *touched)
    files, words = TESTS[kind]
    assert " passed" in run(folder, "pytest", "-p", "no:cacheprovider", "-n", "0", *files.split(), "-k", words)
    if kind == "command":
        write_mesh(tetrahedron(), folder / "dog.ply")
        assert run(folder, "gmds", "area", "dog.ply").splitlines()[1].split() == ["area:", f"{tetrahedron().area:.4g}"]
