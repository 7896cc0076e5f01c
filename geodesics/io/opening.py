"""From a path to bytes and a format: only regular files are opened, and the content decides, not the name."""

from __future__ import annotations

import os
import re
import stat
from pathlib import Path

from geodesics.errors import EmptyFile, LineTooLong, NotAFile, UnknownFormat

LONGEST_LINE = 1 << 20  # bytes; a bound far above any line of a mesh, so that a file without line ends is refused early
_SUPPORTED = "OFF, OBJ, PLY, STL, GLB, and TOSCA .vert/.tri"
_OFF = re.compile(rb"\s*(#[^\r\n]*[\r\n]\s*)*(ST)?C?N?4?N?OFF\b", re.IGNORECASE)
_OBJ = re.compile(rb"\s*(#[^\r\n]*[\r\n]\s*)*(v|vn|vt|vp|f|o|g|s|mtllib|usemtl)[ \t]")


def read_bytes(path: Path) -> bytes:
    """The content of a regular file; `NotAFile` for directories, pipes and devices, which could block for ever."""
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise NotAFile(f"{path}: not a regular file; give the path of a mesh file ({_SUPPORTED})")
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise NotAFile(f"{path}: not a regular file; give the path of a mesh file ({_SUPPORTED})")
        start = file.read(LONGEST_LINE)
        if not start.strip():
            raise EmptyFile(f"{path}: the file is empty")
        pieces = [start]
        is_text = b"\0" not in start
        while piece := file.read(LONGEST_LINE):
            if is_text and len(piece) == LONGEST_LINE and b"\n" not in piece and b"\r" not in piece:
                raise LineTooLong(f"{path}: a line is longer than {LONGEST_LINE} bytes")
            pieces.append(piece)
    return b"".join(pieces)


def sniff(data: bytes, path: Path) -> str:
    """The format of `data`: "off", "obj", "ply", "stl", "glb" or "tosca"; `UnknownFormat` lists what is supported."""
    head = data[: 1 << 16].removeprefix(b"\xef\xbb\xbf")
    if head.startswith(b"glTF"):
        return "glb"
    if re.match(rb"ply\s", head):
        return "ply"
    if is_binary_stl(data) or re.match(rb"\s*solid\b", head, re.IGNORECASE):
        return "stl"
    if path.suffix.lower() in (".vert", ".tri") and re.match(rb"\s*[-+.\d]", head):
        return "tosca"
    if _OFF.match(head):
        return "off"
    if _OBJ.match(head):
        return "obj"
    if path.suffix.lower() == ".stl":
        return "stl"
    raise UnknownFormat(f"{path}: the content is none of the supported formats: {_SUPPORTED}")


def is_binary_stl(data: bytes) -> bool:
    """Whether the triangle count of a binary STL header agrees with the length, the one sign that can be trusted."""
    return len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
