"""What people have in files of meshes, by format: title, ending, and cases of (what, name of the file, content)."""

from __future__ import annotations

import gzip

from broken_files import REFUSED, TOLD
from file_cases import OBJ, OFF, PLY, READ, STL, STL_BINARY, V_TEXT, binary_ply, glb, setting
from odd_exporters import READ as ODD
from other_formats import FREESURFER, FREESURFER_TEXT, NEURO, OTHERS, gifti, gltf, mirrored, vtk, vtp

NAMED: dict[str, str | bytes] = ODD | {name: content for _, name, content in [*READ, *OTHERS, *NEURO]}
BROKEN: dict[str, str | bytes] = {name: content for _, name, content, *_ in [*REFUSED, *TOLD]}
QUADS = "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n4 0 1 2 3\n3 1 4 2\n"
CONCAVE = "v 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nf 2 3 4 5 6 1\n"
LOST = OFF.replace("4 4 6", "5 4 6").replace("-1 -1 1\n", "-1 -1 1\nnan nan nan\n")
DRACO = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}


def draco(tree: dict) -> None:
    """A piece whose numbers are there in Draco's form alone."""
    tree["meshes"][0]["primitives"][0]["extensions"] = DRACO
    tree["accessors"][0].pop("bufferView")


def twice(tree: dict) -> None:
    """A mesh that is placed twice."""
    tree["nodes"].append({"mesh": 0, "translation": [5, 0, 0]})
    tree["scenes"][0]["nodes"].append(1)


def cases(*named: tuple[str, str]) -> list[tuple[str, str, str | bytes]]:
    """Cases from the tables of sound and broken files."""
    every = {**BROKEN, **NAMED}
    return [(what, name, every[name]) for what, name in named]


Case = tuple[str, str, str | bytes]
CASES: list[tuple[str, str, list[Case]]] = [
    ("OFF", ".off", [
        ("triangles", "a.off", OFF),
        ("polygons of any size", "quads.off", QUADS),
        *cases(("colours, normals and texture coordinates (ST, C, N in any order)", "nc.off"),
               ("counts glued to the keyword; lines that end anywhere", "glued.off"),
               ("comments, blank lines, any line ends, a byte order mark", "comments.off"),
               ("no keyword, in a file called .off; a count a line", "no_keyword.off"),
               ("lines behind the last face", "trailing.off")),
        ("a vertex on no face without a position (nan)", "lost.off", LOST),
        *cases(("a vertex of a face without a position", "unknown0.off"), ("four coordinates (4OFF)", "four.off"),
               ("binary OFF", "binary.off"), ("cut off", "short.off")),
    ]),
    ("OBJ", ".obj", [
        ("triangles", "a.obj", OBJ),
        ("concave polygons", "concave.obj", CONCAVE),
        *cases(("texture coordinates and normals (kept by `gmds transfer`)", "texture.obj"),
               ("materials and groups (names kept by `gmds transfer` to .obj)", "more.obj"),
               ("colours behind positions", "colours.obj"),
               ("lines, points, curves before or between", "begins0.obj"),
               ("lines continued by a backslash", "continued.obj"), ("in UTF-16, as any text", "utf16.obj"),
               ("faces of one or two corners (left out)", "edges.obj")),
        ("negative indices", "negative.obj", OBJ.replace("f 1 2 3", "f -4 -3 -2")),
    ]),
    ("PLY", ".ply", [
        ("text", "a.ply", PLY),
        ("binary, either byte order, any types of numbers", "b.ply", binary_ply(">", "ushort", "uint", extra=True)),
        *cases(("text whose lines end anywhere", "flowing.ply"), ("lists of varying length", "lists.ply"),
               ("triangle strips", "strips.ply"),
               ("other elements and properties (passed over)", "elements.ply"), ("bytes behind the data", "longer.ply"),
               ("indices that are not whole numbers", "index_float.ply"),
               ("faces of one or two corners (left out)", "edges.ply")),
        ("cut off", "cut.ply", binary_ply()[:-3]),
    ]),
    ("STL", ".stl", [
        ("text, of one solid or several", "two.stl", NAMED["two.stl"]),
        ("binary, also when it begins with `solid`", "binary.stl", STL_BINARY),
        *cases(("binary, with a count of 0", "uncounted.stl"), ("text on one line", "one_line.stl"),
               ("`end solid`, `end loop`", "end_solid.stl"), ("bytes behind the data", "longer.stl"),
               ("no `endsolid`", "open.stl")),
        ("cut off", "cut.stl", STL[:-20]),
    ]),
    ("GLB", ".glb", [
        ("one mesh, placed by its nodes", "a.glb", glb()),
        *cases(("several primitives, also of points or lines", "halves.glb")),
        ("several meshes, or one placed several times", "twice.glb", glb(twice)),
        *cases(("without indices, strips, fans; sparse numbers", "apart.glb"), ("quantised positions", "quantised.glb"),
               ("skins and morph weights (the pose of the file; `gmds transfer --rig` carries them)", "skinned.glb")),
        ("nodes of negative scale", "mirrored.glb", glb(mirrored)),
        *cases(("images in other files (not opened)", "image.glb")),
        ("points or lines alone", "points.glb", BROKEN["points.glb"]),
        ("compressed by Draco, or by meshopt", "draco.glb", glb(draco)),
        ("numbers in other files", "uri.glb", glb(setting("buffers", 0, "uri", value="a.bin"))),
    ]),
    ("glTF", ".gltf", [("with its numbers inside, as a GLB", "a.gltf", gltf())]),
    ("VTK (legacy)", ".vtk", [
        ("PolyData, text or binary, 1.0 to 4.2", "a.vtk", vtk()),
        ("PolyData, text or binary, 5.0 and 5.1", "b.vtk", vtk("5.1", True)),
        *cases(("triangle strips; lines and vertices (passed over)", "strips.vtk"),
               ("polygons of one or two corners (left out)", "edges.vtk")),
        ("polygons of an unstructured grid", "c.vtk", vtk(grid=True)),
        ("solid cells, structured grids", "d.vtk", vtk(grid=True).replace(b"CELL_TYPES 4\n5", b"CELL_TYPES 4\n10")),
    ]),
    ("VTP, VTU", ".vtp", [
        ("arrays in text, base64 or appended, either byte order", "a.vtp", vtp()),
        *cases(("compressed by zlib or LZMA", "binaryvtkZLibDataCompressor.vtp")),
        *cases(("compressed by LZ4", "rawvtkLZ4DataCompressor.vtp")),
        ("compressed by what nobody knows", "c.vtp", vtp().replace(b"version=", b'compressor="vtkOdd" version=')),
        ("XML that declares entities", "d.vtp", vtp().replace(b"<VTK", b'<!DOCTYPE a [<!ENTITY b "c">]>\n<VTK', 1)),
    ]),
    ("GIFTI (extra `neuro`)", ".gii", [
        ("one set of points and one of triangles", "a.gii", gifti()),
        ("data in other files", "b.gii", gifti().replace(b'ExternalFileName=""', b'ExternalFileName="a.dat"')),
    ]),
    ("FreeSurfer (extra `neuro`)", ".white", [("binary surfaces", "lh.white", FREESURFER)]),
    ("FreeSurfer, text", ".asc", [("surfaces", "lh.white.asc", FREESURFER_TEXT)]),
    ("TOSCA", ".tri", [("`.vert` beside `.tri`", "a.tri", "1 2 3\n1 3 4\n1 4 2\n2 4 3\n")]),
    ("any of these", ".ply.gz", [
        ("packed by gzip", "a.off.gz", gzip.compress(OFF.encode())),
        ("packed, and more than 100 times as large", "b.off.gz", gzip.compress(OFF.encode() + bytes(1 << 25))),
    ]),
    ("FBX, Blender, STEP, USD, 3MF, COLLADA, VRML, Gmsh", ".fbx", [("anything", "a.fbx", b"Kaydara FBX Binary  \0")]),
]  # fmt: skip
BESIDE = {"a.vert": V_TEXT}  # what must lie in the same folder
