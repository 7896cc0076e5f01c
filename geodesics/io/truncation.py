"""The one truncation that counts can not show: a file cut inside its very last number."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from geodesics.errors import TruncatedFile


def refuse_cut_index(data: bytes, polygons: list[list[int]], n_vertices: int, base: int, path: Path) -> None:
    """`TruncatedFile` when the file ends in an index that may have lost digits and the last face does not fit.

    A final newline rules a cut out; so does an index no further digit could extend, and so does a last face whose
    edges all meet a second face.
    """
    if not polygons or not data[-1:].isdigit():
        return
    written = polygons[-1][-1] + base
    if written == 0 or 10 * written - base >= n_vertices:
        return
    edges = Counter(frozenset(edge) for p in polygons for edge in zip(p, p[1:] + p[:1], strict=True))
    last = polygons[-1]
    if any(edges[frozenset(edge)] != 2 for edge in zip(last, last[1:] + last[:1], strict=True)):
        raise TruncatedFile(
            f"{path}: the file ends in the number {written} without a newline and the last face does not fit its "
            "neighbours; if the file is complete, end it with a newline"
        )
