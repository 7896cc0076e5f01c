"""A place in a file that mixes lines of words with arrays of numbers, in text or big-endian binary."""

from __future__ import annotations

import re
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics.errors import BadCount, BadToken, TruncatedFile
from geodesics.io.text import Row, count, numbers

_WORD = re.compile(rb"\S+")
_KINDS = {
    "float": ">f4",
    "double": ">f8",
    "char": ">i1",
    "signed_char": ">i1",
    "unsigned_char": ">u1",
    "short": ">i2",
    "unsigned_short": ">u2",
    "int": ">i4",
    "unsigned_int": ">u4",
    "long": ">i8",
    "unsigned_long": ">u8",
    "vtkidtype": ">i4",
    "vtktypeint64": ">i8",
    "vtktypeuint64": ">u8",
    "vtktypeint32": ">i4",
}


class Cursor:
    """Reads a file from its beginning to its end; every error names the line or the byte."""

    def __init__(self, data: bytes, path: Path) -> None:
        self.data, self.path, self.at, self.binary = data, path, 0, False

    def line(self) -> str:
        """The next line, without its end."""
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text = self.data[self.at : min(end, self.at + 4096)]
        self.at = end + 1
        return text.decode("latin-1").rstrip("\r")

    def words(self) -> list[str]:
        """Those of the next line that is not blank; none at the end of the file."""
        while self.at < len(self.data):
            if found := self.line().split():
                return found
        return []

    def peek(self) -> str:
        """The next word, which stays."""
        found = _WORD.search(self.data, self.at, self.at + 4096)
        return found[0].decode("latin-1") if found else ""

    def count(self, words: list[str], which: int) -> int:
        """A declared number of things, each of which takes a byte or more."""
        if which >= len(words):
            raise BadCount(f"{self.path}{self.place()}: {words[0][:40] if words else 'nothing'} has no count")
        return count(words[which], 1, self.data, f"{self.path}{self.place()}")

    def array(self, n: int, kind: str) -> NDArray[np.generic]:
        """The next `n` numbers of a kind that the file names."""
        if kind not in _KINDS:
            raise self.unexpected(kind, "a type of numbers")
        if self.binary:
            dtype = np.dtype(_KINDS[kind])
            end = self.at + n * dtype.itemsize
            if end > len(self.data):
                raise TruncatedFile(
                    f"{self.path}, byte {self.at}: {n} numbers of type {kind} take {end - self.at} bytes, "
                    f"{len(self.data) - self.at} are there"
                )
            values = np.frombuffer(self.data, dtype, n, self.at)
            self.at = end
            return values
        found = list(islice(_WORD.finditer(self.data, self.at), n))
        if len(found) < n:
            raise TruncatedFile(f"{self.path}{self.place()}: {n} numbers are declared, {len(found)} found")
        row = Row(self.line_number(), [match[0].decode("latin-1") for match in found])
        self.at = found[-1].end() if found else self.at
        return numbers([row], 0, self.path, len(found), unknown=True).ravel()

    def skip(self, n: int, kind: str) -> None:
        """Passes over an array, which may be of words, a line each, or of bits."""
        if kind == "string":
            for _ in range(n):
                self.line()
        elif not self.binary:
            for match in islice(_WORD.finditer(self.data, self.at), n):
                self.at = match.end()
        else:
            self.array(*((n + 7) // 8, "char") if kind == "bit" else (n, kind))

    def skip_to_blank(self) -> None:
        """Passes over a block of lines that a blank one ends."""
        while self.at < len(self.data) and self.line().strip():
            pass

    def line_number(self) -> int:
        """Of the place in a text, from 1."""
        return self.data.count(b"\n", 0, max(self.at - 1, 0)) + 1

    def place(self) -> str:
        """For messages."""
        return f", byte {self.at}" if self.binary else f", line {self.line_number()}"

    def unexpected(self, found: str, wanted: str) -> BadToken:
        """An error that says what was found instead of what was wanted."""
        return BadToken(f"{self.path}{self.place()}: {wanted} expected, {found[:60]!r} found")
