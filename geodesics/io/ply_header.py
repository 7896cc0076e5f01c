"""The header of a PLY file: its encoding, and which elements with which properties follow."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from geodesics.errors import BadToken, FormatError, TruncatedFile
from geodesics.io.text import count, rows

_END = re.compile(rb"(?:^|[\r\n])end_header[ \t]*(\r\n|\n|\r)")
_KINDS = {  # dtype of a number, by the names of its type in a header
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8", "byte", "ubyte"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
    "float16": "f2",
    "int64": "i8",
    "uint64": "u8",
}


@dataclass(frozen=True)
class Property:
    """A number, or a list of numbers with its length in front, of type `size`."""

    name: str
    kind: str
    size: str = ""


@dataclass
class Element:
    """One element of the header: how many, and what each has."""

    name: str
    length: int
    properties: list[Property] = field(default_factory=list)

    @property
    def least(self) -> tuple[int, int]:
        """The fewest bytes that one takes, as text and as binary: lists may be empty."""
        binary = sum(int((each.size or each.kind)[1]) for each in self.properties)
        return 2 * len(self.properties), binary

    def find(self, *names: str) -> int:
        """The place of the first property of one of these names, or -1."""
        return next((i for i, each in enumerate(self.properties) if each.name.lower() in names), -1)


@dataclass(frozen=True)
class Header:
    """Elements by name, in their order; encoding; the byte where data begin, and the number of lines before."""

    elements: dict[str, Element]
    encoding: str
    body: int
    n_lines: int


def read_header(data: bytes, path: Path) -> Header:
    """The header of a PLY file, whose counts the file is long enough for."""
    end = _END.search(data)
    if not end:
        raise TruncatedFile(f"{path}: the header has no end_header")
    body = end.end()
    if end[1] == b"\r\n" and not re.match(rb"ply[ \t]*\r\n", data.removeprefix(b"\xef\xbb\xbf")):
        body -= 1  # lines end in a carriage return, and the data happen to begin with the byte of a line feed
    elements: dict[str, Element] = {}
    encoding, last = "", None
    for line, words in list(rows(data[: end.start()], path, comment=None))[1:]:
        place = f"{path}, line {line}"
        if words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "format" and len(words) == 3:
            encoding = words[1]
        elif words[0] == "element" and len(words) == 3:
            last = Element(words[1], count(words[2], 1, data, place))
            if last.name in elements:
                raise FormatError(f"{path}: the header declares element {last.name[:40]} twice")
            elements[last.name] = last
        elif words[0] == "property" and last is not None:
            last.properties.append(_property(words, place))
        else:
            raise BadToken(f"{place}: {' '.join(words)[:60]!r} does not belong in a PLY header")
    if encoding not in ("ascii", "binary_little_endian", "binary_big_endian"):
        raise FormatError(f"{path}: format {encoding[:40]!r} is not a PLY encoding")
    least = sum(element.length * element.least[encoding != "ascii"] for element in elements.values())
    if least > len(data) - body + 1:
        raise TruncatedFile(f"{path}: the header promises at least {least} bytes of data, {len(data) - body} are there")
    head = data[:body]
    return Header(elements, encoding, body, head.count(b"\n") or head.count(b"\r"))


def _property(words: list[str], place: str) -> Property:
    is_list = len(words) == 5 and words[1] == "list"
    types = words[2:4] if is_list else words[1:2]
    if len(words) != (5 if is_list else 3) or any(kind not in _KINDS for kind in types):
        raise BadToken(f"{place}: {' '.join(words)[:60]!r} is not a property PLY knows")
    kinds = [_KINDS[kind] for kind in types]
    return Property(words[-1], kinds[-1], kinds[0] if is_list else "")
