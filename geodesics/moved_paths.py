"""Modules that moved in 0.1: their old paths work for one release, with a DeprecationWarning that names the new one."""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

MOVED: Mapping[str, tuple[str, ...]] = {
    "geodesics.dissection": ("geodesics.linalg.dissection",),
    "geodesics.edges": ("geodesics.topology.edges",),
    "geodesics.fast_marching": ("geodesics.fast_marching.distance",),
    "geodesics.invariants": ("geodesics.topology.invariants",),
    "geodesics.krylov": ("geodesics.linalg.krylov",),
    "geodesics.lanczos": ("geodesics.linalg.lanczos",),
    "geodesics.orientation": ("geodesics.topology.orientation",),
    "geodesics.repair": (
        "geodesics.repair.repairing",
        "geodesics.repair.decimation",
        "geodesics.repair.remeshing",
    ),
    "geodesics.splitting": ("geodesics.repair.splitting",),
    "geodesics.topology": ("geodesics.topology.components",),
}


class MovedModules:
    """Finds modules by their old paths; each gives the names that are now in the modules of the new paths.

    A finder and a loader without the base classes of `importlib.abc`, which import thirty more modules.
    """

    def __init__(self, moved: Mapping[str, tuple[str, ...]]) -> None:
        self.moved = moved

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Called after all other finders, so only for modules that do not exist."""
        return ModuleSpec(fullname, self, is_package=True) if fullname in self.moved else None  # type: ignore[arg-type]

    def create_module(self, spec: ModuleSpec) -> None:
        """An empty module, as usual."""

    def exec_module(self, module: ModuleType) -> None:
        """Names are looked up in the new modules when they are used."""
        module.__getattr__ = names_moved(module.__name__, self.moved[module.__name__])  # type: ignore[method-assign]


def names_moved(old: str, new: tuple[str, ...]) -> Callable[[str], Any]:
    """A module's `__getattr__` that finds, with a DeprecationWarning, in the modules `new` what was in `old`."""

    def look_up(name: str) -> Any:
        for place in () if name.startswith("__") else new:
            module = importlib.import_module(place)
            if hasattr(module, name):
                warnings.warn(f"{old}.{name} is now {place}.{name}", DeprecationWarning, stacklevel=2)
                return getattr(module, name)
        raise AttributeError(f"module {old!r} has no attribute {name!r}")

    return look_up


def keep_old_paths(moved: Mapping[str, tuple[str, ...]]) -> None:
    """Make the old paths importable."""
    sys.meta_path.append(MovedModules(moved))
