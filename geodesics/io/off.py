"""OFF: a header, the counts, one vertex a line, one face a line."""

from __future__ import annotations

import re
from pathlib import Path

from geodesics.errors import BadCount, TruncatedFile, UnknownFormat
from geodesics.io.text import Contents, Row, corners, count, fan, numbers, rows
from geodesics.io.truncation import refuse_cut_face


def read_off(data: bytes, path: Path) -> Contents:
    """An ASCII OFF file, with any of the prefixes ST, C, N; more lines than declared are allowed, fewer are not."""
    table = list(rows(data, path))
    line, words = table[0]
    keyword = re.match(r"(?:ST)?C?N?OFF", words[0], re.IGNORECASE)
    if keyword is None or "BINARY" in (word.upper() for word in words):
        raise UnknownFormat(f"{path}, line {line}: only ASCII OFF in three dimensions is supported")
    rest = [word for word in (words[0][keyword.end() :], *words[1:]) if word]
    body = table[1:]
    if not rest:
        if not body:
            raise TruncatedFile(f"{path}, line {line}: the file ends before its counts")
        line, rest = body[0]
        body = body[1:]
    return _read_body(Row(line, rest), body, data, path)


def _read_body(header: Row, body: list[Row], data: bytes, path: Path) -> Contents:
    place = f"{path}, line {header.line}"
    if len(header.words) < 2:
        raise BadCount(f"{place}: vertex and face counts expected")
    n_vertices = count(header.words[0], 6, data, place)
    n_faces = count(header.words[1], 8, data, place)
    if len(body) < n_vertices + n_faces:
        raise TruncatedFile(
            f"{path}: {n_vertices} vertices and {n_faces} faces are declared, but only {len(body)} lines follow"
        )
    vertices = numbers(body[:n_vertices], 0, path)
    polygons = [corners(row, 0, n_vertices, 0, path) for row in body[n_vertices : n_vertices + n_faces]]
    if len(body) == n_vertices + n_faces:
        refuse_cut_face(data, polygons, n_vertices, 0, path)
    triangles, notes = fan(polygons)
    return Contents(vertices, triangles, notes)
