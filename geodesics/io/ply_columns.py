"""Columns of an element of a PLY file, text or binary: numbers, or lists of any lengths."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadPolygon, BadToken, TruncatedFile
from geodesics.io.cells import Cells
from geodesics.io.ply_header import Element, Property
from geodesics.io.text import Row, numbers, whole


@dataclass(frozen=True, eq=False)
class TextColumns:
    """An element in text: its lines, and where each property begins in each, (n, properties)."""

    element: Element
    rows: list[Row]
    starts: Integers
    path: Path

    def numbers(self, places: list[int]) -> Floats:
        """Number properties (n, k)."""
        picked = [
            Row(row.line, [row.words[at[i]] for i in places])
            for row, at in zip(self.rows, self.starts.tolist(), strict=True)
        ]
        return numbers(picked, 0, self.path, len(places), unknown=True)

    def lists(self, place: int) -> Cells:
        """A list property of whole numbers: lengths (n,) and content."""
        sizes, flat = [], []
        for row, at in zip(self.rows, self.starts[:, place].tolist(), strict=True):
            where = f"{self.path}, line {row.line}"
            size = whole(row.words[at], where)
            if size < 0:
                raise BadPolygon(f"{where}: a list of {size} entries")
            sizes.append(size)
            flat += [whole(word, where) for word in row.words[at + 1 : at + 1 + size]]
        return np.array(sizes, dtype=np.int64), np.clip(np.array(flat, dtype=object), -1, 2**62).astype(np.int64)

    def number_lists(self, place: int) -> tuple[Integers, Floats]:
        """A list property of any numbers: lengths (n,) and content."""
        at = self.starts[:, place].tolist()
        sizes = [whole(row.words[i], f"{self.path}, line {row.line}") for row, i in zip(self.rows, at, strict=True)]
        flat = [
            numbers([row], i + 1, self.path, size, unknown=True).ravel()
            for row, i, size in zip(self.rows, at, sizes, strict=True)
            if size
        ]
        return np.array(sizes, dtype=np.int64), np.concatenate([np.empty(0), *flat])

    def place(self, row: int) -> str:
        """Of a row, for messages."""
        return f"{self.path}, line {self.rows[row].line}"


def read_text(element: Element, lines: Iterator[Row], path: Path) -> TextColumns:
    """The lines of an element, each of which must hold what the header promises, or more."""
    table = list(islice(lines, element.length))
    if len(table) < element.length:
        raise TruncatedFile(f"{path}: {element.length} of {element.name} are declared, {len(table)} found")
    starts = [_starts(element, row, path) for row in table]
    return TextColumns(
        element, table, np.array(starts, dtype=np.int64).reshape(len(table), len(element.properties)), path
    )


def _starts(element: Element, row: Row, path: Path) -> list[int]:
    place = f"{path}, line {row.line}"
    starts, at = [], 0
    for each in element.properties:
        starts.append(at)
        if at >= len(row.words):
            raise TruncatedFile(f"{place}: the line ends before all properties of {element.name}")
        at += 1 + (max(whole(row.words[at], place), 0) if each.size else 0)
    if at > len(row.words):
        error = BadPolygon if element.name == "face" else TruncatedFile
        raise error(f"{place}: {len(row.words)} numbers where {element.name} needs {min(at, 10**20)}")
    return starts


@dataclass(frozen=True, eq=False)
class BinaryColumns:
    """An element in binary: the byte where each property begins in each row, (n, properties), and lengths of lists."""

    element: Element
    data: bytes
    order: str
    starts: Integers
    sizes: Integers
    path: Path

    def numbers(self, places: list[int]) -> Floats:
        """Number properties (n, k)."""
        columns = [self._gathered(self.starts[:, i], self.element.properties[i].kind) for i in places]
        with np.errstate(invalid="ignore"):
            return np.column_stack(columns).astype(np.float64)

    def lists(self, place: int) -> Cells:
        """A list property of whole numbers: lengths (n,) and content."""
        each = self.element.properties[place]
        if each.kind[0] == "f":
            raise BadToken(f"{self.path}: the {each.name[:40]} are of type {each.kind}, not integers")
        sizes, values = self._list(place)
        if each.kind == "u8":
            values = np.minimum(values, 2**62)
        return sizes, values.astype(np.int64)

    def number_lists(self, place: int) -> tuple[Integers, Floats]:
        """A list property of any numbers: lengths (n,) and content."""
        sizes, values = self._list(place)
        return sizes, values.astype(np.float64)

    def _list(self, place: int) -> tuple[Integers, NDArray[Any]]:
        each, sizes = self.element.properties[place], self.sizes[:, place]
        before = np.repeat(np.cumsum(sizes) - sizes, sizes)
        within = np.arange(len(before)) - before
        at = np.repeat(self.starts[:, place] + int(each.size[1]), sizes) + int(each.kind[1]) * within
        return sizes, self._gathered(at, each.kind)

    def _gathered(self, at: Integers, kind: str) -> NDArray[np.generic]:
        """The numbers that begin at these bytes."""
        width = int(kind[1])
        held = np.frombuffer(self.data, dtype=np.uint8)
        table = held[at[:, None] + np.arange(width)] if len(at) else np.empty((0, width), dtype=np.uint8)
        return np.ascontiguousarray(table).view(self.order + kind)[:, 0]

    def place(self, row: int) -> str:
        """Of a row, for messages."""
        return f"{self.path}, {self.element.name} {row}"


def read_binary(element: Element, data: bytes, at: int, order: str, path: Path) -> tuple[BinaryColumns, int]:
    """The columns of an element that begins at a byte, and the byte where it ends."""
    n, properties = element.length, element.properties
    if n == 0 or not properties:
        empty = np.empty((n, len(properties)), dtype=np.int64)
        return BinaryColumns(element, data, order, empty, empty, path), at
    starts, sizes, end = _one_row(properties, data, at, order, element, path)
    stride = end - at
    if at + n * stride <= len(data) and all(
        _all_are(sizes[i], n, each, data, starts[i], stride, order) for i, each in enumerate(properties) if each.size
    ):
        rows = np.arange(n)[:, None] * stride
        return BinaryColumns(element, data, order, starts + rows, np.tile(sizes, (n, 1)), path), at + n * stride
    every: list[tuple[list[int], list[int]]] = []
    for _ in range(n):
        starts, sizes, at = _one_row(properties, data, at, order, element, path)
        every.append((starts, sizes))
    table = np.array(every, dtype=np.int64)
    return BinaryColumns(element, data, order, table[:, 0], table[:, 1], path), at


def _all_are(size: int, n: int, each: Property, data: bytes, start: int, stride: int, order: str) -> bool:
    """Whether all lists of a property are as long as the first, if they were."""
    return bool((np.ndarray((n,), order + each.size, data, start, (stride,)) == size).all())


_CODES = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d", "i8": "q", "u8": "Q"}


def _one_row(
    properties: list[Property], data: bytes, at: int, order: str, element: Element, path: Path
) -> tuple[list[int], list[int], int]:
    """Where each property of one row begins, how long its lists are, and where the row ends."""
    starts, sizes = [], []
    for each in properties:
        starts.append(at)
        size = 1
        if each.size:
            if at + int(each.size[1]) > len(data):
                raise _cut(element, path, len(data))
            (found,) = struct.unpack_from(order + _CODES.get(each.size, "e"), data, at)
            if not 0 <= found <= len(data):
                raise _cut(element, path, len(data))
            at, size = at + int(each.size[1]), int(found)
        sizes.append(size)
        at += size * int(each.kind[1])
    if at > len(data):
        raise _cut(element, path, len(data))
    return starts, sizes, at


def _cut(element: Element, path: Path, n_bytes: int) -> TruncatedFile:
    return TruncatedFile(
        f"{path}: the {n_bytes} bytes of the file end before all that its header promises as {element.name}"
    )
