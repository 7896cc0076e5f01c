"""Matrices of docs/gallery.py as images: functional maps, and bounds of distances between shapes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

Names = dict[str, Any]  # what a script has computed, by the names it gave


def matrices(path: Path, example: Names) -> None:
    """13: functional maps and self functional maps as images."""
    shown = {f"{name}\nC": found.matrix for name, found in example["maps"].items()}
    names = ("self, standing", "self, walking")
    shown |= {f"{name}\n|C|": np.abs(c) for name, c in zip(names, example["signatures"], strict=True)}
    figure = Figure(figsize=(11, 2.3), dpi=80, layout="constrained")
    for axis, (name, matrix) in zip(figure.subplots(1, len(shown)), shown.items(), strict=True):
        limit = np.abs(matrix).max()
        colours = {"cmap": "RdBu_r", "vmin": -limit} if name.endswith("\nC") else {"cmap": "cividis", "vmin": 0}
        axis.imshow(matrix, vmax=limit, interpolation="nearest", **colours)
        axis.set_title(name, fontsize=10)
        axis.set_xticks([])
        axis.set_yticks([])
    figure.savefig(path)


def bounds(path: Path, example: Names) -> None:
    """15: upper bounds of the Gromov-Wasserstein distance as matrices."""
    names, most = list(example["shapes"]), max(matrix.max() for matrix in example["apart"].values())
    figure = Figure(figsize=(8.5, 3.2), dpi=80, layout="constrained")
    for (metric, matrix), axis in zip(example["apart"].items(), figure.subplots(1, 2), strict=True):
        axis.imshow(matrix, cmap="cividis", vmin=0, vmax=most)
        axis.set_title(f"Gromov-Wasserstein at most, {metric}", fontsize=10)
        axis.set_xticks([])
        axis.set_yticks(range(len(names)), names, fontsize=10)
        for (i, j), value in np.ndenumerate(matrix):
            axis.text(j, i, f"{value:.3f}", ha="center", va="center", color="black" if value > most / 2 else "white")
    figure.savefig(path)
