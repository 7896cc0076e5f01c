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


def called(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    return subprocess.run(
        [sys.executable, "-m", *command], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )


def run(folder: Path, *command: str) -> str:
    done = called(folder, *command)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def stems(kind: str, folder: Path) -> list[str]:
    """The files of tests of a recipe, without their ending."""
    given = [folder / path for path in TESTS[kind][0].split()]
    return [path.stem for one in given for path in (sorted(one.glob("test_*.py")) if one.is_dir() else [one])]


@pytest.fixture(scope="module")
def followed_together(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, list[str]], str]:
    """A copy in which every recipe is followed, the files of each, and what pytest says of the tests of all.

    As no file is of two recipes, each is there as it would be alone; pytest takes longer to start than these tests do.
    """
    folder = copied(tmp_path_factory.mktemp("project"))
    touched = {kind: followed(recipe, folder) for kind, recipe in RECIPES.items()}
    paths = [path for files, _ in TESTS.values() for path in files.split()]
    chosen = [" or ".join(stems(kind, folder)) for kind in TESTS]
    words = [f"({files}) and ({words or files})" for files, (_, words) in zip(chosen, TESTS.values(), strict=True)]
    command = ["pytest", "-vv", "-p", "no:cacheprovider", "-n", "0", *paths, "-k", " or ".join(words)]
    done = called(folder, *command)
    return folder, touched, done.stdout + done.stderr


def test_every_recipe_is_tested() -> None:
    assert set(RECIPES) == set(TESTS)


def test_no_file_is_of_two_recipes(followed_together: tuple[Path, dict[str, list[str]], str]) -> None:
    touched = followed_together[1]
    files = [path for paths in touched.values() for path in paths]
    assert len(files) == len(set(files)) > 20
    for kind, recipe in RECIPES.items():
        others = [path for other, paths in touched.items() if other != kind for path in paths]
        new = [path.removesuffix(".py") for path in others if not (ROOT / path).exists()]
        assert new and not [path for path in new if path in recipe or path.replace("/", ".") in recipe], kind


@pytest.mark.parametrize("kind", RECIPES)
def test_a_recipe_works_as_it_stands(kind: str, followed_together: tuple[Path, dict[str, list[str]], str]) -> None:
    folder, touched, told = followed_together
    run(folder, "ruff", "check", "--no-cache", *touched[kind])
    run(folder, "ruff", "format", "--no-cache", "--check", *touched[kind])
    of_kind = "|".join(stems(kind, folder)), TESTS[kind][1].replace(" or ", "|")
    results = re.findall(rf"^\S*(?:{of_kind[0]})\.py::\S*.* (PASSED|FAILED|ERROR)\b", told, re.MULTILINE)
    assert results and set(results) == {"PASSED"} and " error" not in told.splitlines()[-1], told
    assert re.search(rf"^\S*(?:{of_kind[0]})\.py\S*(?:{of_kind[1]}).* PASSED", told, re.MULTILINE), told
    if kind == "command":
        write_mesh(tetrahedron(), folder / "dog.ply")
        assert run(folder, "gmds", "area", "dog.ply").splitlines()[1].split() == ["area:", f"{tetrahedron().area:.4g}"]
