"""Folders of meshes."""

from __future__ import annotations

from pathlib import Path

from geodesics.errors import FormatError

SUFFIXES = (".off", ".obj", ".ply", ".stl", ".glb", ".vert")


def mesh_files(folder: Path) -> list[Path]:
    """The mesh files of a folder in the order of their names; of a TOSCA pair the .vert. FormatError if there are none.

    Where two files differ in their suffix alone, the first counts.
    """
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder} is not a folder")
    found: dict[str, Path] = {}
    for path in sorted(p for p in folder.iterdir() if p.is_file() and p.suffix.lower() in SUFFIXES):
        found.setdefault(path.stem, path)
    if not found:
        raise FormatError(f"{folder} has no mesh files ({', '.join(SUFFIXES)})")
    return list(found.values())
