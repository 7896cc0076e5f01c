"""What gmds finds on this machine: versions, optional parts, threads, and where compiled kernels are kept."""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
import os
import platform
import re
import stat
import subprocess
import sys
from dataclasses import dataclass
from typing import Literal

from geodesics.extras import PACKAGES, how_to_install
from gmds._version import __version__

PYTHON = (3, 11)  # the oldest that gmds runs on, as pyproject.toml says
# as in pyproject.toml
REQUIRED = (
    "numpy>=1.26",
    "scipy>=1.12",
    "numba>=0.60",
    "trimesh>=4.6",
    "libigl>=2.6.1",
    "fast-simplification>=0.1.11",
    "threadpoolctl>=3.2",
    "click>=8.2",
    "rich>=13",
    "tomli-w>=1.0",
)
EXTRAS = {
    "viz": (
        PACKAGES["viz"],
        "pictures; pages and reports need neither it nor a browser here",
    ),
    "repair": (PACKAGES["repair"], "closing holes and remeshing in `gmds repair`"),
    "batch": (PACKAGES["batch"], "`gmds batch` and `atlas`, and `gmds landmarks` of a folder"),
    "neuro": (PACKAGES["neuro"], "GIFTI and FreeSurfer surfaces"),
    "notebook": (PACKAGES["notebook"], "maps to turn in a notebook"),
}
# modules that are not called as their package
MODULES = {"libigl": "igl", "tomli-w": "tomli_w", "pillow": "PIL", "fast-simplification": "fast_simplification"}
PATIENCE = 120  # seconds that an import may take: a bound

State = Literal["ok", "absent", "problem"]


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at: its name, its state, what was found, and what to do about it (or nothing)."""

    name: str
    state: State
    found: str
    advice: str = ""


def diagnose() -> list[Finding]:
    """All findings: Python, the packages, the optional parts, drawing, the kernels' folder and the threads."""

    system = f"{platform.system()} {platform.machine()}"
    findings = [Finding("gmds", "ok", __version__), _python(), Finding("system", "ok", system)]
    findings += [_package(needed, f"pip install '{needed}'") for needed in REQUIRED]
    works = all(finding.state == "ok" for finding in findings)
    findings += [_extra(name) for name in EXTRAS]
    return [*findings, _drawing(), _kernels(), _threads()] if works else findings  # these use what is needed


def _python() -> Finding:
    good = sys.version_info >= PYTHON
    advice = "" if good else f"use Python {PYTHON[0]}.{PYTHON[1]} or newer"
    return Finding("python", "ok" if good else "problem", platform.python_version(), advice)


def _package(needed: str, advice: str) -> Finding:
    """Whether a package is there, new enough, and can be imported: in a process of its own, as some crash."""
    name, least = needed.split(">=")
    try:
        version = importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return Finding(name, "problem", "not installed", advice)
    if _numbers(version) < _numbers(least):
        return Finding(name, "problem", f"{version}, older than {least}", f"pip install --upgrade '{needed}'")
    error = _import_error(MODULES.get(name, name))
    if error:
        return Finding(
            name, "problem", f"{version}, cannot be imported: {error}", f"pip install --force-reinstall {name}"
        )
    return Finding(name, "ok", version)


def _extra(name: str) -> Finding:
    """Whether all packages of an optional part are there."""
    packages, purpose = EXTRAS[name]
    advice = how_to_install(name)
    parts = [_package(needed, advice) for needed in packages]
    found = ", ".join(f"{part.name} {part.found}" for part in parts)
    broken = [part for part in parts if part.state != "ok" and part.found != "not installed"]
    if broken:
        return Finding(f"extra {name}", "problem", found, broken[0].advice)
    state: State = "ok" if all(part.state == "ok" for part in parts) else "absent"
    return Finding(f"extra {name}", state, found, "" if state == "ok" else f"{advice}, for {purpose}")


def _drawing() -> Finding:
    """Whether pyvista can draw here, tried on a triangle; without it pictures are drawn all the same."""
    import numpy as np

    from geodesics import Mesh
    from gmds.errors import RenderingError
    from gmds.pictures.offscreen import offscreen
    from gmds.pictures.software import Shot

    try:
        offscreen([Shot(Mesh(np.eye(3), [[0, 1, 2]]), np.ones((3, 3)), np.eye(3), 32)])
    except RenderingError as error:
        return Finding("drawing", "absent", "pictures are drawn without pyvista, which is slower", str(error))
    return Finding("drawing", "ok", "pyvista draws off screen")


def _kernels() -> Finding:
    from geodesics.compiling import cache_folder

    folder = cache_folder()
    if folder is None or not os.access(folder, os.W_OK):
        advice = "set NUMBA_CACHE_DIR to a folder that can be written, else every process compiles for itself"
        return Finding("compiled kernels", "problem", f"cannot be kept in {folder or 'any folder'}", advice)
    if os.stat(folder).st_mode & stat.S_IWOTH:
        advice = f"they are code: chmod o-w '{folder}', or set NUMBA_CACHE_DIR to a folder of your own"
        return Finding("compiled kernels", "problem", f"anyone may write in {folder}", advice)
    kept = sum(name.endswith(".nbi") for name in os.listdir(folder))
    advice = "" if kept else "the first match will compile them; `gmds warmup` does it now"
    return Finding("compiled kernels", "ok", f"{kept} in {folder}", advice)


def _threads() -> Finding:
    from geodesics.threads import threads

    return Finding("threads", "ok", f"{threads()} of {os.cpu_count()} processors", "GMDS_THREADS sets how many")


def _import_error(module: str) -> str:
    """The last line of what importing says in a process of its own; nothing when it goes well."""
    try:
        done = subprocess.run(
            [sys.executable, "-c", f"import {module}"], capture_output=True, text=True, timeout=PATIENCE, check=False
        )
    except subprocess.TimeoutExpired:
        return f"still not done after {PATIENCE} s"
    if done.returncode == 0:
        return ""
    return (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]


def _numbers(version: str) -> tuple[int, ...]:
    """The leading numbers of a version, so that 2.10 comes after 2.9."""
    numbers = re.match(r"\d+(\.\d+)*", version)
    return tuple(map(int, numbers[0].split("."))) if numbers else ()
