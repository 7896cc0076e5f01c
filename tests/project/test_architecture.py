"""The house rules that a machine can check."""

from __future__ import annotations

import ast
import functools
import importlib
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

import geodesics
import gmds

PACKAGES = [Path(package.__file__ or "").parent for package in (geodesics, gmds)]
MODULES = sorted(path for package in PACKAGES for path in package.rglob("*.py"))
HEAVY = {"igl", "trimesh", "pymeshlab", "plotly", "matplotlib", "pyvista", "vtk", "distributed", "rich"}


def dotted(path: Path) -> str:
    parts = path.relative_to(next(p.parent for p in PACKAGES if p in path.parents)).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@functools.cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def child(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return done.stdout


EXAMPLES = re.compile(r"^( *)Examples\n\1--------\n(?:\1.+\n)+", re.MULTILINE)


def test_files_fit_on_a_few_screens() -> None:
    """Examples at the end of docstrings aside."""
    length = {path: len(EXAMPLES.sub("", path.read_text(encoding="utf-8")).splitlines()) for path in MODULES}
    # kernels may be longer, as each may only call kernels of its own file
    assert not {dotted(path): n for path, n in length.items() if n > (350 if "_kernels" in path.parts else 200)}


def test_examples_fit_on_one_screen() -> None:
    scripts = sorted((ROOT / "examples").glob("*.py"))
    assert not {path.name for path in scripts if len(path.read_text(encoding="utf-8").splitlines()) > 40}


def test_the_library_never_prints_asserts_or_exits() -> None:
    found = []
    for path in MODULES:
        if "cli" in path.parts:
            continue
        for node in ast.walk(parsed(path)):
            called = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
            asserts = isinstance(node, ast.Assert) and not ast.unparse(node.test).endswith(" is not None")  # for mypy
            if asserts or called in ("print", "exit", "quit", "input", "breakpoint"):
                found.append(f"{dotted(path)}, line {node.lineno}")
    assert not found


def test_every_public_name_has_a_docstring() -> None:
    bare = []
    for path in MODULES:
        tree = parsed(path)
        if not ast.get_docstring(tree) and path.read_text(encoding="utf-8").strip():
            bare.append(dotted(path))
        for node in tree.body:
            named = isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_")
            if named and not ast.get_docstring(node):
                bare.append(f"{dotted(path)}.{node.name}")
    assert not bare


def test_matching_uses_only_public_names_of_the_distance_layer() -> None:
    private = []
    for path in MODULES:
        if PACKAGES[1] not in path.parents or "_kernels" in path.parts:
            continue
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "geodesics":
                names = [*(node.module or "").split("."), *(alias.name for alias in node.names)]
                private += [f"{dotted(path)}: {name}" for name in names if name.startswith("_")]
    assert not private


@pytest.mark.parametrize("package", ["geodesics", "gmds"])
def test_public_names_are_declared_once_for_people_and_once_for_type_checkers(package: str) -> None:
    module = importlib.import_module(package)
    declared = {
        alias.asname: (node.module or "").removeprefix(f"{package}.")
        for block in ast.walk(parsed(Path(module.__file__ or "")))
        if isinstance(block, ast.If)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert declared == module._HOME
    assert set(module.__all__) <= set(dir(module))


@pytest.mark.parametrize("name", [f"{m.__name__}.{name}" for m in (geodesics, gmds) for name in m.__all__])
def test_public_names_exist_and_say_what_they_are(name: str) -> None:
    package, _, attribute = name.partition(".")
    thing = getattr(importlib.import_module(package), attribute)
    assert (thing.__doc__ or "").strip()


def test_an_unknown_name_is_an_attribute_error() -> None:
    for module in (geodesics, gmds):
        with pytest.raises(AttributeError, match="no_such_thing"):
            _ = module.no_such_thing


def test_importing_the_packages_is_quiet_and_pulls_in_nothing() -> None:
    code = "import sys; before = set(sys.modules); import gmds, geodesics; print(*(set(sys.modules) - before))"
    pulled = {name.partition(".")[0] for name in child(code).split()}
    assert pulled <= {"gmds", "geodesics", *sys.stdlib_module_names}, "numpy alone takes longer than all the rest"
    assert child("import gmds, geodesics") == ""


def test_heavy_packages_are_imported_only_where_they_are_used() -> None:
    names = [dotted(path) for path in MODULES]
    code = f"import importlib, sys\nfor name in {names}: importlib.import_module(name)\n"
    assert child(code + f"print(*({HEAVY} & set(sys.modules)))").split() == []


def test_typed_packages_say_so() -> None:
    assert all((package / "py.typed").exists() for package in PACKAGES)


def test_import_directions() -> None:
    if importlib.util.find_spec("importlinter") is None:
        pytest.skip("import-linter is not installed")
    code = "from importlinter.cli import lint_imports; import sys; sys.exit(lint_imports())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stdout
