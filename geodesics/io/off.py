"""OFF: a header, which some leave out, the counts, one vertex a line, one face a line."""

from __future__ import annotations

import re
from itertools import chain
from pathlib import Path

import numpy as np

from geodesics.errors import BadCount, TruncatedFile, UnknownFormat
from geodesics.io.contents import Contents
from geodesics.io.polygons import split
from geodesics.io.text import Row, corners, count, numbers, rows
from geodesics.io.truncation import refuse_cut_face
from geodesics.notes import Note


def read_off(data: bytes, path: Path) -> Contents:
    """An ASCII OFF file, with any of the prefixes ST, C, N; more lines than declared are allowed, fewer are not."""
    table = list(rows(data, path))
    line, words = table[0]
    keyword = re.match(r"(ST|C|N|4)*OFF|(?=\d)", words[0], re.IGNORECASE)
    if keyword is None or "4" in keyword[0] or words[0].startswith("nOFF") or "BINARY" in (w.upper() for w in words):
        raise UnknownFormat(f"{path}, line {line}: only ASCII OFF in three dimensions is supported")
    rest = [word for word in (words[0][keyword.end() :], *words[1:]) if word]
    body = table[1:]
    if not rest:
        if not body:
            raise TruncatedFile(f"{path}, line {line}: the file ends before its counts")
        line, rest = body[0]
        body = body[1:]
    if len(body) > 1 and len(rest) == 1 and len(body[0].words) + len(body[1].words) == 2:  # a count a line
        rest, body = [*rest, *body[0].words, *body[1].words], body[2:]
    return _read_body(Row(line, rest), body, data, path)


def _read_body(header: Row, body: list[Row], data: bytes, path: Path) -> Contents:
    place = f"{path}, line {header.line}"
    if len(header.words) < 2:
        raise BadCount(f"{place}: vertex and face counts expected")
    n_vertices = count(header.words[0], 6, data, place)
    n_faces = count(header.words[1], 8, data, place)
    if len(body) < n_vertices + n_faces:
        body = [Row(header.line, header.words[3:]), *body] if header.words[3:] else body
        body = _rearranged(body, n_vertices, n_faces)
    if len(body) < n_vertices + n_faces:
        raise TruncatedFile(
            f"{path}: {n_vertices} vertices and {n_faces} faces are declared, but only {len(body)} lines follow"
        )
    vertices = numbers(body[:n_vertices], 0, path, unknown=True)
    polygons = [corners(row, 0, n_vertices, 0, path) for row in body[n_vertices : n_vertices + n_faces]]
    if len(body) == n_vertices + n_faces:
        refuse_cut_face(data, polygons, n_vertices, 0, path)
    sizes, flat = list(map(len, polygons)), [corner for polygon in polygons for corner in polygon]
    triangles, slots, notes = split(sizes, flat, vertices)
    behind = len(body) - n_vertices - n_faces
    if behind:
        notes.append(Note("W220", "info", f"{behind} lines behind the last face were passed over"))
    return Contents(
        vertices, triangles, notes, slots=slots, polygons=(np.array(sizes, np.int64), np.array(flat, np.int64))
    )


def _rearranged(body: list[Row], n_vertices: int, n_faces: int) -> list[Row]:
    """A vertex and a face a row, of a file whose lines end elsewhere; the rows as they are where words do not add up.

    Lines mean nothing where there are no colours: then the numbers of a sound file are used up exactly.
    """
    words = list(chain.from_iterable(row.words for row in body))
    lines = list(chain.from_iterable([row.line] * len(row.words) for row in body))
    made, at = [], 0
    for number in range(n_vertices + n_faces):
        if at >= len(words):
            return body
        size = 3
        if number >= n_vertices:
            if not (words[at].isascii() and words[at].isdecimal() and len(words[at]) < 10):
                return body
            size = 1 + int(words[at])
        made.append(Row(lines[at], words[at : at + size]))
        at += size
    return made if at == len(words) else body
