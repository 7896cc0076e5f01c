"""Folders of meshes."""

from __future__ import annotations

import errno
import os
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from geodesics.errors import FormatError

SUFFIXES = (".off", ".obj", ".ply", ".stl", ".glb", ".gltf", ".vtk", ".vtp", ".vtu", ".gii", ".vert")
PACKED = ".gz"  # may follow any of them
LONGEST_NAME = 100  # bytes of a name: two of them and a little more make the name of a file, which may have 255


def mesh_files(folder: Path) -> list[Path]:
    """The mesh files of a folder, in the order of their names; of a TOSCA pair the .vert. FormatError without any."""
    if not folder.exists():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(folder))
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "it is a file, where a folder of meshes is expected", str(folder))
    found = sorted(path for path in folder.iterdir() if is_mesh_file(path))
    if not found:
        inner = ", ".join(path.name for path in inner_folders(folder)[:5])
        hint = f", but folders that have: {inner}; name one of these" if inner else ""
        raise FormatError(f"{folder} has no mesh files ({', '.join(SUFFIXES)}){hint}")
    return found


def inner_folders(folder: Path) -> list[Path]:
    """The folders inside a folder in which there are meshes; `mesh_files` does not look into them."""
    inside = sorted(path for path in folder.iterdir() if path.is_dir() and os.access(path, os.R_OK | os.X_OK))
    return [path for path in inside if any(is_mesh_file(one) for one in path.iterdir())]


def is_mesh_file(path: Path) -> bool:
    """Whether there is a file with the ending of a mesh."""
    return path.is_file() and _unpacked(path).suffix.lower() in SUFFIXES


def shape_names(paths: Sequence[Path]) -> list[str]:
    """What shapes in files are called: the name without its suffix, or with it where two are the same but for it."""
    stems = [_unpacked(path).stem for path in paths]
    often = Counter(stem.casefold() for stem in stems)
    return [stem if often[stem.casefold()] == 1 else path.name for stem, path in zip(stems, paths, strict=True)]


def plain_name(text: str) -> str:
    """A name that can stand in the name of a file A__B: no spaces, no two underscores in a row, not too long."""
    kept = re.sub(r"_{2,}", "_", re.sub(r"[^\w.-]", "_", text)).strip("_").lstrip(".-") or "shape"
    return kept.encode("utf-8", "ignore")[:LONGEST_NAME].decode("utf-8", "ignore").strip("_")


def _unpacked(path: Path) -> Path:
    """The path of what is packed in a file, else its own."""
    return path.with_suffix("") if path.suffix.lower() == PACKED else path
