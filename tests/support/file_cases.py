"""Small mesh files, sound and broken, by row of the reliability table."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from generated_shapes import tetrahedron

V = tetrahedron().vertices
F = tetrahedron().faces
V_TEXT = "1 1 1\n1 -1 -1\n-1 1 -1\n-1 -1 1\n"
F_TEXT = "3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n"
OFF = "OFF\n4 4 6\n" + V_TEXT + F_TEXT
OBJ_V = "".join(f"v {line}\n" for line in V_TEXT.splitlines())
OBJ = OBJ_V + "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"
PLY_HEAD = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
)
PLY = PLY_HEAD + V_TEXT + F_TEXT


def facet(corners: np.ndarray) -> str:
    lines = "".join("    vertex {} {} {}\n".format(*p) for p in corners)
    return f"facet normal 0 0 0\n  outer loop\n{lines}  endloop\nendfacet\n"


STL_FACETS = "".join(facet(V[f]) for f in F)
STL = f"solid thing\n{STL_FACETS}endsolid thing\n"
STL_BINARY = b"solid but binary".ljust(80) + struct.pack("<I", 4)
STL_BINARY += b"".join(struct.pack("<12fH", 0, 0, 0, *V[f].ravel(), 0) for f in F)


def binary_ply(order: str = "<", count: str = "uchar", index: str = "int", extra: bool = False) -> bytes:
    """A binary PLY with the given byte order and list types, optionally with properties and elements to skip."""
    code = {"uchar": "B", "ushort": "H", "int": "i", "uint": "I", "short": "h", "float": "f"}
    name = {"<": "little", ">": "big"}[order]
    head = f"ply\nformat binary_{name}_endian 1.0\ncomment made by a test\n"
    colour = "property uchar red\nproperty double quality\n" if extra else ""
    if extra:
        head += "element camera 2\nproperty float view\nproperty list uchar short tags\n"
    head += f"element vertex 4\n{colour}property double z\nproperty double x\nproperty double y\n"
    head += f"element face 4\nproperty list {count} {index} vertex_indices\nend_header\n"
    body = b"".join(struct.pack(order + "fBhh", 1.0, 2, 3, 4) for _ in range(2)) if extra else b""
    for x, y, z in V:
        body += (struct.pack(order + "Bd", 7, 0.5) if extra else b"") + struct.pack(order + "3d", z, x, y)
    for f in F:
        body += struct.pack(order + code[count] + 3 * code[index], 3, *f)
    return head.encode() + body


COMPONENTS = {"i1": 5120, "u1": 5121, "<i2": 5122, "<u2": 5123, "<u4": 5125, "<f4": 5126}


def glb(change: Any = None, pad: bytes = b"", kinds: tuple[str, str] = ("<f4", "<u2"), v: np.ndarray = V) -> bytes:
    """A GLB with one indexed mesh of these number types; `change` edits the JSON tree before it is packed."""
    size = 12 * np.dtype(kinds[0]).itemsize, 12 * np.dtype(kinds[1]).itemsize
    blob = v.astype(kinds[0]).tobytes() + F.astype(kinds[1]).tobytes()
    tree: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": COMPONENTS[kinds[0]], "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": COMPONENTS[kinds[1]], "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": size[0]},
            {"buffer": 0, "byteOffset": size[0], "byteLength": size[1]},
        ],
        "buffers": [{"byteLength": sum(size)}],
    }
    if change:
        change(tree)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks + pad


def setting(*path: Any, value: Any) -> Any:
    def change(tree: Any) -> None:
        for key in path[:-1]:
            tree = tree[key]
        tree[path[-1]] = value

    return change


def loop_nodes(tree: Any) -> None:
    tree["nodes"] = [{"mesh": 0, "children": [1]}, {"children": [0]}]


def one_view(tree: Any) -> None:
    """Positions and indices in one view, offsets of zero left out."""
    tree["bufferViews"] = [{"buffer": 0, "byteLength": 72}]
    tree["accessors"][1] |= {"bufferView": 0, "byteOffset": 48}


QUARTER = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]  # (x, y, z) becomes (1 - y, 2 + x, 3 + z); by columns
UNTURNED = np.column_stack([V[:, 1] - 2, 1 - V[:, 0], V[:, 2] - 3])

READ: list[tuple[str, str, str | bytes]] = [
    ("F06", "wrong.obj", OFF),
    ("F06", "wrong.off", OBJ),
    ("F06", "wrong.stl", PLY),
    ("F06", "no_suffix", OFF),
    ("F06", "UPPER.OFF", OFF),
    ("F06", "unknown.xyz", STL),
    ("F12", "bom.off", b"\xef\xbb\xbf" + OFF.encode()),
    ("F12", "crlf.off", OFF.replace("\n", "\r\n")),
    ("F12", "cr.off", OFF.replace("\n", "\r")),
    ("F12", "comments.off", "# first\n\nOFF # here\n# there\n" + OFF[4:].replace("\n", " # end\n\n")),
    ("F12", "comments_with_spaces.off", "#   \n" * 40 + OFF),
    ("F12", "one_line.off", OFF.replace("OFF\n", "OFF ")),
    ("F12", "no_edge_count.off", OFF.replace("4 4 6", "4 4")),
    ("F12", "trailing.off", OFF + "2 0 1\nanything at all\n"),
    ("F12", "no_newline.off", OFF.rstrip()),
    ("F12", "tabs.off", OFF.replace(" ", " \t ")),
    ("F12", "colours.off", "COFF\n4 4 0\n" + V_TEXT.replace("\n", " 255 0 0 255\n") + F_TEXT),
    ("F12", "normals.off", "NOFF\n4 4 0\n" + V_TEXT.replace("\n", " 0 0 1\n") + F_TEXT),
    ("F12", "texture.off", "STOFF\n4 4 0\n" + V_TEXT.replace("\n", " 0.5 0.5\n") + F_TEXT),
    ("F12", "face_colours.off", OFF.replace("3 1 3 2", "3 1 3 2 0.5 0.5 1")),
    ("F12", "exponents.off", OFF.replace("1 -1 -1", "+1.0e0 -10E-1 -.1e+1")),
    ("F12", "latin.off", "OFF # caf\xe9\n".encode("latin-1") + OFF[4:].encode()),
    ("F12", "crlf.obj", OBJ.replace("\n", "\r\n")),
    ("F12", "no_newline.obj", OBJ.rstrip()),
    ("F12", "more.obj", "# comment\nmtllib x.mtl\no thing\n" + OBJ.replace("f 1 2 3", "usemtl a\ns off\nf 1 2 3")),
    ("F12", "texture.obj", OBJ_V + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\nf 1/1 4/1 2/1\nf 2 4 3\n"),
    ("F12", "seam.obj", OBJ_V + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/2 4/2\nf 1/1 4/2 2/1\nf 2/1 4/1 3/2\n"),
    ("F12", "continued.obj", OBJ.replace("f 1 2 3", "f 1 \\\n2 3")),
    ("F12", "colours.obj", OBJ.replace("v 1 1 1", "v 1 1 1 0.5 0.5 0.5")),
    ("F12", "crlf.ply", PLY.replace("\n", "\r\n")),
    ("F12", "no_newline.ply", PLY.rstrip()),
    ("F12", "comment.ply", PLY.replace("element vertex", "comment TextureFile /x\nobj_info x\nelement vertex")),
    ("F12", "cr.ply", PLY.replace("\n", "\r")),
    ("F13", "binary_solid.stl", STL_BINARY),
    ("F13", "upper.stl", STL.upper()),
    ("F13", "two.stl", f"solid a\n{''.join(facet(V[f]) for f in F[:2])}endsolid a\n"
     f"solid b\n{''.join(facet(V[f]) for f in F[2:])}endsolid b\n"),
    ("F13", "indented.stl", STL.replace("\n", "\r\n\t ")),
    ("F14", "singular.ply", PLY.replace("vertex_indices", "vertex_index")),
    ("F14", "order.ply", PLY.replace("float x", "float t").replace("float z", "float x").replace("float t", "float z")
     .replace(V_TEXT, "".join(f"{z} {y} {x}\n" for x, y, z in V.tolist()))),
    ("F14", "empty_element.ply", PLY.replace("end_header", "element edge 0\nproperty int vertex1\nend_header")),
    ("F14", "little.ply", binary_ply()),
    ("F14", "big.ply", binary_ply(">")),
    ("F14", "types.ply", binary_ply("<", "int", "ushort")),
    ("F14", "types2.ply", binary_ply(">", "uint", "short")),
    ("F14", "extra.ply", binary_ply("<", extra=True)),
    ("F14", "extra_big.ply", binary_ply(">", "ushort", "uint", extra=True)),
    ("F14", "seams.ply", PLY.replace("float z", "float z\nproperty float s\nproperty float t")
     .replace(V_TEXT, V_TEXT.replace("\n", " 0.5 0.1\n"))),
    ("F14", "face_colours.ply", PLY.replace("indices\n", "indices\nproperty uchar red\nproperty int one\n")
     .replace(F_TEXT, F_TEXT.replace("\n", " 9 1\n")).rstrip()),
    ("F14", "elements.ply", PLY_HEAD.replace("element v", "element odd 1\nproperty list uchar int what\nelement v")
     + "3 9 9 9\n" + V_TEXT + F_TEXT),
    ("F16", "nul.off", OFF.encode().replace(b"OFF\n", b"OFF # \0\xff\n")),
    ("F16", "spaces and ünïcode.off", OFF),
    ("F16", "-dash.off", OFF),
    ("F17", "one.glb", glb()),
    *[("F17", f"indices{i}.glb", glb(kinds=("<f4", kind))) for i, kind in enumerate(("u1", "<u4"))],
    *[("F17", f"positions{i}.glb", glb(kinds=(kind, "<u2"))) for i, kind in enumerate(("i1", "<i2"))],
    ("F17", "one_view.glb", glb(one_view)),
    ("F17", "triangles.glb", glb(setting("meshes", 0, "primitives", 0, "mode", value=4))),
    ("F17", "placed.glb", glb(setting("nodes", 0, "matrix", value=QUARTER), v=UNTURNED)),
    ("F17", "loop.glb", glb(loop_nodes)),
]  # fmt: skip
