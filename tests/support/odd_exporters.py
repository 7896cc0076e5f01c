"""One box, as many programs write it, each with a habit of its own: name of the file, content; see `BOX`."""

from __future__ import annotations

import gzip
import json
import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from geodesics import Mesh

QUADS = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
V = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0], [0, 0, 3], [1, 0, 3], [1, 2, 3], [0, 2, 3]], dtype=float)
T = np.array([half for q in QUADS for half in (q[:3], [q[0], *q[2:]])])
BOX = Mesh(V, T)


def points(line: str = "{} {} {}\n") -> str:
    return "".join(line.format(*p) for p in V.tolist())


def faces(first: int = 0, head: str = "4 ") -> str:
    return "".join(head + " ".join(str(i + first) for i in quad) + "\n" for quad in QUADS)


PLY = "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
PLY_FACES = "element face 6\nproperty list uint8 int32 vertex_indices\n"
OBJ_V, OBJ_F = points("v {} {} {}\n"), faces(1, "f ")
STL = "".join(
    "  facet normal 0 0 0\n    outer loop\n"
    + "".join("      vertex {:e} {:e} {:e}\n".format(*V[i]) for i in face)
    + "    endloop\n  endfacet\n"
    for face in T
)


def binary_ply(order: str, count: str = "B", index: str = "i", line_end: str = "\n") -> bytes:
    """With an element before, a list before the corners, and a flag behind them."""
    names = {"B": "uint8", "H": "ushort", "i": "int32", "q": "int64"}
    head = ["ply", f"format binary_{'little' if order == '<' else 'big'}_endian 1.0", "element grid 2"]
    head += ["property list uchar int places", "element vertex 8", *(f"property double {axis}" for axis in "xyz")]
    head += ["element face 6", "property list uchar float texcoord"]
    head += [f"property list {names[count]} {names[index]} vertex_indices", "property uchar flags", "end_header", ""]
    body = struct.pack(order + "Bii", 2, 1, 2) + b"\0" + V.astype(order + "f8").tobytes()
    for quad in QUADS:
        body += struct.pack(order + "B2f", 2, 0.5, 0.5) + struct.pack(f"{order}{count}4{index}", 4, *quad) + b"\7"
    return line_end.join(head).encode() + body


def binary_stl(head: bytes, count: int = len(T), attribute: int = 0, behind: bytes = b"") -> bytes:
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *V[face].ravel(), attribute) for face in T)
    return head.ljust(80) + struct.pack("<I", count) + facets + behind


def numbers(table: Any, kind: str) -> bytes:
    return np.asarray(table).astype(kind).tobytes()


META = b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 3.7\n\n"
VALUES = b"\nCELL_DATA 6\nSCALARS a float 1\nLOOKUP_TABLE default\n1 2 3 4 5 6\nPOINT_DATA 8\nNORMALS n float\n"
POLYGONS = ("POLYGONS 6 30\n" + faces()).encode()
OFFSETS = f"POLYGONS 7 24\nOFFSETS vtktypeint64\n{' '.join(str(4 * i) for i in range(7))}\nCONNECTIVITY vtktypeint64\n"


def vtk(version: str, *sections: bytes, binary: bool = False) -> bytes:
    head = f"# vtk DataFile Version {version}\na title\n{'BINARY' if binary else 'ASCII'}\nDATASET POLYDATA\n".encode()
    placed = numbers(V, ">f4") + b"\n" if binary else points().encode()
    return head + (b"POINTS 8 float\n" if binary else b"POINTS 8 double\n") + placed + b"".join(sections)


BINARY_OFFSETS = b"POLYGONS 7 24\nOFFSETS vtktypeint64\n%b\nCONNECTIVITY vtktypeint64\n%b\n"
BINARY_OFFSETS %= numbers(4 * np.arange(7), ">i8"), numbers(QUADS, ">i8")

KINDS = {"i1": 5120, "u1": 5121, "<i2": 5122, "<u2": 5123, "<u4": 5125, "<f4": 5126}  # componentType, by dtype


class Buffer:
    """Bytes of a GLB, their views and accessors."""

    def __init__(self) -> None:
        self.content, self.views, self.accessors = bytearray(), [], []

    def __call__(self, table: Any, kind: str, items: str, stride: int = 0, **more: Any) -> int:
        rows = np.asarray(table).astype(kind)
        packed = b"".join(row.tobytes().ljust(stride, b"\x99") for row in rows.reshape(len(rows), -1))
        self.content += b"\0" * (-len(self.content) % 4)
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": len(packed)}
        self.content += packed
        self.views.append(view | ({"byteStride": stride} if stride else {}))
        about = {"bufferView": len(self.views) - 1, "componentType": KINDS[kind], "count": len(rows), "type": items}
        self.accessors.append(about | more)
        return len(self.accessors) - 1


def glb(build: Callable[[Buffer], dict[str, Any]]) -> bytes:
    """With a chunk behind the others that nobody knows."""
    buffer = Buffer()
    tree = {"asset": {"version": "2.0"}, **build(buffer), "bufferViews": buffer.views, "accessors": buffer.accessors}
    buffer.content += b"\0" * (-len(buffer.content) % 4)
    text = json.dumps({**tree, "buffers": [{"byteLength": len(buffer.content)}]}).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(buffer.content), b"BIN\0") + buffer.content
    chunks += struct.pack("<I4s", 4, b"ODD\0") + b"what"
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def scene(*primitives: dict[str, Any], **node: Any) -> dict[str, Any]:
    return {"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, **node}], "meshes": [{"primitives": [*primitives]}]}


def plain(buffer: Buffer, place: Any = V, kind: str = "<f4", stride: int = 0, **more: Any) -> dict[str, Any]:
    at = buffer(place, kind, "VEC3", stride, **more)
    return {"attributes": {"POSITION": at}, "indices": buffer(T.ravel(), "u1", "SCALAR")}


def sparse(buffer: Buffer) -> dict[str, Any]:
    """All is zero but for what is listed apart."""
    made = plain(buffer)
    rows, values = buffer(np.arange(1, 8), "u1", "SCALAR"), buffer(V[1:], "<f4", "VEC3")
    buffer.accessors[0].pop("bufferView")
    buffer.accessors[0]["sparse"] = {
        "count": 7,
        "indices": {"bufferView": buffer.accessors[rows]["bufferView"], "componentType": 5121},
        "values": {"bufferView": buffer.accessors[values]["bufferView"]},
    }
    return scene(made)


def quantised(kind: str, normalised: bool) -> Callable[[Buffer], dict[str, Any]]:
    def build(buffer: Buffer) -> dict[str, Any]:
        largest, width = np.iinfo(kind).max, 4 if kind in ("i1", "u1") else 8
        table, size = (np.round(V / 3 * largest), 3.0) if normalised else (V * 30, 1 / 30)
        made = plain(buffer, table, kind, width, **({"normalized": True} if normalised else {}))
        return scene(made, scale=[size] * 3) | {"extensionsRequired": ["KHR_mesh_quantization"]}

    return build


def matrices(buffer: Buffer) -> dict[str, Any]:
    """Turned, and turned back by the node below."""
    turn = np.array([[0.6, -0.8, 0, 5], [0.8, 0.6, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]])
    above = {"children": [1], "matrix": turn.T.ravel().tolist()}
    made = scene(plain(buffer))
    return made | {"nodes": [above, {"mesh": 0, "matrix": np.linalg.inv(turn).T.ravel().tolist()}]}


def fans(buffer: Buffer) -> dict[str, Any]:
    at = buffer(V, "<f4", "VEC3")
    quads = [buffer(quad, "<u2", "SCALAR") for quad in QUADS]
    return scene(*({"attributes": {"POSITION": at}, "indices": quad, "mode": 6} for quad in quads))


def second_scene(buffer: Buffer) -> dict[str, Any]:
    made = scene(plain(buffer))
    return made | {
        "scene": 1,
        "scenes": [{"nodes": [0]}, {"nodes": [1]}],
        "nodes": [{"mesh": 0, "scale": [5, 5, 5]}, {"mesh": 0}],
    }


READ: dict[str, str | bytes] = {
    "uint8.ply": PLY + PLY_FACES + "end_header\n" + points() + faces(),
    "before.ply": PLY.replace("element", "element camera 1\nproperty float a\nproperty list uchar int b\nelement", 1)
    + PLY_FACES + "end_header\n1.5 2 7 8\n" + points() + faces(),
    "tags.ply": PLY.replace("property", "property list uchar int tags\nproperty", 1) + PLY_FACES + "end_header\n"
    + points("2 7 8 {} {} {}\n") + faces(),
    "wrapped.ply": PLY + PLY_FACES + "end_header\n" + points("{}\n{} {}\n") + faces().replace(" ", "\n", 3),
    "flowing.ply": PLY + PLY_FACES + "end_header\n" + (points() + faces()).replace("\n", " "),
    "big.ply": binary_ply(">"),
    "little.ply": binary_ply("<", "H", "q", "\r\n") + b"more",
    "negative.obj": OBJ_V + faces(-8, "f "),
    "forward.obj": "g a b\n" + OBJ_F + OBJ_V,
    "continued.obj": (OBJ_V + OBJ_F).replace(" ", " \\\n", 40),
    "continued_cr.obj": (OBJ_V + OBJ_F).replace(" ", " \\\n", 40).replace("\n", "\r"),
    "curves.obj": "cstype bezier\ndeg 3\nvp 0.1 0.2\n" + OBJ_V + "curv 0 1 1 2 3 4\nparm u 0 1\nend\n" + OBJ_F,
    "slashes.obj": OBJ_V + "vt 0 0\n" + OBJ_F.replace("1", "1/").replace("2", "2/1/"),
    "programs.obj": "csh rm -rf here\ncall other.obj\n" + OBJ_V + OBJ_F,
    "utf16.obj": (OBJ_V + OBJ_F).encode("utf-16"),
    "solid.stl": binary_stl(b"solid of someone", behind=b"more"),
    "coloured.stl": binary_stl(b"COLOR=\xff\0\0\xff,MATERIAL=", attribute=0x8FFF),
    "uncounted.stl": binary_stl(b"as it goes", count=0),
    "capitals.stl": f"SOLID A\n{STL}ENDSOLID A\n".upper(),
    "normals.stl": f"solid\n{STL}endsolid\n".replace("normal 0 0 0", "normal nan nan -nan(ind)"),
    "one_line.stl": f"solid some thing {STL}endsolid".replace("\n", " "),
    "joined.stl": f"solid\n{STL}endsolid\n".replace("outer loop\n", "outer loop ").replace("endloop\n", "endloop "),
    "comments.off": f"# a\nOFF # b\n# c\n8 6 12 # d\n{points('{} {} {} # e' + chr(10))}\n# f\n{faces()}",
    "indexed.off": "OFF\n8 6 0\n" + points() + faces().replace("\n", " 7\n"),
    "coloured.off": "COFF 8 6 0\n" + points("{} {} {} .1 .2 .3 1\n") + faces().replace("\n", " 0.5 0 1 1\n"),
    "no_keyword.off": "8 6 0\n" + points() + faces(),
    "a_count_a_line.off": "OFF\n8\n6\n0\n" + points() + faces(),
    "metadata.vtk": vtk("5.1", META, OFFSETS.encode(), faces(head="").encode(), VALUES, b"0 0 1\n" * 8),
    "values.vtk": vtk("2.0", POLYGONS, VALUES, b"0 0 1\n" * 8),
    "binary.vtk": vtk("5.1", META, BINARY_OFFSETS, b"POINT_DATA 8\n", binary=True),
    "sparse.glb": glb(sparse),
    "stride.glb": glb(lambda buffer: scene(plain(buffer, stride=32))),
    "matrices.glb": glb(matrices),
    "fans.glb": glb(fans),
    "second_scene.glb": glb(second_scene),
    **{f"{kind[-2:]}{n:d}.glb": glb(quantised(kind, n)) for kind in ("i1", "u1", "<i2", "<u2") for n in (False, True)},
}  # fmt: skip
READ |= {
    f"{name}.gz": gzip.compress(content if isinstance(content, bytes) else content.encode())
    for name, content in READ.items()
}
# neither read nor guessed: name, content, code, what the error says
REFUSED: list[tuple[str, str | bytes, str, str]] = [
    ("more.stl", binary_stl(b"x", count=13), "E204", "13 triangles need 734 bytes"),
    ("comment.ply", PLY + PLY_FACES + "end_header\n" + points() + "comment here\n" + faces(), "E207", "line 18"),
    ("short.ply", PLY + PLY_FACES + "end_header\n" + (points() + faces()).replace("\n", " ")[:-4], "E204", "declared"),
    ("fortran.obj", (OBJ_V + OBJ_F).replace("1.0", "1.0D0"), "E207", "line 2"),
    ("lines.vtk", vtk("3.0", b"LINES 1 3\n2 0 1\n"), "E104", "no faces"),
    ("points.glb", glb(lambda buffer: scene({**plain(buffer), "mode": 0})), "E104", "must be triangulated first"),
    ("lines.glb", glb(lambda buffer: scene({**plain(buffer), "mode": 3})), "E104", "points or lines alone"),
]
