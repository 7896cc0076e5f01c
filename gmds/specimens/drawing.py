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
from gmds.pictures.named import Mark, seen, spots, write_names
from gmds.pictures.software import Shot, software
from gmds.specimens.carried import Landmarked, Specimen

BODY, GOOD, DOUBTFUL = (0.82, 0.80, 0.76), (0.10, 0.35, 0.75), (0.85, 0.10, 0.10)  # sRGB; set by hand
PIXELS = 560  # of the longer side of a view; set by hand
COLUMNS = 3  # of the sheet; set by hand
AZIMUTHS = (30.0, 210.0)  # degrees about the upward axis: the two sides of an animal


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
        shot = Shot(shape, colours, view, PIXELS)
        marked = seen(one.mesh.vertices @ view.T, one.mesh.faces, one.configuration @ view.T)
        found.append((software([shot])[0], spots(shot, one.configuration), marked))
    return found


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
        for image, places, there in views:
            rows, wide = image.shape[:2]
            box = (left, top - (30 + rows) / height / down, wide / width / across, rows / height / down)
            axis = figure.add_axes(box)
            axis.imshow(image)
            axis.set_axis_off()
            inks = [DOUBTFUL if doubtful else "black" for doubtful in one.doubtful]
            marks = [Mark(names[i], places[i, 0], places[i, 1], inks[i]) for i in np.flatnonzero(there).tolist()]
            letters = max(share, 0.6)  # or they could not be read
            write_names(axis, marks, wide, 8 * letters, letters / share)
            left += wide / width / across
        middle = (number % across + 0.5) / across
        figure.text(middle, top - 4 / height / down, one.name, ha="center", va="top", parse_math=False)
    with atomic_write(path) as stream:
        figure.savefig(stream, format="png", metadata={"Software": None})
