"""gmds doctor and gmds warmup: what is missing is told, and nothing is left to compile."""

from __future__ import annotations

import importlib.metadata
import json
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from places import ROOT

from gmds.cli import main
from gmds.errors import RenderingError
from gmds.installation import diagnosis
from gmds.installation.warmup import Warmth


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """Nothing is imported; versions are the least allowed, unless a test says otherwise ("" for not installed)."""
    known = dict(p.split(">=") for p in (*diagnosis.REQUIRED, *(p for e in diagnosis.EXTRAS.values() for p in e[0])))

    def version(name: str) -> str:
        if not known[name]:
            raise importlib.metadata.PackageNotFoundError(name)
        return known[name]

    monkeypatch.setattr(diagnosis.importlib.metadata, "version", version)
    monkeypatch.setattr(diagnosis, "_import_error", lambda module: "")
    monkeypatch.setattr("gmds.pictures.offscreen.offscreen", lambda shots: [])
    return known


def doctor() -> tuple[int, dict[str, Any], list[str]]:
    result = CliRunner().invoke(main, ["doctor", "--json"])
    said = json.loads(result.stdout)
    return result.exit_code, {one["name"]: one for one in said["findings"]}, said["problems"]


def test_the_packages_are_those_of_the_project() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert list(diagnosis.REQUIRED) == project["dependencies"]
    for name, (packages, _) in diagnosis.EXTRAS.items():
        assert list(packages) == project["optional-dependencies"][name]
    assert project["requires-python"] == ">={}.{}".format(*diagnosis.PYTHON)


def test_all_is_well_here(quick: dict[str, str]) -> None:
    code, found, problems = doctor()
    assert (code, problems) == (0, [])
    assert {one["state"] for one in found.values()} == {"ok"}
    assert "__pycache__" in found["compiled kernels"]["found"] or "numba" in found["compiled kernels"]["found"]
    human = CliRunner().invoke(main, ["doctor"])
    assert human.exit_code == 0 and human.stdout.endswith("no problems\n")


def test_absent_extras_are_no_problem_and_say_how_to_get_them(quick: dict[str, str]) -> None:
    quick["plotly"] = quick["pymeshlab"] = ""
    code, found, problems = doctor()
    assert (code, problems) == (0, [])
    assert found["extra viz"]["state"] == found["extra repair"]["state"] == "absent"
    assert found["extra viz"]["advice"].startswith("pip install 'matplotlib>=3.8' 'plotly>=6' ")
    assert "(the extra 'viz')" in found["extra viz"]["advice"]


def test_old_missing_and_broken_packages_are_problems(quick: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    quick.update(numpy="1.9.3", rich="", scipy="1.100")
    monkeypatch.setattr(diagnosis, "_import_error", lambda module: "no driver" if module in ("igl", "plotly") else "")
    code, found, problems = doctor()
    assert code == 1
    assert problems == ["numpy", "libigl", "rich", "extra viz"]
    assert found["numpy"]["advice"] == "pip install --upgrade 'numpy>=1.26'"
    assert "no driver" in found["libigl"]["found"] and "no driver" in found["extra viz"]["found"]


def test_a_missing_package_is_told_before_it_is_used(quick: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    quick["numba"] = ""
    monkeypatch.setattr("geodesics.compiling.cache_folder", lambda: 1 / 0)
    code, found, problems = doctor()
    assert (code, problems) == (1, ["numba"])
    assert "compiled kernels" not in found


def test_a_machine_that_can_not_draw_is_no_problem(quick: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(shots: object) -> None:
        raise RenderingError("no driver")

    monkeypatch.setattr("gmds.pictures.offscreen.offscreen", refuse)
    code, found, _ = doctor()
    assert code == 0 and found["drawing"]["state"] == "absent" and "no driver" in found["drawing"]["advice"]


def test_a_folder_that_can_not_be_written(quick: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("geodesics.compiling.cache_folder", lambda: None)
    code, found, problems = doctor()
    assert (code, problems) == (1, ["compiled kernels"])
    assert "NUMBA_CACHE_DIR" in found["compiled kernels"]["advice"]


def test_imports_are_tried_in_a_process_of_their_own() -> None:
    assert diagnosis._import_error("json") == ""
    assert "No module named 'no_such_module'" in diagnosis._import_error("no_such_module")
    assert diagnosis._import_error("os; os._exit(7)") == "exit code 7"


def test_warmup_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gmds.installation.warmup.warm_up", lambda progress: Warmth(3, 1.5, None))
    result = CliRunner().invoke(main, ["warmup", "--json"])
    assert json.loads(result.stdout) == {"compiled": 3, "seconds": 1.5, "folder": None}
    assert "NUMBA_CACHE_DIR" in result.stderr


def test_warming_up_leaves_no_kernel_that_the_library_calls() -> None:
    code = """
import importlib, pathlib, pkgutil, re
import geodesics, gmds
from gmds.installation.warmup import warm_up
warmth = warm_up()
assert warmth.folder and warmth.seconds > 0
text = "".join(p.read_text() for m in (geodesics, gmds) for p in pathlib.Path(m.__file__).parent.rglob("*.py")
               if "_kernels" not in p.parts)
seen = 0
for package in ("geodesics._kernels", "gmds._kernels"):
    for found in pkgutil.iter_modules(importlib.import_module(package).__path__):
        module = importlib.import_module(f"{package}.{found.name}")
        for name, kernel in vars(module).items():
            if hasattr(kernel, "signatures") and re.search(rf"\\b{found.name}\\.{name}\\b|import .*\\b{name}\\b", text):
                seen += 1
                if not kernel.signatures:
                    print(f"{found.name}.{name}")
assert seen > 5
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=ROOT)
    assert (done.returncode, done.stdout) == (0, ""), done.stdout + done.stderr


def test_a_folder_that_anyone_can_write_is_told(
    quick: dict[str, str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    tmp_path.chmod(0o777)
    monkeypatch.setattr("geodesics.compiling.cache_folder", lambda: str(tmp_path))
    code, found, problems = doctor()
    assert (code, problems) == (1, ["compiled kernels"])
    assert "chmod o-w" in found["compiled kernels"]["advice"]
    tmp_path.chmod(0o755)
    assert doctor()[0] == 0
