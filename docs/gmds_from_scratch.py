"""The pictures of docs/gmds-from-scratch.md: its blocks of code are run, and what they computed is drawn.

python docs/gmds_from_scratch.py
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

import geodesics
import gmds
from gmds.pictures import write_values

DOCS = Path(__file__).resolve().parent
BLUE, GREY, RED = "#3b496c", "0.6", "#c0392b"


def computed() -> dict[str, Any]:
    """What the blocks of the page leave behind."""
    names: dict[str, Any] = {}
    page = (DOCS / "gmds-from-scratch.md").read_text(encoding="utf-8")
    for block in re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL):
        exec(compile(block, "gmds-from-scratch.md", "exec"), names)
    return names


def cells(mesh: geodesics.Mesh, points: geodesics.SurfacePoints) -> Any:
    """The nearest of some points, for each vertex."""
    return geodesics.GeodesicDistance(mesh).field(points).argmin(axis=0)


def places(path: Path, found: dict[str, Any]) -> None:
    """Cells of samples, of the start and of the end."""
    target = found["target"]
    panels = [("samples", found["source"], cells(found["source"], found["here"]))]
    panels += [(name, target, cells(target, found[key])) for name, key in (("start", "start"), ("end", "points"))]
    write_values(path, panels, labels=True, pixels=300)


def stress(path: Path, found: dict[str, Any]) -> None:
    """The stress step by step, and residuals in order."""
    figure = Figure(figsize=(9, 3), dpi=90, layout="constrained")
    left, right = figure.subplots(1, 2)
    left.semilogy(range(1, 17), found["stress"], color=BLUE, label="stress")
    left.set_xlabel("step")
    left.xaxis.set_major_locator(MaxNLocator(integer=True))
    left.set_ylabel("stress", color=BLUE)
    other = left.twinx()
    other.plot(range(1, 17), found["error"], color=RED)
    other.set_ylabel("mean error x100", color=RED)
    other.set_ylim(0)
    for key, name, colour in (
        ("least", "least squares", BLUE),
        ("alone", "maximum alone", GREY),
        ("most", "ladder", RED),
    ):
        right.plot(np.sort(np.abs(found[key].residuals)), color=colour, label=name)
    right.set_xlabel("pairs of points, in order")
    right.set_ylabel("|residual| in mean distances")
    right.legend(frameon=False)
    figure.savefig(path)


def metrics(path: Path, found: dict[str, Any]) -> None:
    """Distances to where each point should be, by the cells of the true points."""
    target, panels = found["target"], []
    nearest = cells(target, found["true"])
    for exponent, points in found["places"].items():
        panels.append((f"|K|^{exponent:g} g", target, 100 * gmds.geodesic_error(points, found["true"])[nearest]))
    write_values(path, panels, title="error of the point of each cell", label="error x100", pixels=300)


def main() -> None:
    """Draw all three."""
    found, folder = computed(), DOCS / "scratch"
    folder.mkdir(exist_ok=True)
    for draw in (places, stress, metrics):
        draw(folder / f"{draw.__name__}.png", found)


if __name__ == "__main__":
    main()
