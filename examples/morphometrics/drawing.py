"""A specimen from both sides with its landmarks, named as in the tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh
from gmds.pictures.camera import Direction, broadside
from gmds.pictures.software import render

Array = NDArray[np.float64]

BODY, GOOD, DOUBTFUL = (0.82, 0.80, 0.76), (0.10, 0.35, 0.75), (0.85, 0.10, 0.10)
BALL = 0.018  # radius, in square roots of the area; set by hand
PIXELS = 560  # of the longer side; set by hand


def draw(
    path: Path, mesh: Mesh, names: Sequence[str], places: Array, doubtful: NDArray[np.bool_], up: Direction
) -> None:
    """A PNG of named landmarks (k, 3) on a mesh: blue, or red where they are `doubtful` (k,); its name is the title.

    Landmarks without a place (NaN) are not drawn.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    there = np.flatnonzero(np.isfinite(places).all(axis=1))
    names, places, doubtful = [names[i] for i in there], places[there], doubtful[there]
    shape, colours = _with_balls(mesh, places, doubtful)
    views = [broadside(mesh, up, azimuth=azimuth) for azimuth in (30.0, 210.0)]
    images = [render(shape, colours, rotation=view, pixels=PIXELS) for view in views]
    height, width = max(len(image) for image in images), sum(image.shape[1] for image in images)
    figure = Figure(figsize=(width / 100, (height + 30) / 100), dpi=100)
    FigureCanvasAgg(figure)
    left = 0
    for view, image in zip(views, images, strict=True):
        rows, columns = image.shape[:2]
        axis = figure.add_axes((left / width, 0, columns / width, rows / (height + 30)))
        axis.imshow(image)
        axis.set_axis_off()
        camera, marks = shape.vertices @ view.T, places @ view.T
        low, high = camera[:, :2].min(axis=0), camera[:, :2].max(axis=0)
        spots = (marks[:, :2] - (low + high) / 2) * (0.94 * PIXELS / (high - low).max()) * [1, -1]
        front = marks[:, 2] >= np.median(camera[:, 2])  # names of what is behind would only be in the way
        for i in np.flatnonzero(front):
            x, y = spots[i] + [columns / 2, rows / 2]
            ink = DOUBTFUL if doubtful[i] else "black"
            axis.text(x + 6, y - 6, names[i], fontsize=8, color=ink, parse_math=False)
        left += columns
    figure.text(0.5, 1 - 4 / (height + 30), path.stem, ha="center", va="top", parse_math=False)
    figure.savefig(path, metadata={"Software": None})


def _with_balls(mesh: Mesh, places: Array, doubtful: NDArray[np.bool_]) -> tuple[Mesh, Array]:
    """The mesh with a ball at every landmark, and the colours of its vertices."""
    corners = np.vstack([np.eye(3), -np.eye(3)]) * BALL * np.sqrt(mesh.area)
    faces = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    n, k = mesh.n_vertices, len(places)
    shape = Mesh(
        np.vstack([mesh.vertices, (places[:, None] + corners).reshape(-1, 3)]),
        np.vstack([mesh.faces, (n + 6 * np.arange(k)[:, None, None] + faces).reshape(-1, 3)]),
    )
    balls = np.where(doubtful[:, None], DOUBTFUL, GOOD)
    return shape, np.vstack([np.tile(BODY, (n, 1)), np.repeat(balls, 6, axis=0)])
