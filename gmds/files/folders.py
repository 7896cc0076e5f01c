"""Folders of meshes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from geodesics.errors import FormatError

SUFFIXES = (".off", ".obj", ".ply", ".stl", ".glb", ".vert")


def mesh_files(folder: Path) -> list[Path]:
    """The mesh files of a folder, in the order of their names; of a TOSCA pair the .vert. FormatError without any."""
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder} is not a folder")
    found = sorted(p for p in folder.iterdir() if p.is_file() and p.suffix.lower() in SUFFIXES)
    if not found:
        raise FormatError(f"{folder} has no mesh files ({', '.join(SUFFIXES)})")
    return found


def shape_names(paths: Sequence[Path]) -> list[str]:
    """What shapes in files are called: the name without its suffix, or with it where two are the same but for it."""
    often = Counter(path.stem.casefold() for path in paths)
    return [path.stem if often[path.stem.casefold()] == 1 else path.name for path in paths]
