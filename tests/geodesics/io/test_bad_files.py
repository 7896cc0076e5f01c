"""Files that callers give, by row of the reliability table (F01-F17, S01, S03): a typed error, or the mesh."""

from __future__ import annotations

import os
import stat
import struct
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from broken_files import REFUSED, TOLD
from child_reader import read_in_child
from file_cases import OBJ, OFF, PLY_HEAD, READ, STL, STL_BINARY, V_TEXT, F, V
from other_formats import NEURO, OTHERS

from geodesics import FormatError, Mesh, MeshError, read_mesh, read_with_notes, write_mesh

LEGAL = [*READ, *OTHERS, *(NEURO if find_spec("nibabel") else [])]


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Any]]:
    """What reading each file of the tables gives, all in one child process."""
    folder = tmp_path_factory.mktemp("files")
    jobs = []
    for _, name, content, *_ in [*LEGAL, *REFUSED]:
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        jobs.append({"path": str(folder / name)})
    names = [name for _, name, *_ in [*LEGAL, *REFUSED]]
    assert len(set(names)) == len(names)
    return dict(zip(names, read_in_child(jobs), strict=True))


@pytest.mark.parametrize(("row", "name"), [case[:2] for case in LEGAL])
def test_read(outcomes: dict[str, dict[str, Any]], row: str, name: str) -> None:
    outcome = outcomes[name]
    assert "code" not in outcome, outcome
    vertices, faces = np.array(outcome["vertices"]), np.array(outcome["faces"])
    assert np.array_equal(vertices, V) and np.array_equal(faces, F)  # STL: numbered by first appearance
    assert outcome["printed"] == ""


@pytest.mark.parametrize(("row", "name", "code", "says"), [(r, n, c, s) for r, n, _, c, s in REFUSED])
def test_refused(outcomes: dict[str, dict[str, Any]], row: str, name: str, code: str, says: str) -> None:
    outcome = outcomes[name]
    assert outcome.get("code") == code, outcome
    assert {"MeshError", "FormatError"} & set(outcome["kinds"])
    assert name in outcome["message"] and says in outcome["message"]
    assert outcome["printed"] == ""


@pytest.mark.parametrize("kind", ["directory", "missing", "pipe", "device", "socket"])
def test_f02_f05_paths_that_are_no_files(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "mesh.off"
    if kind == "directory":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path = Path("/dev/zero")
    elif kind == "socket":
        import socket

        server = socket.socket(socket.AF_UNIX)
        server.bind(str(path))
        server.close()
    with pytest.raises((FormatError, FileNotFoundError)) as caught:
        read_mesh(path)
    assert str(path) in str(caught.value)
    if kind != "missing":
        assert getattr(caught.value, "code", "") == "E202"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_f04_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "mesh.off"
    path.write_text(OFF)
    path.chmod(0)
    with pytest.raises(PermissionError, match=r"mesh\.off"):
        read_mesh(path)


def test_f07_a_tosca_shape_without_its_other_half(tmp_path: Path) -> None:
    (tmp_path / "a.vert").write_text(V_TEXT)
    for name in ("a", "a.vert", "a.tri"):
        with pytest.raises(FileNotFoundError, match=r"a\.tri"):
            read_mesh(tmp_path / name)


def test_f09_polygons_are_split_about_their_first_corner_and_that_is_reported(tmp_path: Path) -> None:
    quads = "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n4 0 1 2 3\n3 1 4 2\n"
    (tmp_path / "a.off").write_text(quads)
    mesh, notes = read_with_notes(tmp_path / "a.off")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
    assert [note.code for note in notes] == ["W210"] and notes[0].indices == (0,)
    ply = PLY_HEAD.replace("vertex 4", "vertex 5").replace("face 4", "face 2") + "\n".join(quads.split("\n")[2:])
    (tmp_path / "a.ply").write_text(ply)
    assert np.array_equal(read_mesh(tmp_path / "a.ply").faces, mesh.faces)
    obj = "".join(f"v {line}\n" for line in quads.split("\n")[2:7]) + "f 1 2 3 4\nf 2 5 3\n"
    (tmp_path / "a.obj").write_text(obj)
    assert np.array_equal(read_mesh(tmp_path / "a.obj").faces, mesh.faces)


@pytest.mark.parametrize(("name", "content", "faces"), [case[1:] for case in TOLD])
def test_what_is_odd_and_can_be_read_is_told(tmp_path: Path, name: str, content: str, faces: np.ndarray) -> None:
    (tmp_path / name).write_text(content)
    mesh, notes = read_with_notes(tmp_path / name)
    assert np.array_equal(mesh.vertices, V) and np.array_equal(mesh.faces, faces)
    assert {note.code for note in notes} & {"W223", "W227"}


@pytest.mark.parametrize("name", ["edges.off", "edges.obj", "edges.ply", "edges_binary.ply", "edges.vtk"])
def test_f09_faces_of_fewer_than_three_corners_are_left_out_and_that_is_told(tmp_path: Path, name: str) -> None:
    content = next(content for _, known, content in OTHERS if known == name)
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    mesh, notes = read_with_notes(tmp_path / name)
    assert np.array_equal(mesh.faces, F)
    assert [note.code for note in notes] == ["W223"] and notes[0].count == (3 if name[-4:] != ".vtk" else 2) - (
        name == "edges_binary.ply"
    )


def test_f13_an_stl_file_of_text_without_its_last_line_is_read_and_doubted(tmp_path: Path) -> None:
    (tmp_path / "open.stl").write_text(STL.replace("endsolid thing\n", ""))
    mesh, notes = read_with_notes(tmp_path / "open.stl")
    assert np.array_equal(mesh.faces, F)
    assert [(note.code, note.severity) for note in notes] == [("W211", "info"), ("W227", "warning")]
    (tmp_path / "cut.stl").write_text(STL[: STL.rindex("endloop")])
    with pytest.raises(FormatError, match=r"E204: .*within a facet"):
        read_mesh(tmp_path / "cut.stl")


def test_f09_f11_polygons_of_binary_ply_keep_their_numbers(tmp_path: Path) -> None:
    head = PLY_HEAD.replace("ascii", "binary_little_endian").replace("face 4", "face 2").encode()
    corners = V.astype("<f4").tobytes()
    for name, last in (("good", 3), ("high", 4), ("low", -1)):
        quads = struct.pack("<B4iB4i", 4, 0, 1, 2, 3, 4, 1, 0, 2, last)
        (tmp_path / f"{name}.ply").write_bytes(head + corners + quads)
    mesh, notes = read_with_notes(tmp_path / "good.ply")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 0, 2], [1, 2, 3]]
    assert [note.code for note in notes] == ["W210"]
    for name in ("high", "low"):
        with pytest.raises(MeshError, match=r"E105: .*face 1 = \[ ?1 +0 +2"):
            read_mesh(tmp_path / f"{name}.ply")


def test_f11_negative_obj_indices_count_back_from_the_vertices_so_far(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4 -2 -1\n")
    assert read_mesh(tmp_path / "a.obj").faces.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_f13_stl_corners_are_welded_exactly_and_that_is_reported(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(STL_BINARY)
    mesh, notes = read_with_notes(tmp_path / "a.stl")
    assert mesh.n_vertices == 4 and [note.code for note in notes] == ["W211"]


def test_s03_nothing_but_the_named_file_is_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.obj").write_text("mtllib secret.mtl\n" + OBJ)
    (tmp_path / "secret.mtl").write_text("newmtl a\nmap_Kd secret.png\n")
    opened: list[str] = []
    real = os.open
    monkeypatch.setattr(os, "open", lambda path, *a, **k: opened.append(str(path)) or real(path, *a, **k))
    monkeypatch.setattr("builtins.open", lambda *a, **k: pytest.fail(f"opened {a[0]}"))
    assert np.array_equal(read_mesh(tmp_path / "a.obj").faces, F)
    assert opened == [str(tmp_path / "a.obj")]


def test_f15_a_gigabyte_in_one_line_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "long.obj"
    with path.open("wb") as file:
        file.write(b"v 1 ")
        for _ in range(4):
            file.write(b"1" * (1 << 20))
        file.truncate(1 << 30)  # a sparse tail
    with pytest.raises(FormatError, match="E208"):
        read_mesh(path)


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.off"
    write_mesh(Mesh(V, F), path)
    before = path.read_bytes()

    def full(*args: Any) -> None:
        raise OSError(28, "No space left on device")

    for name in ("fsync", "replace"):
        with monkeypatch.context() as patch:
            patch.setattr(os, name, full)
            with pytest.raises(OSError, match="No space"):
                write_mesh(Mesh(2 * V, F), path)
        assert path.read_bytes() == before and os.listdir(tmp_path) == ["a.off"]
    with pytest.raises(FormatError, match="E203"):
        write_mesh(Mesh(V, F), tmp_path / "a.xyz")
    assert stat.S_IMODE(path.stat().st_mode) & 0o400
