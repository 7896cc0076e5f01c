"""A specimen from both sides with its landmarks by name, and all specimens on one sheet."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.arrays import Bools, Floats
from geodesics.errors import MissingExtra
from geodesics.extras import how_to_install
from geodesics.io import atomic_write
from gmds.pictures.balls import with_balls
from gmds.pictures.camera import Direction, broadside
from gmds.pictures.software import render
from gmds.specimens.carried import Landmarked, Specimen

BODY, GOOD, DOUBTFUL = (0.82, 0.80, 0.76), (0.10, 0.35, 0.75), (0.85, 0.10, 0.10)  # sRGB; set by hand
PIXELS = 560  # of the longer side of a view; set by hand
COLUMNS = 3  # of the sheet; set by hand
FILLED = 0.94  # of a view, by the surface, as `render` draws it
AZIMUTHS = (30.0, 210.0)  # degrees about the upward axis: the two sides of an animal
LETTER, AWAY = 7, 6  # pixels of a view: of a letter at most, and from a landmark to its name, which stands outside
CLOSE = 0.02  # of the size of the specimen by which a landmark may lie behind what covers it, and is seen all the same


def write_pictures(folder: Path, found: Landmarked, up: Direction) -> None:
    """A picture of every specimen in `folder`/pictures, and `folder`/sheet.png with all of them."""
    figure_class()
    (folder / "pictures").mkdir(exist_ok=True)
    views = []
    for one in found.specimens:
        drawn = _views(one, up)
        _save(folder / "pictures" / f"{one.name}.png", [(one, drawn)], found.names)
        views.append((one, drawn))
    _save(folder / "sheet.png", views, found.names, columns=COLUMNS)


def figure_class() -> Any:
    """matplotlib's figure; raises `MissingExtra` (E602)."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtra(f"pictures need matplotlib; install it with: {how_to_install('viz')}") from error
    return Figure


View = tuple[Any, Floats, Bools]  # an image, where landmarks are on it (k, 2) in pixels, which of them are seen


def _views(one: Specimen, up: Direction) -> list[View]:
    """Both sides of a specimen."""
    there = np.flatnonzero(one.valid)
    inks = np.where(one.doubtful[there, None], DOUBTFUL, GOOD)
    body = np.tile(BODY, (one.mesh.n_vertices, 1))
    shape, colours = with_balls(one.mesh, body, one.positions[there], inks)
    found = []
    for azimuth in AZIMUTHS:
        view = broadside(one.mesh, up, azimuth=azimuth)
        image = render(shape, colours, rotation=view, pixels=PIXELS)
        rows, columns = image.shape[:2]
        camera = shape.vertices @ view.T
        low, high = camera[:, :2].min(axis=0), camera[:, :2].max(axis=0)
        scale = FILLED * PIXELS / (high - low).max()
        marks = one.configuration @ view.T
        spots = (marks[:, :2] - (low + high) / 2) * scale * [1, -1] + [columns / 2, rows / 2]
        found.append((image, spots, _seen(one.mesh.vertices @ view.T, one.mesh.faces, marks)))
    return found


def _seen(camera: Floats, faces: Any, marks: Floats) -> Bools:
    """Which places (k, 3) no face covers, in coordinates whose third axis points at the viewer."""
    corners = camera[faces]
    low, high = corners[..., :2].min(axis=1), corners[..., :2].max(axis=1)
    margin = CLOSE * np.ptp(camera, axis=0).max()
    seen: Bools = np.asarray(np.isfinite(marks).all(axis=1), dtype=np.bool_)
    for i in np.flatnonzero(seen):
        over = corners[((low <= marks[i, :2]) & (marks[i, :2] <= high)).all(axis=1)]
        a, b, c = over[:, 0], over[:, 1] - over[:, 0], over[:, 2] - over[:, 0]
        area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
        proper = area != 0
        a, b, c, area = a[proper], b[proper], c[proper], area[proper]
        d = marks[i] - a
        v = (d[:, 0] * c[:, 1] - d[:, 1] * c[:, 0]) / area
        w = (b[:, 0] * d[:, 1] - b[:, 1] * d[:, 0]) / area
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        height = a[:, 2] + v * b[:, 2] + w * c[:, 2]
        seen[i] = not (height[inside] > marks[i, 2] + margin).any()
    return seen


def leftwards(x: float, name: str, wide: float) -> bool:
    """Whether a name stands left of its landmark, at x of a view so wide: on the outer side, if there is room."""
    long = len(name) * LETTER + AWAY
    return long < x < wide / 2 or (x + long > wide and long < x)


def _save(path: Path, specimens: Sequence[tuple[Specimen, list[View]]], names: Sequence[str], columns: int = 1) -> None:
    """Specimens with both views each, so many in a row, with their names."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    width = max(sum(image.shape[1] for image, _, _ in views) for _, views in specimens)
    height = max(image.shape[0] for _, views in specimens for image, _, _ in views) + 30
    across = min(columns, len(specimens))
    down = -(-len(specimens) // across)
    share = 1.0 if across == 1 else 0.5  # a sheet is looked at as a whole
    figure = figure_class()(figsize=(share * across * width / 100, share * down * height / 100), dpi=100)
    FigureCanvasAgg(figure)
    for number, (one, views) in enumerate(specimens):
        left, top = (number % across) / across, 1 - (number // across) / down
        for image, spots, seen in views:
            rows, wide = image.shape[:2]
            box = (left, top - (30 + rows) / height / down, wide / width / across, rows / height / down)
            axis = figure.add_axes(box)
            axis.imshow(image)
            axis.set_axis_off()
            for i in np.flatnonzero(seen).tolist():
                ink = DOUBTFUL if one.doubtful[i] else "black"
                size, away = 8 * max(share, 0.6), -AWAY if leftwards(spots[i][0], names[i], wide) else AWAY
                x, y = spots[i] + [away, -AWAY]
                side = "left" if away > 0 else "right"
                axis.text(x, y, names[i], fontsize=size, color=ink, parse_math=False, ha=side)
            left += wide / width / across
        middle = (number % across + 0.5) / across
        figure.text(middle, top - 4 / height / down, one.name, ha="center", va="top", parse_math=False)
    with atomic_write(path) as stream:
        figure.savefig(stream, format="png", metadata={"Software": None})
