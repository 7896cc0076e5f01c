"""What is built holds what people need, and nothing else."""

from __future__ import annotations

import email
import email.message
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from places import ROOT

import gmds

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

if not (ROOT / "gmds").is_dir():
    pytest.skip("the packages themselves are not here, so nothing can be built", allow_module_level=True)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("hatchling")
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "-d", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def wheel(built: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(next(built.glob("*.whl"))) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture(scope="module")
def sdist(built: Path) -> set[str]:
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        return {member.name.partition("/")[2] for member in archive.getmembers()}


@pytest.fixture(scope="module")
def metadata(wheel: dict[str, bytes]) -> email.message.Message:
    return email.message_from_bytes(next(text for name, text in wheel.items() if name.endswith("METADATA")))


def test_the_wheel_holds_the_packages_and_nothing_else(wheel: dict[str, bytes]) -> None:
    assert {name.split("/")[0].split("-")[0] for name in wheel} == {"gmds", "geodesics"}
    source = {str(path.relative_to(ROOT)) for p in ("gmds", "geodesics") for path in (ROOT / p).rglob("*.py")}
    assert source <= set(wheel)
    assert {"gmds/py.typed", "geodesics/py.typed", "gmds/report/report.html", "gmds/comparison/compare.html"} <= set(
        wheel
    )
    assert not [name for name in wheel if "__pycache__" in name or name.endswith((".nbi", ".nbc", ".pyc"))]
    assert any(name.endswith("licenses/LICENSE") for name in wheel)
    assert b"gmds = gmds.cli:main" in next(text for name, text in wheel.items() if name.endswith("entry_points.txt"))


def test_the_sdist_holds_what_the_tests_and_the_documentation_need(sdist: set[str]) -> None:
    tracked = [p for folder in ("tests", "examples", "docs") for p in (ROOT / folder).rglob("*.*") if p.is_file()]
    needed = {str(p.relative_to(ROOT)) for p in tracked if p.suffix in (".py", ".md", ".png", ".json", ".html")}
    needed |= {"README.md", "LICENSE", "CHANGELOG.md", "CONTRIBUTING.md", "CITATION.cff", "pyproject.toml", ".ci/run"}
    assert needed - sdist == set()
    assert not [name for name in sdist if "__pycache__" in name or name.startswith((".git/", "dist", "site"))]


def test_neither_is_large(built: Path) -> None:
    size = {path.suffix: path.stat().st_size / 1e6 for path in built.iterdir()}
    assert size[".whl"] < 1 and size[".gz"] < 8, size


def test_the_metadata_says_what_the_project_says(metadata: email.message.Message) -> None:
    assert metadata["License-Expression"] == "MIT" and metadata["Requires-Python"] == ">=3.11"
    assert metadata["Description-Content-Type"] == "text/markdown"
    assert all("https://" in url for url in metadata.get_all("Project-URL") or []) and metadata["Project-URL"]
    needed = [line.partition(";")[0].strip() for line in metadata.get_all("Requires-Dist") or []]
    assert set(PROJECT["dependencies"]) <= {line.replace(" ", "") for line in needed}
    assert "pymeshlab" not in " ".join(PROJECT["dependencies"]), "GPL-3: an extra, never needed"


def test_a_package_index_would_take_them_and_show_no_broken_links(built: Path, metadata: email.message.Message) -> None:
    pytest.importorskip("twine")
    command = [sys.executable, "-m", "twine", "check", "--strict", *map(str, built.iterdir())]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    page = str(metadata.get_payload())
    assert "# gmds" in page and "## Landmarks" in page and "<!--" not in page and "![" not in page
    assert re.findall(r"\]\((?!https?:|#)[^)]*\)", page) == []


def test_the_conda_recipe_asks_for_what_the_project_needs() -> None:
    recipe = (ROOT / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    asked = [
        line.strip()[2:].partition("#")[0].replace(" ", "") for line in recipe.partition("  run:")[2].splitlines()[1:]
    ]
    needed = [one.replace("libigl", "igl") for one in PROJECT["dependencies"]]
    assert asked[: len(needed) + 1] == [f"python{PROJECT['requires-python']}", *needed]
    assert f'version: "{gmds.__version__}"' in recipe and "gmds = gmds.cli:main" in recipe
    build = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]["requires"]
    assert all(f"- {one.replace('>=', ' >=')}" in recipe for one in build)
