"""From a path to bytes: only regular files are opened, and what is packed by gzip is unpacked within bounds."""

from __future__ import annotations

import codecs
import gzip
import io
import os
import stat
import zlib
from pathlib import Path

from geodesics.errors import EmptyFile, InflatesTooFar, LineTooLong, NotAFile, TruncatedFile

LONGEST_LINE = 1 << 20  # bytes; a bound far above any line of a mesh, so that a file without line ends is refused early
SUPPORTED = "OFF, OBJ, PLY, STL, GLB, glTF, VTK, VTP, GIFTI, FreeSurfer, and TOSCA .vert/.tri"

# How far a packed file may grow: meshes of text shrink to a quarter, sometimes to a tenth, and a gigabyte of zeros to
# a thousandth. What is small when it is unpacked may have any ratio. Both are set by hand, in bytes and as a factor.
SMALL_WHEN_INFLATED, LARGEST_RATIO = 1 << 24, 100


def read_bytes(path: Path) -> bytes:
    """The content of a regular file; `NotAFile` for directories, pipes and devices, which could block for ever.

    A file that is packed by gzip, whatever its name, is unpacked: `InflatesTooFar` beyond the bounds above.
    """
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise NotAFile(f"{path}: not a regular file; give the path of a mesh file ({SUPPORTED})")
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise NotAFile(f"{path}: not a regular file; give the path of a mesh file ({SUPPORTED})")
        start = file.read(LONGEST_LINE)
        if not start.strip():
            raise EmptyFile(f"{path}: the file is empty")
        pieces = [start]
        is_text = b"\0" not in start and not start.startswith(b"\x1f\x8b") and not is_marked_up(start)
        while piece := file.read(LONGEST_LINE):
            if is_text and len(piece) == LONGEST_LINE and b"\n" not in piece and b"\r" not in piece:
                raise LineTooLong(f"{path}: a line is longer than {LONGEST_LINE} bytes")
            pieces.append(piece)
    data = b"".join(pieces)
    return recoded(_unpacked(data, path) if data.startswith(b"\x1f\x8b") else data)


def recoded(data: bytes) -> bytes:
    """Text in UTF-16, as PowerShell and the Unicode text of spreadsheets are, in UTF-8; anything else as it is."""
    if not data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data
    try:
        return data.decode("utf-16").encode("utf-8")
    except UnicodeError:
        return data


def is_marked_up(start: bytes) -> bool:
    """Whether a file is XML or JSON, whose lines are as long as its numbers are many."""
    return start[:64].removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"<", b"{")


def unpacked_name(path: Path) -> Path:
    """The path without .gz, whose ending then is that of the format."""
    return path.with_suffix("") if path.suffix.lower() == ".gz" else path


def _unpacked(data: bytes, path: Path) -> bytes:
    bound = max(SMALL_WHEN_INFLATED, LARGEST_RATIO * len(data))
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as stream:
            content = stream.read(bound + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise TruncatedFile(f"{path}: the gzip file is cut off or damaged ({error})") from error
    if len(content) > bound:
        raise InflatesTooFar(
            f"{path}: more than {bound} bytes come out of {len(data)}; unpack it by hand if it is sound"
        )
    if not content.strip():
        raise EmptyFile(f"{path}: the packed file is empty")
    return content
