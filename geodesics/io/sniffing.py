"""What format a file is in: the content decides, not the name."""

from __future__ import annotations

import re
from pathlib import Path

from geodesics.errors import UnknownFormat
from geodesics.io.opening import SUPPORTED, unpacked_name

_BEFORE = rb"\s*(?:#[^\r\n]*[\r\n]\s*)*"  # blank lines and comments
_OFF = re.compile(_BEFORE + rb"(?:ST|C|N|4)*OFF(?![a-z_])", re.IGNORECASE)
_COUNTS = re.compile(_BEFORE + rb"\d+\s+\d+\s+\d+\s")  # those of an OFF file, whose keyword Geomview does not ask for
_OBJ = re.compile(
    _BEFORE + rb"(?:v|vn|vt|vp|f|fo|l|p|o|g|s|mg|mtllib|usemtl|usemap|maplib|bevel|lod|c_interp|d_interp|cstype|deg"
    rb"|shadow_obj|trace_obj|ctech|stech|bmat|step|curv2?|surf|parm|trim|hole|scrv|sp|con|call|csh|end)(?=\s)"
)
_OBJ_VERTEX = re.compile(rb"^[ \t]*v[ \t]+[-+.\d]\S*[ \t]+[-+.\d]\S*[ \t]+[-+.\d]", re.MULTILINE)
_XML = re.compile(
    rb"\s*(?:<\?xml[^>]*>\s*|<!--.*?-->\s*|<!DOCTYPE[^>\[]*(?:\[[^\]]*\])?[^>\[]*>\s*)*<(?P<root>[A-Za-z]+)", re.DOTALL
)
_ROOTS = {b"VTKFile": "vtp", b"GIFTI": "gifti"}
_STARTS = (
    (b"glTF", "glb"),
    (b"# vtk DataFile", "vtk"),
    (b"#!ascii", "freesurfer ascii"),
    (b"\xff\xff\xfe", "freesurfer"),
    (b"\xff\xff\xfd", "freesurfer"),
    (b"\xff\xff\xff", "freesurfer"),
)
_OTHERS = (  # formats that people have and that no reader here knows, by how they begin
    (b"Kaydara FBX", "an FBX file"),
    (b"; FBX", "an FBX file"),
    (b"BLENDER", "a Blender file"),
    (b"PK\x03\x04", "a zip archive (such as 3MF or USDZ)"),
    (b"ISO-10303-21", "a STEP file"),
    (b"$MeshFormat", "a Gmsh file"),
    (b"DRACO", "a Draco file"),
    (b"#VRML", "a VRML file"),
    (b"#USDA", "a USD file"),
    (b"PXR-USDC", "a USD file"),
    (b"\x89HDF", "an HDF5 file"),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive"),
    (b"BZh", "a bzip2 archive"),
    (b"\xfd7zXZ", "an xz archive"),
)
_OTHER_ROOTS = {b"COLLADA": "a COLLADA file", b"X3D": "an X3D file", b"svg": "an SVG picture", b"html": "a web page"}


def sniff(data: bytes, path: Path) -> str:
    """The format of `data`, a name of a reader; `UnknownFormat` names what it is, or what is supported."""
    head = data[: 1 << 16].removeprefix(b"\xef\xbb\xbf")
    suffix = unpacked_name(path).suffix.lower()
    for start, kind in _STARTS:
        if head.startswith(start):
            return kind
    if re.match(rb"ply\s", head):
        return "ply"
    if is_binary_stl(data) or re.match(rb"\s*solid\b", head, re.IGNORECASE):
        return "stl"
    if head.lstrip()[:1] == b"<":
        return _marked_up(head, path)
    if head.lstrip()[:1] == b"{":
        return "gltf"
    if suffix in (".vert", ".tri") and re.match(rb"\s*[-+.\d]", head):
        return "tosca"
    if _OFF.match(head) or (suffix == ".off" and _COUNTS.match(head)):
        return "off"
    if _OBJ.match(head):
        return "obj"
    if suffix == ".stl":
        return "stl"
    if b"\0" not in head and _OBJ_VERTEX.search(head):
        return "obj"
    raise _unknown(path, next((name for start, name in _OTHERS if head.startswith(start)), ""))


def _marked_up(head: bytes, path: Path) -> str:
    found = _XML.match(head)
    root = found["root"] if found else b""
    if root in _ROOTS:
        return _ROOTS[root]
    raise _unknown(path, _OTHER_ROOTS.get(root, ""))


def _unknown(path: Path, name: str) -> UnknownFormat:
    if name:
        return UnknownFormat(
            f"{path}: this is {name}; unpack or export it to one of the supported formats: {SUPPORTED}"
        )
    return UnknownFormat(f"{path}: the content is none of the supported formats: {SUPPORTED}")


def is_binary_stl(data: bytes) -> bool:
    """Whether the triangle count of a binary STL header agrees with the length, the one sign that can be trusted."""
    return len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
