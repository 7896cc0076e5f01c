"""Broken mesh files by row of the reliability table: name, content, the code they must get, what the error says."""

from __future__ import annotations

import struct

import numpy as np
from file_cases import OBJ, OFF, PLY, PLY_HEAD, STL, STL_BINARY, F, V, binary_ply, glb, one_view, setting


def json_alone() -> bytes:
    """A GLB that ends before its numbers."""
    whole = glb()
    end = 20 + int.from_bytes(whole[12:16], "little")
    return whole[:8] + struct.pack("<I", end) + whole[12:end]


REFUSED: list[tuple[str, str, str | bytes, str, str]] = [
    *[("F01", f"empty.{kind}", b"", "E201", "empty") for kind in ("off", "obj", "ply", "stl", "glb", "vert", "tri")],
    ("F01", "blank.off", b" \n\n", "E201", "empty"),
    ("F06", "text.txt", "this is no mesh\n", "E203", "OFF, OBJ, PLY, STL, GLB"),
    ("F06", "picture.off", b"\x89PNG\r\n\x1a\n" + bytes(100), "E203", "supported"),
    ("F06", "backtracking.obj", b"#   \n" * 3000 + b"!", "E203", "supported"),
    ("F06", "binary.off", b"OFF BINARY\n" + bytes(100), "E203", "ASCII OFF"),
    ("F06", "four.off", "4OFF\n1 1 0\n0 0 0 1\n3 0 0 0\n", "E203", "three dimensions"),
    ("F07", "header.off", "OFF\n", "E204", "counts"),
    ("F07", "short.off", OFF[:-8], "E204", "4 faces are declared"),
    ("F07", "short_vertex.off", OFF.replace("-1 -1 1\n", "-1 -1\n"), "E204", "line 6"),
    ("F07", "short.ply", PLY[:-8], "E204", "4 of face"),
    ("F07", "header.ply", PLY_HEAD[:-5], "E204", "end_header"),
    ("F07", "declared.obj", "# Faces: 5\n" + OBJ, "E204", "5 faces"),
    *[("F08", f"count{i}.off", OFF.replace("4 4 6", f"{n} 4 6"), "E205", "line 2")
      for i, n in enumerate(["20", "2000000000", str(2**63), "9" * 5000, "-4", "four", "4.0", "1_0", "2e9"])],
    *[("F08", f"faces{i}.off", OFF.replace("4 4 6", f"4 {n} 6"), "E205", "line 2")
      for i, n in enumerate(["2000000000", "-1", "x"])],
    ("F08", "count.off", OFF.replace("4 4 6", "4"), "E205", "line 2"),
    *[("F08", f"count{i}.ply", PLY.replace("vertex 4", f"vertex {n}"), "E205", "line 3")
      for i, n in enumerate(["2000000000", "9223372036854775808", "-4", "four"])],
    ("F08", "counts.ply", PLY.replace("vertex 4", "vertex 100"), "E204", "promises"),
    ("F09", "degree.off", OFF.replace("3 1 3 2", "1000000000 1 3 2"), "E206", "line 10"),
    ("F09", "degree_negative.off", OFF.replace("3 1 3 2", "-1 1 3 2"), "E206", "-1 corners"),
    ("F09", "degree.ply", PLY.replace("3 1 3 2", "1000000000 1 3 2"), "E206", "line 17"),
    ("F09", "degree_negative.ply", PLY.replace("3 1 3 2", "-3 1 3 2"), "E206", "line 17"),
    ("F09", "degree2_binary.ply", PLY_HEAD.replace("ascii", "binary_little_endian").encode() + V.astype("<f4").tobytes()
     + struct.pack("<B2i", 2, 0, 1) * 4, "E104", "no faces"),
    ("F09", "edges_alone.obj", OBJ.replace("f 2 4 3", "f 2 4").split("f 1", 1)[0] + "f 1 2\nf 3\n", "E104", "no faces"),
    ("F09", "degree_binary.ply", binary_ply().replace(b"\x03\0\0\0\0", b"\xff\0\0\0\0"), "E204", "promises"),
    *[("F10", f"token{i}.off", OFF.replace("1 -1 -1", f"1 {t} -1"), "E207", "line 4")
      for i, t in enumerate(["1,5", "0x10", "1_000", "1e", "--1", "1.2.3", "\uff11", "ind", "nano", "1..QNAN"])],
    *[("F10", f"unknown{i}.off", OFF.replace("1 -1 -1", f"1 {t} -1"), "E101", "first [1]")
      for i, t in enumerate(["nan", "inf", "-Infinity", "-nan(ind)", "1.#QNAN", "-1.#IND00", "1#INF"])],
    ("F10", "huge.off", OFF.replace("1 -1 -1", "1 1e400 -1"), "E101", "huge.off"),
    ("F10", "comma.obj", OBJ.replace("v 1 -1 -1", "v 1,0 -1,0 -1,0"), "E207", "point, not a comma"),
    ("F10", "comma.ply", PLY.replace("1 -1 -1", "1,0 -1,0 -1,0"), "E207", "comma"),
    ("F10", "comma.stl", STL.replace("vertex 1.0 -1.0", "vertex 1,0 -1,0"), "E207", "comma"),
    ("F10", "nan.ply", PLY.replace("1 -1 -1", "nan -1 -1"), "E101", "first [1]"),
    ("F10", "nan_binary.ply", binary_ply().replace(struct.pack("<d", -1.0), struct.pack("<d", np.nan)), "E101", "NaN"),
    ("F10", "degree_word.off", OFF.replace("3 1 3 2", "3.0 1 3 2"), "E207", "line 10"),
    *[("F11", f"index{i}.off", OFF.replace("3 1 3 2", f"3 1 {t} 2"), "E105", "line 10")
      for i, t in enumerate(["4", "-1", "1" * 20, "4294967297"])],
    ("F11", "index_word.off", OFF.replace("3 1 3 2", "3 1 x 2"), "E207", "line 10"),
    ("F11", "index.ply", PLY.replace("3 1 3 2", "3 1 -3 2"), "E105", "line 17"),
    ("F11", "index_binary.ply", binary_ply().replace(struct.pack("<3i", 1, 3, 2), struct.pack("<3i", 1, -3, 2)), "E105",
     "face 3"),
    ("F11", "index_float.ply", binary_ply("<", "uchar", "float"), "E207", "not integers"),
    *[("F11", f"index{i}.obj", OBJ.replace("f 2 4 3", f"f 2 {t} 3"), "E105", "line 8")
      for i, t in enumerate(["0", "5", "-5", "1" * 20])],
    ("F13", "count.stl", STL_BINARY[:80] + struct.pack("<I", 5) + STL_BINARY[84:], "E204", "5 triangles"),
    ("F13", "no_facets.stl", bytes(84), "E103", "no vertices"),
    ("F13", "no_count.stl", bytes(83), "E204", "83"),
    ("F13", "facet.stl", STL.replace("endloop", "", 1), "E204", "endloop"),
    ("F14", "type.ply", PLY.replace("property float x", "property quaternion x"), "E207", "line 4"),
    ("F14", "no_vertex.ply", PLY.replace("element vertex", "element point"), "E200", "no vertices"),
    ("F14", "no_face.ply", PLY.replace("element face", "element side"), "E104", "no faces"),
    ("F14", "no_face_binary.ply", binary_ply().replace(b"element face", b"element side"), "E104", "no faces"),
    ("F14", "keyword.ply", PLY.replace("end_header", "elements 3\nend_header"), "E207", "line 9"),
    ("F14", "early.ply", PLY.replace("element vertex", "property int i\nelement vertex"), "E207", "line 3"),
    ("F14", "element.ply", PLY.replace("vertex 4", "vertex 4 5"), "E207", "line 3"),
    ("F14", "list.ply", PLY.replace("list uchar int", "list uchar"), "E207", "line 8"),
    ("F14", "list_type.ply", PLY.replace("list uchar int", "list uchar quaternion"), "E207", "line 8"),
    ("F14", "columns.ply", PLY.replace("-1 1 -1", "-1 1"), "E204", "line 12"),
    ("F14", "list_length.ply", PLY.replace("3 0 3 1", "4 0 3 1"), "E206", "line 16"),
    ("F14", "list_length_word.ply", PLY.replace("3 0 3 1", "x 0 3 1"), "E207", "line 16"),
    ("F14", "axis.ply", PLY.replace("property float x", "property float u"), "E200", "x, y, z"),
    ("F14", "encoding.ply", PLY.replace("ascii", "ebcdic"), "E200", "ebcdic"),
    ("F14", "indices.ply", PLY.replace("vertex_indices", "things"), "E200", "vertex_indices"),
    ("F15", "line.obj", "v " + "1 " * 900_000, "E208", "longer than"),
    ("F17", "lengths.glb", glb()[:-4], "E204", "length"),
    ("F17", "json.glb", glb().replace(b'{"asset', b'{{asset'), "E209", "JSON"),
    ("F17", "count.glb", glb(setting("accessors", 0, "count", value=10**9)), "E209", "accessor 0"),
    ("F17", "view.glb", glb(setting("bufferViews", 1, "byteLength", value=10**12)), "E209", "accessor 1"),
    ("F17", "negative.glb", glb(setting("accessors", 0, "count", value=-4)), "E209", "negative"),
    ("F17", "header.glb", glb()[:19], "E204", "19 bytes"),
    ("F17", "version.glb", glb().replace(b"glTF\2", b"glTF\1"), "E209", "version 2"),
    ("F17", "points.glb", glb(setting("meshes", 0, "primitives", 0, "mode", value=0)), "E104", "triangulated"),
    ("F17", "no_indices.glb", glb(lambda t: t["meshes"][0]["primitives"][0].pop("indices")), "E209", "4 corners"),
    ("F17", "sparse.glb", glb(setting("accessors", 0, "sparse", value={})), "E209", "malformed"),
    ("F17", "offset.glb", glb(lambda t: (one_view(t), t["accessors"][1].update(byteOffset=49))), "E209", "24 bytes"),
    ("F17", "view_offset.glb", glb(setting("bufferViews", 1, "byteOffset", value=49)), "E209", "accessor 1"),
    ("F17", "before.glb", glb(setting("bufferViews", 0, "byteOffset", value=-1)), "E209", "negative"),
    ("F17", "node.glb", glb(setting("nodes", 0, "mesh", value=7)), "E209", "meshes 7"),
    ("F17", "quantity.glb", glb(setting("accessors", 0, "type", value="VEC4")), "E209", "malformed"),
    ("F17", "no_data.glb", json_alone(), "E209", "needs 48 bytes"),
    ("F17", "nothing.glb", glb(lambda t: t.clear()), "E209", "0 mesh parts"),
    ("F17", "types.glb", glb(setting("meshes", value={"a": 1})), "E209", "malformed"),
    ("S03", "uri.glb", glb(setting("buffers", 0, "uri", value="../../etc/passwd")), "E222", "not opened"),
    ("S01", "pickle.npy", b"\x93NUMPY\x01\x00", "E203", "supported"),
]  # fmt: skip
# Not as the format has it, and read all the same: what is left out or missing is told.
TOLD: list[tuple[str, str, str, np.ndarray]] = [
    *[("F09", f"degree{i}.off", OFF.replace("3 1 3 2", f"{i} 1 3 2"), F[:3]) for i in range(3)],
    ("F09", "degree2.ply", PLY.replace("3 1 3 2", "2 1 3"), F[:3]),
    ("F09", "degree.obj", OBJ.replace("f 2 4 3", "f 2 4"), F[:3]),
    ("F13", "open.stl", STL.replace("endsolid thing\n", ""), F),
]
