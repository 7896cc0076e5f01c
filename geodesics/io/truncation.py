"""The one truncation that counts cannot reveal: a file cut inside its very last line."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from geodesics.errors import TruncatedFile


def refuse_cut_face(
    data: bytes, polygons: list[list[int]], n_vertices: int, base: int, path: Path, *, any_size: bool = False
) -> None:
    """`TruncatedFile` when the file ends in a face that may have lost digits or corners and does not fit the others.

    A final newline rules a cut out; so does an index that no further digit could extend to another vertex, and so does
    a face whose edges all meet a second face. With `any_size` the format does not say how many corners a face has, and
    a last face smaller than others may have lost some.
    """
    if not polygons or data.endswith((b"\n", b"\r")):
        return
    last = polygons[-1]
    written = last[-1] + base if last else 0
    may_lose_digits = data[-1:].isdigit() and written > 0 and 10 * written - base < n_vertices
    may_lose_corners = any_size and len(last) < max(map(len, polygons))
    if not (may_lose_digits or may_lose_corners):
        return
    shared = Counter(frozenset(edge) for p in polygons for edge in zip(p, p[1:] + p[:1], strict=True))
    if len(last) < 3 or any(shared[frozenset(edge)] != 2 for edge in zip(last, last[1:] + last[:1], strict=True)):
        raise TruncatedFile(
            f"{path}: the file ends inside its last line, whose face does not fit its neighbours; "
            "if the file is complete, end it with a newline"
        )
