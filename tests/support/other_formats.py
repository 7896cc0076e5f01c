"""Sound files of the tetrahedron as programs of many kinds write them: VTK, brains, scenes, strips, packed ones."""

from __future__ import annotations

import base64
import gzip
import json
import lzma
import struct
import zlib
from typing import Any

import numpy as np
from file_cases import OBJ, OFF, PLY, PLY_HEAD, STL, STL_BINARY, V_TEXT, F, V, binary_ply, glb, setting


def words(table: np.ndarray) -> str:
    return "\n".join(" ".join(map(str, row)) for row in table.tolist()) + "\n"


CELLS = np.column_stack([np.full(4, 3), F])
OFFSETS, FLAT = np.arange(0, 13, 3), F.ravel()
METADATA = "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 1.7 1.8\n\n"


def vtk(version: str = "3.0", binary: bool = False, before: str = "", grid: bool = False) -> bytes:
    """A legacy file with its cells as this version has them, with data behind them that are of no concern."""
    kind = "UNSTRUCTURED_GRID" if grid else "POLYDATA"
    head = f"# vtk DataFile Version {version}\nsaved\n{'BINARY' if binary else 'ASCII'}\nDATASET {kind}\n{before}"
    name = "CELLS" if grid else "POLYGONS"

    def array(table: np.ndarray, dtype: str) -> bytes:
        return table.astype(dtype).tobytes() + b"\n" if binary else words(table.reshape(len(table), -1)).encode()

    out = head.encode() + b"POINTS 4 double\n" + array(V, ">f8")
    if version < "5":
        out += f"\n{name} 4 16\n".encode() + array(CELLS, ">i4")
    else:
        out += METADATA.encode() if binary else b""
        out += f"{name} 5 12\nOFFSETS vtktypeint64\n".encode() + array(OFFSETS, ">i8")
        out += b"CONNECTIVITY vtktypeint64\n" + array(FLAT, ">i8")
    if grid:
        out += b"CELL_TYPES 4\n" + array(np.full(4, 5), ">i4")
    return out + b"POINT_DATA 4\nSCALARS height float\nLOOKUP_TABLE default\n" + array(V[:, 2], ">f4")


STRIP_VTK = (
    "# vtk DataFile Version 2.0\n\nASCII\nDATASET POLYDATA\n"
    "FIELD FieldData 2\nTimeValue 1 1 double\n0.5\nwho 1 1 string\nme and you\n"
    f"POINTS 4 float\n{V_TEXT}VERTICES 1 2\n1 0\nLINES 1 3\n2 0 1\nTRIANGLE_STRIPS 4 16\n{words(CELLS)}"
)


def packed(table: np.ndarray, order: str, header: str, compress: Any) -> tuple[bytes, bytes]:
    """Header and content of an array of VTK's XML, in two blocks where it is compressed."""
    content = table.tobytes()
    number = np.dtype(f"{order}{header}")
    if compress is None:
        return b"", np.array([len(content)], number).tobytes() + content
    size = len(content) // 2 // 8 * 8
    blocks = [compress(content[:size]), compress(content[size : 2 * size]), compress(content[2 * size :])]
    blocks = blocks[: 3 if 2 * size < len(content) else 2]
    last = len(content) - 2 * size
    return np.array([len(blocks), size, last, *map(len, blocks)], number).tobytes(), b"".join(blocks)


def lz4_block(content: bytes) -> bytes:
    """A block of LZ4: four letters as they are, then what repeats the eight bytes before, as far as it does."""
    out, at, start = b"", 0, 0

    def sequence(letters: bytes, match: int) -> bytes:
        small = min(len(letters), 15) << 4 | min(max(match - 4, 0), 15)
        more = bytes([255] * ((len(letters) - 15) // 255) + [(len(letters) - 15) % 255]) if len(letters) > 14 else b""
        return bytes([small]) + more + letters

    while at < len(content):
        length = 0
        while at >= 8 and at + length < len(content) and content[at + length] == content[at + length - 8]:
            length += 1
        if 4 <= length < 19 or (length > 18 and (length := 18)):
            out += sequence(content[start:at], length) + struct.pack("<H", 8)
            at += length
            start = at
        else:
            at += 1
    return out + sequence(content[start:], 0)


def vtp(
    how: str = "binary", order: str = "<", header: str = "u4", compress: Any = None, name: str = "", pieces: int = 1
) -> bytes:
    """A VTP file with arrays in text, in base64 or behind the rest; cells of several pieces are shared out."""
    appended = b""

    def array(title: str, table: np.ndarray, kind: str, columns: int = 1) -> str:
        nonlocal appended
        about = f'type="{kind}" Name="{title}" NumberOfComponents="{columns}"'
        table = table.astype(order + {"Float64": "f8", "Int32": "i4", "Int64": "i8"}[kind])
        if how == "ascii":
            return f'<DataArray {about} format="ascii">\n{words(table.reshape(-1, columns))}</DataArray>\n'
        parts = packed(table, order, header, compress)
        coded = b"".join(map(base64.b64encode, parts))
        if how == "binary":
            return f'<DataArray {about} format="binary">\n   {coded.decode()}\n </DataArray>\n'
        about += f' format="appended" offset="{len(appended)}"'
        appended += b"".join(parts) if how == "raw" else coded
        return f"<DataArray {about}/>\n"

    body = ""
    for faces in np.split(F, pieces):
        body += f'<Piece NumberOfPoints="4" NumberOfVerts="0" NumberOfLines="0" NumberOfPolys="{len(faces)}">'
        body += f"<PointData/><Points>{array('Points', V, 'Float64', 3)}</Points><Verts/><Polys>"
        body += array("connectivity", faces.ravel(), "Int32")
        body += array("offsets", 3 * np.arange(1, len(faces) + 1), "Int64") + "</Polys></Piece>"
    about = f'byte_order="{"LittleEndian" if order == "<" else "BigEndian"}"'
    about += f' header_type="UInt{8 * int(header[1])}"' + (f' compressor="{name}"' if name else "")
    text = f'<?xml version="1.0"?>\n<!-- made by a test -->\n<VTKFile type="PolyData" version="0.1" {about}>\n'
    text += f"<PolyData>{body}</PolyData>\n"
    if appended:
        encoding = "raw" if how == "raw" else "base64"
        return f'{text}<AppendedData encoding="{encoding}">\n _'.encode() + appended + b"</AppendedData></VTKFile>\n"
    return f"{text}</VTKFile>\n".encode()


def gifti(encoding: str = "GZipBase64Binary", kind: str = "INT32") -> bytes:
    """A GIFTI surface, as FreeSurfer and the Connectome Workbench write them."""

    def array(intent: str, table: np.ndarray, kind: str) -> str:
        content = table.astype("<f4" if kind == "FLOAT32" else "<i4").tobytes()
        if encoding == "ASCII":
            data = words(table)
        else:
            data = base64.b64encode(zlib.compress(content) if encoding[:4] == "GZip" else content).decode()
        return (
            f'<DataArray Intent="NIFTI_INTENT_{intent}" DataType="NIFTI_TYPE_{kind}" ArrayIndexingOrder='
            f'"RowMajorOrder" Dimensionality="2" Dim0="{len(table)}" Dim1="3" Encoding="{encoding}" '
            f'Endian="LittleEndian" ExternalFileName="" ExternalFileOffset=""><Data>{data}</Data></DataArray>\n'
        )

    doctype = '<!DOCTYPE GIFTI SYSTEM "http://www.nitrc.org/frs/download.php/115/gifti.dtd">'
    arrays = array("POINTSET", V, "FLOAT32") + array("TRIANGLE", F, kind)
    head = f'<?xml version="1.0" encoding="UTF-8"?>\n{doctype}\n<GIFTI Version="1.0" NumberOfDataArrays="2">'
    return f"{head}{arrays}</GIFTI>".encode()


FREESURFER = b"\xff\xff\xfecreated by me\n\n" + struct.pack(">ii", 4, 4) + V.astype(">f4").tobytes()
FREESURFER += F.astype(">i4").tobytes()
FREESURFER_TEXT = "#!ascii version of lh.white\n4 4\n" + V_TEXT.replace("\n", " 0\n")
FREESURFER_TEXT += words(np.column_stack([F, np.zeros(4, int)]))


def gltf(**changes: Any) -> bytes:
    """A .gltf with its numbers inside, in base64."""
    whole = glb()
    end = 20 + int.from_bytes(whole[12:16], "little")
    tree = json.loads(whole[20:end])
    tree["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(whole[end + 8 :]).decode()
    return json.dumps(tree | changes).encode()


def halves(tree: Any) -> None:
    """Two primitives of one mesh that share its positions, with points between them."""
    tree["accessors"][1]["count"] = 6
    tree["accessors"].append({**tree["accessors"][1], "byteOffset": 12})
    first = tree["meshes"][0]["primitives"][0]
    tree["meshes"][0]["primitives"] += [{**first, "mode": 0}, {**first, "indices": 2, "material": 0}]
    tree["materials"] = [{"name": "skin"}]


def mirrored(tree: Any) -> None:
    """A node that mirrors, under one that turns by half a turn: together x goes to -x."""
    tree["nodes"] = [{"children": [1], "rotation": [1, 0, 0, 0]}, {"mesh": 0, "scale": [-1, -1, -1]}]


def sparse(tree: Any) -> None:
    """The first triangle's indices stand apart, and in the table itself lie those of the second."""
    tree["accessors"][1]["sparse"] = {
        "count": 3,
        "indices": {"bufferView": 2, "componentType": 5121},
        "values": {"bufferView": 1},
    }
    tree["bufferViews"].append({"buffer": 0, "byteOffset": 72, "byteLength": 3})
    tree["buffers"][0]["byteLength"] = 75


def with_bytes(data: bytes, more: bytes) -> bytes:
    """A GLB with more bytes at the end of its numbers."""
    end = 20 + int.from_bytes(data[12:16], "little")
    blob = data[end + 8 :] + more
    blob += bytes(-len(blob) % 4)
    whole = data[:end] + struct.pack("<I4s", len(blob), b"BIN\0") + blob
    return whole[:8] + struct.pack("<I", len(whole)) + whole[12:]


def quantised(tree: Any) -> None:
    tree["extensionsRequired"] = tree["extensionsUsed"] = ["KHR_mesh_quantization"]
    tree["accessors"][0] |= {"normalized": True, "componentType": 5120}


def skinned(tree: Any) -> None:
    """A skin of two joints, of which the second stands higher, and a morph target that is half turned on."""
    tree["nodes"] = [{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {"translation": [0, 0, 5]}, {}]
    tree["scenes"][0]["nodes"] = [0, 1, 2]
    tree["skins"] = [{"joints": [1, 2], "inverseBindMatrices": 4}]
    tree["meshes"][0]["primitives"][0]["attributes"] |= {"JOINTS_0": 2, "WEIGHTS_0": 3}
    tree["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}, {"POSITION": 0}]
    tree["meshes"][0]["weights"] = [-0.5, 0.5]
    tree["accessors"] += [
        {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"},
        {"bufferView": 2, "byteOffset": 16, "componentType": 5126, "count": 4, "type": "VEC4"},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "MAT4"},
    ]
    tree["bufferViews"] += [
        {"buffer": 0, "byteOffset": 72, "byteLength": 80},
        {"buffer": 0, "byteOffset": 152, "byteLength": 128},
    ]
    tree["buffers"][0]["byteLength"] = 280


BIND = np.stack([np.eye(4), np.eye(4)])
BIND[0, 3, 2] = -5  # by columns: the first joint's height is taken off again
RIG = (
    np.array([[0, 1, 0, 0]] * 4, "u1").tobytes() + np.full((4, 4), 0.25, "<f4").tobytes() + BIND.astype("<f4").tobytes()
)
MIXED = struct.pack("<B3iBB3iB", 3, 0, 1, 2, 9, 3, 0, 2, 3, 9) + struct.pack("<B3iBB3iB", 3, 0, 3, 1, 9, 3, 1, 3, 2, 9)
LISTS_HEAD = PLY_HEAD.replace("ascii", "binary_little_endian").replace(
    "element face 4\nproperty list uchar int vertex_indices\n",
    "element face 4\nproperty list uchar uchar tags\nproperty list uchar int vertex_indices\n",
)
LISTS = b"".join(
    struct.pack(f"<B{i}BB3i", i, *range(i), 3, *face) for i, face in enumerate(F.tolist())
)  # a list of another length in every row
STRIP_HEAD = PLY_HEAD.replace("element face 4", "element tristrips 2").replace("uchar int", "int int")
CR_HEAD = PLY_HEAD.replace("ascii", "binary_little_endian").replace("\n", "\r").encode()
SINGLE = V.astype("<f4").tobytes()

COMPRESSORS = (
    ("vtkZLibDataCompressor", zlib.compress),
    ("vtkLZMADataCompressor", lzma.compress),
    ("vtkLZ4DataCompressor", lz4_block),
)

OTHERS: list[tuple[str, str, str | bytes]] = [
    ("F12", "nc.off", "NCOFF\n4 4 0\n" + V_TEXT.replace("\n", " 255 0 0 255 0.1 0.2 0.3 \n") + "".join(
        f"3 {a} {b} {c} \n" for a, b, c in F.tolist())),
    ("F12", "cn.off", "CNOFF 4 4 0\n" + V_TEXT.replace("\n", " 0 0 1 1 0 0 1\n") + OFF.split("\n", 6)[6]),
    ("F12", "stcn.off", "STCNOFF\n4 4 0\n" + V_TEXT.replace("\n", " 0 0 1 1 0 0 1 0.5 0.5\n") + OFF.split("\n", 6)[6]),
    ("F12", "glued.off", OFF.replace("OFF\n", "OFF")),
    ("F12", "flat.off", OFF.replace("\n", " ")),
    ("F12", "two_a_line.off", OFF.replace("1 1 1\n", "1 1 1 ").replace("3 0 1 2\n", "3 0 1 2 ")),
    *[("F12", f"begins{i}.obj", f"{line}\n{OBJ}") for i, line in enumerate(
        ["l 1 2", "p 1", "g", "s off", "usemap x", "cstype bezier", "end", "vp 0.3 0.4", "lod 3", "$ENDS"])],
    ("F12", "old_faces.obj", OBJ.replace("f 1", "fo 1")),
    ("F09", "edges.off", OFF.replace("4 4 6", "4 7 6") + "2 0 1\n1 3\n0\n"),
    ("F09", "edges.obj", OBJ.replace("f 1 3 4", "f 1 2\nf 4\nf 1 3 4") + "f 3 4\n"),
    ("F09", "edges.ply", PLY.replace("face 4", "face 7").replace("3 0 2 3", "2 0 1\n1 3\n3 0 2 3\n0")),
    ("F09", "edges_binary.ply", PLY_HEAD.replace("ascii", "binary_little_endian").replace("face 4", "face 6").encode()
     + SINGLE + struct.pack("<B2iBi", 2, 0, 1, 1, 3) + b"".join(struct.pack("<B3i", 3, *face) for face in F.tolist())),
    ("F09", "edges.vtk", vtk().replace(b"POLYGONS 4 16\n", b"POLYGONS 6 21\n2 0 1\n1 3\n")),
    ("F13", "end_solid.stl", STL.replace("endsolid", "end solid").replace("endloop", "end loop")),
    ("F13", "end_facet.stl", STL.replace("endfacet", "end facet").replace("endsolid thing", "EndSolid")),
    ("F13", "longer.stl", STL_BINARY.replace(b"solid but", b"a file of") + b"more"),
    ("F13", "coloured.stl", STL.replace("solid thing\n", "solid thing\ncolor 0.5 0.5 0.5\n", 1)),
    ("F14", "longer.ply", binary_ply() + b"\0more"),
    ("F14", "longer_text.ply", PLY + "3 0 1 2\nwhatever\n"),
    ("F14", "flags.ply", PLY_HEAD.replace("ascii", "binary_little_endian").replace(
        "indices\n", "indices\nproperty uchar flag\n").encode() + SINGLE + MIXED),
    ("F14", "lists.ply", LISTS_HEAD.encode() + SINGLE + LISTS),
    ("F14", "strips.ply", STRIP_HEAD.replace("ascii", "binary_big_endian").encode() + V.astype(">f4").tobytes()
     + np.array([7, 0, 1, 2, -1, 0, 2, 3, 7, 0, 3, 1, -1, 1, 3, 2], ">i4").tobytes()),
    ("F14", "strips_text.ply", STRIP_HEAD + V_TEXT + "8 0 1 2 -1 0 2 3 -1\n7 0 3 1 -1 1 3 2\n"),
    ("F14", "faces_first.ply", PLY_HEAD.replace("element face 4\nproperty list uchar int vertex_indices\n", "").replace(
        "element vertex", "element face 4\nproperty list uchar int vertex_indices\nelement vertex")
     + "3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n" + V_TEXT),
    ("F14", "spaces.ply", PLY.replace("end_header", "comment end_header\nend_header  ")),
    ("F14", "cr_binary.ply", CR_HEAD + SINGLE + b"".join(struct.pack("<B3i", 3, *face) for face in F.tolist())),
    ("F14", "capitals.ply", PLY.replace("float x", "float X").replace("float y", "float Y")),
    ("F17", "longer.glb", glb(pad=b"\0" * 8)),
    ("F17", "halves.glb", glb(halves)),
    ("F17", "apart.glb", with_bytes(glb(sparse), bytes([0, 1, 2]))),
    ("F17", "skinned.glb", with_bytes(glb(skinned), RIG)),
    ("F17", "quantised.glb", glb(quantised, kinds=("i1", "<u2"), v=127 * V)),
    ("F17", "image.glb", glb(setting("images", value=[{"uri": "a.png"}]))),
    ("F17", "no_scene.glb", glb(lambda tree: (tree.pop("scenes"), tree.pop("scene")))),
    ("F17", "no_nodes.glb", glb(lambda tree: [tree.pop(name) for name in ("scenes", "scene", "nodes")])),
    ("F17", "draco_as_well.glb", glb(setting("meshes", 0, "primitives", 0, "extensions", value={
        "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}}))),
    ("F17", "inside.gltf", gltf()),
    ("F19", "a.off.gz", gzip.compress(OFF.encode())),
    ("F19", "a.stl.gz", gzip.compress(STL_BINARY)),
    ("F19", "really_packed.ply", gzip.compress(PLY.encode())),
    ("F19", "two_members.obj.gz", gzip.compress(OBJ[:30].encode()) + gzip.compress(OBJ[30:].encode())),
    *[("F20", f"{'binary' if binary else 'text'}{version}{'grid' if grid else ''}.vtk", vtk(version, binary, grid=grid))
      for version in ("1.0", "3.0", "4.2", "5.0", "5.1") for binary in (False, True) for grid in (False, True)],
    ("F20", "strips.vtk", STRIP_VTK),
    ("F20", "crlf.vtk", vtk().replace(b"\n", b"\r\n")),
    ("F20", "field.vtk", vtk("5.1", True, "FIELD FieldData 1\nTime 1 1 double\n" + "\0" * 8 + "\n")),
    *[("F20", f"{how}{order}{header}.vtp", vtp(how, order, header))
      for how in ("ascii", "binary", "appended", "raw") for order in "<>" for header in ("u4", "u8")],
    *[("F20", f"{how}{name}.vtp", vtp(how, "<", "u4", compress, name)) for how in ("binary", "appended", "raw")
      for name, compress in COMPRESSORS],
    ("F21", "lh.white.asc", FREESURFER_TEXT),
]  # fmt: skip
NEURO: list[tuple[str, str, str | bytes]] = [
    *[("F21", f"{encoding}.gii", gifti(encoding)) for encoding in ("ASCII", "Base64Binary", "GZipBase64Binary")],
    ("F21", "a.gii.gz", gzip.compress(gifti())),
    ("F21", "lh.white", FREESURFER),
    ("F21", "longer.pial", FREESURFER + b"\0\0\0\2and more"),
]
