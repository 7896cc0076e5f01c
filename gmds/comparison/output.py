"""The files that describe a collection of compared shapes: tables, a picture, a page."""

from __future__ import annotations

import html
import io
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from geodesics.io import atomic_write
from gmds.comparison.clustering import nearest, plane_map, tree
from gmds.comparison.figure import comparison_figure
from gmds.comparison.folder import Compared
from gmds.files.table import write_table
from gmds.pictures.figure import without_glyph_warnings

Neighbour = tuple[str, int, str, float, float | None]  # shape, rank, other, bound, distortion

NEIGHBOURS_SHOWN = 5  # neighbours of each shape; set by hand
DISTORTION = "the distortion of the best embeddings found of two shapes in each other"


def write_comparison(compared: Compared, folder: Path, *, title: str = "Dissimilarity of shapes") -> None:
    """Write matrix.csv, nearest.csv, tree.csv, map.csv, compare.png and compare.html, each atomically.

    The page is one file that loads nothing and runs nothing. Raises `MissingExtra` without the extra `viz`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    names, matrix = compared.names, compared.matrix
    rows = ([name, *row.tolist()] for name, row in zip(names, matrix, strict=True))
    write_table(folder / "matrix.csv", ["", *names], rows)
    neighbours = [
        (name, rank + 1, names[j], float(compared.bounds[i, j]), _known(compared.distortions[i, j]))
        for i, (name, row) in enumerate(zip(names, nearest(matrix, NEIGHBOURS_SHOWN), strict=True))
        for rank, j in enumerate(row)
        if i != j
    ]
    write_table(folder / "nearest.csv", ["shape", "rank", "other", "bound", "distortion"], neighbours)
    merges = ((int(a), int(b), float(height), int(size)) for a, b, height, size in tree(matrix))
    write_table(folder / "tree.csv", ["cluster", "other", "height", "shapes"], merges)
    places = ((name, *map(float, place)) for name, place in zip(names, plane_map(matrix), strict=True))
    write_table(folder / "map.csv", ["shape", "x", "y"], places)
    figure = comparison_figure(names, matrix)
    with atomic_write(folder / "compare.png") as stream, without_glyph_warnings():
        figure.savefig(stream, format="png", metadata={"Software": None})
    page = _page(compared, neighbours, _svg(figure), title)
    with atomic_write(folder / "compare.html") as stream:
        stream.write(page.encode("utf-8", "replace"))


def _svg(figure: Any) -> str:
    """The figure as an element of a page."""
    import matplotlib

    text = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "gmds"}), without_glyph_warnings():
        figure.savefig(text, format="svg", metadata={"Date": None})
    drawn = text.getvalue()
    return drawn[drawn.index("<svg") :]


def _known(distortion: float) -> float | None:
    return float(distortion) if np.isfinite(distortion) else None


def _page(compared: Compared, neighbours: Sequence[Neighbour], drawn: str, title: str) -> str:
    lines = []
    for name in compared.names:
        near = (f"<td>{html.escape(n[2])} <small>{_figures(n)}</small></td>" for n in neighbours if n[0] == name)
        lines.append(f"<tr><th>{html.escape(name)}</th>{''.join(near)}</tr>")
    left_out = "".join(f"<li>{html.escape(name)}: {html.escape(why)}</li>" for name, why in compared.failures.items())
    count = len(compared.names)
    return Template((files("gmds.comparison") / "compare.html").read_text("utf-8")).substitute(
        title=html.escape(title),
        shapes=count,
        pairs=count * (count - 1) // 2,
        embedded=compared.embedded_pairs,
        shown=DISTORTION if compared.matrix is compared.distortions else compared.by.words,
        figure=drawn,
        rows="".join(lines),
        failures=f"<h2>Left out</h2><ul>{left_out}</ul>" if left_out else "",
    )


def _figures(neighbour: Neighbour) -> str:
    return f"{neighbour[3]:.3f}" + ("" if neighbour[4] is None else f" / {neighbour[4]:.3f}")
