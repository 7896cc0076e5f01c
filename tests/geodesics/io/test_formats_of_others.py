"""Files as VTK, brain software and packers write them: read as their own writers mean them, or refused by name."""

from __future__ import annotations

import gzip
import sys
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from file_cases import OBJ, OFF, PLY, STL, V_TEXT, F, V, binary_ply
from generated_shapes import bumpy_sphere, rectangle
from other_formats import CELLS, FREESURFER, OTHERS, gifti, lz4_block, vtk, vtp, words

from geodesics import FormatError, MeshError, read_mesh, read_with_notes, write_mesh
from geodesics.errors import MissingExtra
from geodesics.io.lz4 import unpacked_block

needs_vtk = pytest.mark.skipif(find_spec("vtk") is None, reason="vtk is not installed")
needs_nibabel = pytest.mark.skipif(find_spec("nibabel") is None, reason="nibabel is not installed")


def poly_data(mesh: Any) -> Any:
    import pyvista

    faces = np.column_stack([np.full(mesh.n_faces, 3), mesh.faces])
    data = pyvista.PolyData(mesh.vertices, faces.ravel())
    data["height"] = mesh.vertices[:, 2]
    data["names"] = np.array([f"vertex {i}" for i in range(mesh.n_vertices)])
    data.field_data["who"] = ["me and you"]
    return data


@needs_vtk
@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("version", [42, 51])
def test_legacy_files_of_vtk_itself(tmp_path: Path, version: int, binary: bool) -> None:
    import vtk as library

    mesh = bumpy_sphere(2)
    writer = library.vtkPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtk"))
    writer.SetFileVersion(version)
    writer.SetFileType(2 if binary else 1)
    data = poly_data(mesh)
    if not binary:
        data.points = data.points.astype(np.float64)
    writer.SetInputData(data)
    assert writer.Write()
    again = read_mesh(tmp_path / "a.vtk")
    assert np.array_equal(again.faces, mesh.faces)
    assert np.abs(again.vertices - mesh.vertices).max() < (1e-15 if binary else 1e-5)


@needs_vtk
@pytest.mark.parametrize("mode", ["ascii", "binary", "appended", "raw"])
@pytest.mark.parametrize("compressor", [None, "vtkZLibDataCompressor", "vtkLZMADataCompressor"])
@pytest.mark.parametrize("order", ["little", "big"])
@pytest.mark.parametrize("header", [32, 64])
def test_xml_files_of_vtk_itself(tmp_path: Path, mode: str, compressor: str | None, order: str, header: int) -> None:
    import vtk as library

    mesh = bumpy_sphere(2)
    writer = library.vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetInputData(poly_data(mesh))
    writer.SetHeaderType(header)
    writer.SetBlockSize(1024)
    (writer.SetByteOrderToLittleEndian if order == "little" else writer.SetByteOrderToBigEndian)()
    writer.SetCompressor(getattr(library, compressor)() if compressor else None)
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}.get(mode, writer.SetDataModeToAppended)()
    writer.SetEncodeAppendedData(mode == "appended")
    assert writer.Write()
    again = read_mesh(tmp_path / "a.vtp")
    assert np.array_equal(again.faces, mesh.faces)
    assert np.abs(again.vertices - mesh.vertices).max() < (1e-5 if mode == "ascii" else 1e-15)


@needs_vtk
def test_a_surface_in_an_unstructured_grid(tmp_path: Path) -> None:
    import pyvista

    mesh = rectangle(4, 3)
    grid = poly_data(mesh).cast_to_unstructured_grid()
    for name in ("a.vtu", "a.vtk"):
        grid.save(tmp_path / name)
        assert np.array_equal(read_mesh(tmp_path / name).faces, mesh.faces)
    pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid().save(tmp_path / "b.vtu")
    with pytest.raises(FormatError, match=r"E203.*b\.vtu.*type 1[12].*extract the surface"):
        read_mesh(tmp_path / "b.vtu")
    pyvista.ImageData(dimensions=(3, 3, 1)).save(tmp_path / "c.vtk")
    with pytest.raises(FormatError, match=r"E203.*STRUCTURED_POINTS hold no surface"):
        read_mesh(tmp_path / "c.vtk")


@needs_vtk
def test_our_vtp_is_read_by_vtk(tmp_path: Path) -> None:
    import pyvista

    mesh = bumpy_sphere(2)
    write_mesh(mesh, tmp_path / "a.vtp")
    data = pyvista.read(tmp_path / "a.vtp")
    assert np.array_equal(data.points, mesh.vertices)
    assert np.array_equal(data.faces.reshape(-1, 4)[:, 1:], mesh.faces)
    again = read_mesh(tmp_path / "a.vtp")
    assert np.array_equal(again.vertices, mesh.vertices) and np.array_equal(again.faces, mesh.faces)


@needs_vtk
@pytest.mark.parametrize("how", [1, 2])
def test_what_vtk_compresses_by_lz4_is_read(tmp_path: Path, how: int) -> None:
    import pyvista
    import vtk as library

    mesh = bumpy_sphere(3)
    writer = library.vtkXMLPolyDataWriter()
    writer.SetInputData(pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces))
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetDataMode(how)
    writer.SetCompressorTypeToLZ4()
    writer.Write()
    again = read_mesh(tmp_path / "a.vtp")
    assert np.array_equal(again.vertices, mesh.vertices) and np.array_equal(again.faces, mesh.faces)


@pytest.mark.parametrize("content", [b"", b"a", b"abcdefgh" * 99, bytes(range(256)) * 3, bytes(4000)])
def test_a_block_of_lz4_is_what_was_packed_or_is_refused(content: bytes) -> None:
    block = lz4_block(content)
    assert unpacked_block(block, len(content)) == content
    for cut in range(len(block)):  # a cut between two sequences cannot be seen here: the array is too short then
        with suppress(ValueError):
            assert content.startswith(unpacked_block(block[:cut], len(content)))
    if content:
        with pytest.raises(ValueError, match=r"more than|outside"):
            unpacked_block(block, len(content) - 1)


def test_pieces_of_a_vtp_follow_each_other(tmp_path: Path) -> None:
    (tmp_path / "a.vtp").write_bytes(vtp(pieces=2))
    mesh = read_mesh(tmp_path / "a.vtp")
    assert np.array_equal(mesh.vertices, np.vstack([V, V]))
    assert np.array_equal(mesh.faces, np.vstack([F[:2], F[2:] + 4]))


@needs_nibabel
@pytest.mark.parametrize("encoding", ["ASCII", "Base64Binary", "GZipBase64Binary"])
def test_brains_as_nibabel_writes_them(tmp_path: Path, encoding: str) -> None:
    import nibabel

    mesh = bumpy_sphere(2)
    arrays = [
        nibabel.gifti.GiftiDataArray(mesh.vertices.astype("f4"), "NIFTI_INTENT_POINTSET", encoding=encoding),
        nibabel.gifti.GiftiDataArray(mesh.faces.astype("i4"), "NIFTI_INTENT_TRIANGLE", encoding=encoding),
    ]
    nibabel.save(nibabel.gifti.GiftiImage(darrays=arrays), tmp_path / "a.surf.gii")
    nibabel.freesurfer.write_geometry(tmp_path / "lh.pial", mesh.vertices, mesh.faces)
    for name in ("a.surf.gii", "lh.pial"):
        again = read_mesh(tmp_path / name)
        assert np.array_equal(again.faces, mesh.faces)
        assert np.abs(again.vertices - mesh.vertices).max() < 1e-5


@pytest.mark.parametrize("content", [gifti(), FREESURFER])
def test_without_nibabel_the_extra_is_named(tmp_path: Path, content: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nibabel", None)
    (tmp_path / "a").write_bytes(content)
    with pytest.raises(MissingExtra, match=r"E602.*'nibabel.*the extra 'neuro'"):
        read_mesh(tmp_path / "a")


VTP = vtp("ascii").decode()
ODD = vtp().replace(b'header_type="UInt32"', b'header_type="UInt32" compressor="vtkOddDataCompressor"')
BOMB = '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "c">]><VTKFile type="PolyData">&b;</VTKFile>'
REFUSED: list[tuple[str, str | bytes, str, str]] = [
    ("points.vtk", vtk().replace(b"POINTS", b"PINTS"), "E207", "line 5"),
    ("no_points.vtk", "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n", "E200", "no POINTS"),
    ("encoding.vtk", vtk().replace(b"ASCII", b"EBCDIC"), "E200", "line 3"),
    ("count.vtk", vtk().replace(b"POINTS 4", b"POINTS 99999"), "E205", "line 5"),
    ("short.vtk", vtk(binary=True)[:150], "E204", "byte"),
    ("short_text.vtk", vtk()[:110], "E204", "line"),
    ("index.vtk", vtk().replace(b"3 0 2 3", b"3 0 2 7"), "E105", "face 1"),
    ("low.vtk", vtk().replace(b"3 0 2 3", b"3 0 2 -3"), "E105", "face 1"),
    ("degree.vtk", vtk().replace(b"3 0 2 3", b"9 0 2 3"), "E205", "cell"),
    ("token.vtk", vtk().replace(b"-1.0", b"-1,0"), "E207", "comma"),
    ("offsets.vtk", vtk("5.1").replace(b"\n3\n6\n", b"\n7\n6\n"), "E205", "offsets"),
    ("half.vtk", vtk().replace(b"3 0 2 3", b"3 0 2 2.5"), "E108", "whole"),
    ("volume.vtk", vtk(grid=True).replace(b"CELL_TYPES 4\n5", b"CELL_TYPES 4\n10"), "E203", "cell 0"),
    ("xml.vtp", vtp()[:-30], "E204", "XML"),
    ("kind.vtp", vtp().replace(b"PolyData", b"ImageData"), "E203", "ImageData"),
    ("compressor.vtp", ODD, "E209", "vtkOddDataCompressor"),
    ("bomb.vtp", BOMB, "E209", "entities"),
    ("utf16.vtp", BOMB.encode("utf-16"), "E209", "entities"),
    ("counts.vtp", VTP.replace('NumberOfPolys="4"', 'NumberOfPolys="5"'), "E204", "4 offsets"),
    ("points.vtp", VTP.replace('NumberOfPoints="4"', 'NumberOfPoints="5"'), "E204", "5 points"),
    ("word.vtp", VTP.replace('NumberOfPoints="4"', 'NumberOfPoints="x"'), "E200", "'x'"),
    ("token.vtp", VTP.replace("1.0 1.0 1.0", "1.0 x 1.0"), "E207", "no number"),
    ("base64.vtp", vtp().replace(b"AAA", b"A!A", 1), "E204", "base64"),
    ("index.vtp", VTP.replace('format="ascii">\n0\n', 'format="ascii">\n8\n', 1), "E105", "face 0 = [8 1 2]"),
    ("appended.vtp", vtp("raw").replace(b"</AppendedData>", b""), "E204", "appended"),
    ("packed.off.gz", gzip.compress(OFF.encode())[:-12], "E204", "gzip"),
    ("packed_empty.off.gz", gzip.compress(b" \n"), "E201", "empty"),
    ("bomb.off.gz", gzip.compress(OFF.encode() + bytes(1 << 25)), "E221", "come out"),
    ("external.gii", gifti().replace(b'ExternalFileName=""', b'ExternalFileName="/etc/passwd"'), "E222", "not opened"),
    ("dims.gii", gifti().replace(b'Dim0="4"', b'Dim0="400000"'), "E205", "400000"),
    ("bomb.gii", gifti().replace(b'Dim0="4"', b'Dim0="2"'), "E221", "unpacks"),
    ("dim.gii", gifti().replace(b'Dim0="4"', b'Dim0="x"'), "E205", "whole"),
    ("counts.pial", FREESURFER.replace(b"\0\0\0\4", b"\0\0\1\4", 1), "E204", "260 vertices"),
    ("header.pial", FREESURFER[:20], "E204", "counts"),
    ("short.asc", "#!ascii\n4 4\n" + V_TEXT, "E204", "lines follow"),
    ("index.asc", "#!ascii\n4 1\n" + V_TEXT + "0 1 4 0\n", "E105", "line 7"),
    *[(f"other{i}", content, "E203", says) for i, (content, says) in enumerate([
        (b"Kaydara FBX Binary  \0\x1a\0", "FBX"), ("BLENDER-v300", "Blender"), (b"PK\3\4 and more", "zip"),
        ("ISO-10303-21;\n", "STEP"), ("<COLLADA></COLLADA>", "COLLADA"), ("$MeshFormat\n4.1 0 8\n", "Gmsh"),
        ("#VRML V2.0 utf8\n", "VRML"), ("<html>", "web page")])],
]  # fmt: skip


@pytest.mark.parametrize(("name", "content", "code", "says"), REFUSED, ids=[case[0] for case in REFUSED])
def test_refused(tmp_path: Path, name: str, content: str | bytes, code: str, says: str) -> None:
    if name.endswith((".gii", ".pial")):
        pytest.importorskip("nibabel")
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises((FormatError, MeshError)) as caught:
        read_mesh(tmp_path / name)
    assert caught.value.code == code and says in str(caught.value) and name in str(caught.value), str(caught.value)


def test_more_than_declared_is_told_and_no_error(tmp_path: Path) -> None:
    by_name = {name: content for _, name, content in OTHERS}
    for name in ("longer.ply", "longer_text.ply", "longer.stl", "longer.glb"):
        content = by_name[name]
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        assert "W220" in [note.code for note in read_with_notes(tmp_path / name)[1]]


UNKNOWN = ["nan", "NaN", "-nan(ind)", "inf", "1.#QNAN", "-1.#IND"]


@pytest.mark.parametrize("word", UNKNOWN)
def test_a_vertex_without_a_position_that_no_face_needs(tmp_path: Path, word: str) -> None:
    """It keeps its row, and lies in the middle of the others."""
    lost = f"{word} 0 0\n"
    files = {
        "a.off": OFF.replace("4 4 6", "5 4 6").replace("-1 -1 1\n", f"-1 -1 1\n{lost}"),
        "a.obj": OBJ.replace("f 1 2 3", f"v {lost}f 1 2 3"),
        "a.ply": PLY.replace("vertex 4", "vertex 5").replace("-1 -1 1\n", f"-1 -1 1\n{lost}"),
        "a.vtk": f"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n{V_TEXT}{lost}"
        f"POLYGONS 4 16\n{words(CELLS)}",
    }
    for name, content in files.items():
        (tmp_path / name).write_text(content)
        mesh, notes = read_with_notes(tmp_path / name)
        assert np.array_equal(mesh.vertices, np.vstack([V, V.mean(axis=0)])) and np.array_equal(mesh.faces, F)
        assert [(note.code, note.indices) for note in notes] == [("W221", (4,))]
        (tmp_path / name).write_text(content.replace("-1 1 -1", f"-1 {word} -1"))
        with pytest.raises(MeshError, match=r"E101.*first \[2\]"):
            read_mesh(tmp_path / name)


def test_a_binary_vertex_without_a_position(tmp_path: Path) -> None:
    head, body = binary_ply().split(b"end_header\n", 1)
    content = head.replace(b"vertex 4", b"vertex 5") + b"end_header\n" + body[:96]
    (tmp_path / "a.ply").write_bytes(content + np.full(3, np.nan).tobytes() + body[96:])
    mesh, notes = read_with_notes(tmp_path / "a.ply")
    assert mesh.n_vertices == 5 and [note.code for note in notes] == ["W221"]


@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".stl", ".glb", ".vtp"])
def test_packed_files_are_written_and_read(tmp_path: Path, suffix: str) -> None:
    mesh = bumpy_sphere(1)
    write_mesh(mesh, tmp_path / f"a{suffix}")
    write_mesh(mesh, tmp_path / f"b{suffix}.gz")
    assert gzip.decompress((tmp_path / f"b{suffix}.gz").read_bytes()) == (tmp_path / f"a{suffix}").read_bytes()
    assert np.array_equal(read_mesh(tmp_path / f"a{suffix}").faces, read_mesh(tmp_path / f"b{suffix}.gz").faces)
    with pytest.raises(FormatError, match="E203"):
        write_mesh(mesh, tmp_path / "a.xyz.gz")


def test_a_packed_tosca_shape(tmp_path: Path) -> None:
    mesh = bumpy_sphere(1)
    write_mesh(mesh, tmp_path / "cat.vert")
    for name in ("cat.vert", "cat.tri"):
        content = (tmp_path / name).read_bytes()
        (tmp_path / name).unlink()
        (tmp_path / f"{name}.gz").write_bytes(gzip.compress(content))
    assert np.array_equal(read_mesh(tmp_path / "cat.tri.gz").vertices, mesh.vertices)
    with pytest.raises(FormatError, match=r"E203.*packed"):
        write_mesh(mesh, tmp_path / "a.tri.gz")


def test_a_text_of_stl_that_begins_as_a_binary_one(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_text("\n\t " + STL)
    assert np.array_equal(read_mesh(tmp_path / "a.stl").faces, F)
