"""Pictures of values, labels or colours on surfaces."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.pictures import lines
from gmds.pictures.balls import with_balls
from gmds.pictures.camera import Direction, broadside
from gmds.pictures.colours import diverging_colours, label_colours, per_vertex, value_colours
from gmds.pictures.figure import Panel
from gmds.pictures.software import Shot
from gmds.pictures.textured import textured
from gmds.pictures.writing import Renderer, write_panels

INK = (0.85, 0.10, 0.10)  # sRGB, red: of vertices that are marked; no colour of values is like it
LINE = (0.12, 0.12, 0.12)  # sRGB, nearly black: of isolines and of borders between labels; set by hand


def write_values(  # noqa: PLR0913 - likewise
    path: str | os.PathLike[str],
    surfaces: Sequence[tuple[str, Mesh, ArrayLike]],
    *,
    labels: bool = False,
    marked: Sequence[ArrayLike] | None = None,
    label: str = "",
    signed: bool | Sequence[bool] = False,
    isolines: bool = False,
    title: str = "",
    up: Direction = (0, 0, 1),
    views: Sequence[Floats] | None = None,
    pixels: int = 520,
    columns: int | None = None,
    renderer: Renderer | None = None,
) -> str:
    """A picture of surfaces side by side, coloured by values on their vertices.

    Parameters
    ----------
    path, title, up, pixels, renderer
        As in `write_picture`.
    surfaces : sequence of (str, Mesh, array of shape (n,))
        Captions, and what is drawn, with a value for each vertex, all in one range of colours; grey is not finite.
    labels : bool
        Values are whole numbers with a colour each, negative ones grey, and a line where two of them meet.
    marked : sequence of array_like of int, optional
        Vertices of each surface that get a little ball: sources of a distance, samples.
    label : str
        What the values are, and in which unit, beside the bar.
    signed : bool, or one for each surface
        Below 0 is one colour, above it another, 0 is white and in the middle of the range. Surfaces that are and those
        that are not have a range each.
    isolines : bool
        Draws lines where values are round.
    views : sequence of arrays of shape (3, 3), optional
        Cameras, in place of what is up, as `gmds.pictures.camera.broadside` makes them.
    columns : int, optional
        How many surfaces stand in a row; all of them, unless given.

    Returns
    -------
    str
        As in `write_picture`, and the same errors are raised.

    Raises
    ------
    ValueError
        When there is not one value for each vertex.
    """
    given = [per_vertex(values, mesh.n_vertices) for _, mesh, values in surfaces]
    signs = [signed] * len(given) if isinstance(signed, bool) else list(signed)
    ranges = {sign: _limits([v for v, s in zip(given, signs, strict=True) if s == sign], sign) for sign in set(signs)}
    panels: list[Panel] = []
    for i, ((caption, mesh, _), v) in enumerate(zip(surfaces, given, strict=True)):
        limits = ranges[signs[i]]
        shape, colours = mesh, label_colours(v) if labels else coloured(v, limits, signed=signs[i])
        if labels:
            shape, colours = lines.with_lines(shape, colours, lines.borders(mesh, v), LINE)
        elif isolines:
            segments = lines.isolines(mesh, v, lines.round_levels(*limits))
            shape, colours = lines.with_lines(shape, colours, segments, LINE)
        rows = np.asarray(marked[i] if marked is not None else (), dtype=np.int64)
        if len(rows):
            shape, colours = with_balls(shape, colours, mesh.vertices[rows], np.array(INK))
        view = broadside(mesh, up) if views is None else views[i]
        shot = Shot(shape, colours, view, pixels, sharp=labels)
        panels.append(Panel(caption, shot, None if labels else limits, label, signs[i]))
    return write_panels(path, panels, title, renderer, columns)


def _limits(values: Sequence[Floats], signed: bool) -> tuple[float, float]:
    """From the least to the largest finite value; as far below 0 as above where they are signed."""
    everything = np.concatenate(values)
    finite = everything[np.isfinite(everything)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    reach = max(abs(low), abs(high))
    return (-reach, reach) if signed else (low, high)


def write_coloured(
    path: str | os.PathLike[str],
    surfaces: Sequence[tuple[str, Mesh, Any]],
    *,
    title: str = "",
    up: Direction = (0, 0, 1),
    views: Sequence[Floats] | None = None,
    pixels: int = 520,
    renderer: Renderer | None = None,
) -> str:
    """A picture of surfaces side by side, with the colours that are given.

    Parameters
    ----------
    path, title, up, views, pixels, renderer
        As in `write_values`.
    surfaces : sequence of (str, Mesh, array of shape (n, 3) or (uv, image))
        Captions, and what is drawn, with red, green and blue in [0, 1] for each vertex; or with texture coordinates
        (m, 3, 2) of the corners of its faces, and the image (PIL) that they lay on it.

    Returns
    -------
    str
        As in `write_picture`, and the same errors are raised.
    """
    panels = []
    for i, (caption, mesh, look) in enumerate(surfaces):
        view = broadside(mesh, up) if views is None else views[i]
        if isinstance(look, tuple):
            uv, image = look
            shot = textured(mesh, uv, image, view, pixels)
        else:
            shot = Shot(mesh, np.asarray(look, dtype=np.float64), view, pixels)
        panels.append(Panel(caption, shot))
    return write_panels(path, panels, title, renderer)


def coloured(values: Floats, limits: tuple[float, float], *, signed: bool) -> Floats:
    """Colours (n, 3) of values in a range; `signed` ones have a colour on either side of 0."""
    return diverging_colours(values, limits[1]) if signed else value_colours(values, *limits)
