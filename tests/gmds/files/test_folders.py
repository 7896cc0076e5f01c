"""Which files of a folder are meshes."""

from __future__ import annotations

from pathlib import Path

import pytest

from geodesics.errors import FormatError
from gmds.files.folders import mesh_files, shape_names


def test_mesh_files_are_found_once(tmp_path: Path) -> None:
    for name in ("b.ply", "a.off", "a.ply", "A.OBJ", "notes.txt", "t.vert", "t.tri"):
        (tmp_path / name).touch()
    (tmp_path / "folder.off").mkdir()
    assert [path.name for path in mesh_files(tmp_path)] == ["A.OBJ", "a.off", "a.ply", "b.ply", "t.vert"]
    assert shape_names(mesh_files(tmp_path)) == ["A.OBJ", "a.off", "a.ply", "b", "t"]
    for name in ("a.ply.gz", "c.off.GZ", "d.vtp", "x.csv.gz"):
        (tmp_path / name).touch()
    found = mesh_files(tmp_path)
    assert shape_names(found) == ["A.OBJ", "a.off", "a.ply", "a.ply.gz", "b", "c", "d", "t"]
    with pytest.raises(FormatError, match="no mesh files"):
        mesh_files(tmp_path / "folder.off")
