"""The shortest and the longest files, and what remains where writing a file fails."""

from __future__ import annotations

import os
import secrets
import stat
from pathlib import Path

import numpy as np
import pytest
from file_cases import OFF, PLY_HEAD, STL_BINARY, F, V
from generated_shapes import icosphere

from geodesics import FormatError, MeshError, read_mesh, write_mesh
from geodesics.errors import LineTooLong
from geodesics.io.opening import LONGEST_LINE

DIGITS = [(i % 10, i // 10 % 10, i % 7) for i in range(300)]  # no vertex line can be shorter
CORNERS = [(i % 8, i % 8 + 1, 9) for i in range(300)]


@pytest.mark.parametrize(("vertices", "faces"), [(300, 1), (10, 300)])
def test_no_count_is_too_large_for_the_shortest_lines_there_are(tmp_path: Path, vertices: int, faces: int) -> None:
    lines = [*(" ".join(map(str, row)) for row in DIGITS[:vertices])]
    lines += [f"3 {a} {b} {c}" for a, b, c in CORNERS[:faces]]
    head = PLY_HEAD.replace("vertex 4", f"vertex {vertices}").replace("face 4", f"face {faces}")
    for name, content in (("a.off", f"OFF {vertices} {faces}\n"), ("a.ply", head)):
        (tmp_path / name).write_text(content + "\n".join(lines) + "\n")
        mesh = read_mesh(tmp_path / name)
        assert mesh.vertices.tolist() == [list(map(float, row)) for row in DIGITS[:vertices]]
        assert mesh.faces.tolist() == [list(row) for row in CORNERS[:faces]]


def test_a_line_may_be_a_megabyte_and_no_more(tmp_path: Path) -> None:
    for length in (LONGEST_LINE, LONGEST_LINE + 1):
        for name, before in (("first.off", ""), ("later.off", "#\n" * LONGEST_LINE)):
            (tmp_path / name).write_text(OFF[:4] + before + "#".ljust(length, "x") + "\n" + OFF[4:])
            if length == LONGEST_LINE:
                assert np.array_equal(read_mesh(tmp_path / name).faces, F)
            else:
                with pytest.raises(LineTooLong, match=f"longer than {LONGEST_LINE}"):
                    read_mesh(tmp_path / name)


def test_binary_files_have_no_lines(tmp_path: Path) -> None:
    """Three megabytes without the byte of a newline are no line that is too long."""
    many = 15_000
    facets = STL_BINARY[84:] * many
    assert b"\n" not in facets and b"\r" not in facets
    (tmp_path / "a.stl").write_bytes(bytes(80) + (4 * many).to_bytes(4, "little") + facets)
    mesh = read_mesh(tmp_path / "a.stl")
    assert np.array_equal(mesh.vertices, V) and np.array_equal(mesh.faces, np.tile(F, (many, 1)))


@pytest.mark.parametrize(
    ("line", "code"), [("1 2", "E204"), ("1 2 3 4", "E206"), ("0 1 2", "E105"), ("1 2 5", "E105"), ("1 2 x", "E207")]
)
def test_a_triangle_of_tosca_has_three_vertices_counted_from_one(tmp_path: Path, line: str, code: str) -> None:
    write_mesh(icosphere(0), tmp_path / "a.tri")
    (tmp_path / "a.vert").write_text("\n".join(" ".join(map(str, row)) for row in V.tolist()))
    (tmp_path / "a.tri").write_text(f"1 2 3\n1 3 4\n{line}\n")
    with pytest.raises((FormatError, MeshError), match=rf"{code}: .*a\.tri, line 3"):
        read_mesh(tmp_path / "a.vert")


def test_the_stem_of_a_tosca_shape_may_have_a_dot(tmp_path: Path) -> None:
    write_mesh(icosphere(0), tmp_path / "cat.1.tri")
    assert sorted(os.listdir(tmp_path)) == ["cat.1.tri", "cat.1.vert"]
    assert read_mesh(tmp_path / "cat.1").n_vertices == 12


def test_files_are_as_others_make_them_readable_and_no_programs(tmp_path: Path) -> None:
    before = os.umask(0o022)
    try:
        write_mesh(icosphere(0), tmp_path / "a.off")
        (tmp_path / "b.off").write_text("")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.off").stat().st_mode) == stat.S_IMODE((tmp_path / "b.off").stat().st_mode)


def test_a_link_laid_where_the_half_written_file_will_be_is_not_followed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(secrets, "token_hex", lambda *_: "known")
    (tmp_path / "precious").write_text("old")
    for target in ("precious", "not there"):
        (tmp_path / ".gmds-known.tmp").symlink_to(tmp_path / target)
        with pytest.raises(FileExistsError):
            write_mesh(icosphere(0), tmp_path / "a.off")
        assert (tmp_path / "precious").read_text() == "old" and not (tmp_path / "not there").exists()
