"""Pictures without a screen: a map, or values on a surface, as PNG, JPEG, SVG or PDF."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arrays import Floats
from geodesics.io import atomic_write
from gmds.errors import PictureFormat, RenderingError
from gmds.maps.overlap import covered_of
from gmds.maps.point_map import PointMap
from gmds.pictures.balls import with_balls
from gmds.pictures.camera import Direction, alignment, broadside
from gmds.pictures.colours import (
    MISSING,
    label_colours,
    per_vertex,
    position_colours,
    value_colours,
)
from gmds.pictures.figure import FORMATS, Panel, composed, encoded
from gmds.pictures.judgement import judgement
from gmds.pictures.offscreen import offscreen
from gmds.pictures.software import Shot, software

Renderer = Callable[[Sequence[Shot]], list[Floats]]

INK = (0.85, 0.10, 0.10)  # sRGB, red: of vertices that are marked; no colour of values is like it


def write_picture(  # noqa: PLR0913 - as much as there is to choose
    path: str | os.PathLike[str],
    answer: PointMap,
    errors: ArrayLike | None = None,
    *,
    title: str = "",
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
    pixels: int = 520,
    renderer: Renderer | None = None,
    show: str = "doubt",
) -> str:
    """A picture of source and target in which corresponding points have the same colour.

    Grey is what has no counterpart: vertices of the source that are not valid, of the target that are not covered.

    Parameters
    ----------
    path : path
        Its ending names the format: .png, .jpg, .svg or .pdf.
    answer : Correspondence
        The map, of n source vertices.
    errors : array of shape (n,), optional
        Shown on the source in a third view; where one is not finite, that of the nearest vertex. Without them it shows
        doubt, 1 less the confidence of the map, or its distortion where nobody rated it.
    title, names : str, two str
        Above it all, and of source and target.
    up : three floats
        What is up in the source's coordinates. The target is turned to be seen from the same side.
    pixels : int
        The longer side of a view.
    renderer : function, optional
        `gmds.pictures.offscreen.offscreen` (pyvista) or `gmds.pictures.software.software`; without one the first of
        them that can draw.
    show : {"doubt", "growth"}
        What the third view shows without errors; growth is beside that of the whole (`gmds.maps.growth`).

    Returns
    -------
    str
        Why it was not the first of them, or nothing.

    Raises
    ------
    MissingExtra
        E602, without the extra `viz`.
    PictureFormat
        E218, for another ending.
    RenderingError
        E510, when a renderer that was given cannot draw.
    OSError
        When the file cannot be written.

    See Also
    --------
    write_values : Values on surfaces.
    gmds.report.write_report : A page in which surfaces can be turned.
    """
    panels = map_panels(answer, errors, names=names, up=up, pixels=pixels, show=show)
    return _write(path, panels, title, renderer)


def map_panels(
    answer: PointMap,
    errors: ArrayLike | None = None,
    *,
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
    pixels: int = 520,
    show: str = "doubt",
) -> list[Panel]:
    """The two or three views of `write_picture`."""
    view = broadside(answer.source, up)
    colours = position_colours(answer.target.vertices)
    pulled = answer.points.interpolate(colours)
    pulled[~answer.valid] = MISSING
    colours[~covered_of(answer)] = MISSING
    panels = [
        Panel(names[0], Shot(answer.source, pulled, view, pixels)),
        Panel(names[1], Shot(answer.target, colours, view @ alignment(answer), pixels)),
    ]
    caption, values, limits = judgement(answer, errors, show)
    if errors is not None or values.any():
        shown = value_colours(np.where(answer.valid, values, np.nan), *limits)
        panels.append(Panel(caption, Shot(answer.source, shown, view, pixels), limits))
    return panels


def write_values(
    path: str | os.PathLike[str],
    surfaces: Sequence[tuple[str, Mesh, ArrayLike]],
    *,
    labels: bool = False,
    marked: Sequence[ArrayLike] | None = None,
    title: str = "",
    up: Direction = (0, 0, 1),
    pixels: int = 520,
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
        Values are whole numbers with a colour each, negative ones grey.
    marked : sequence of array_like of int, optional
        Vertices of each surface that get a little ball: sources of a distance, samples.

    Returns
    -------
    str
        As in `write_picture`, and the same errors are raised.

    Raises
    ------
    ValueError
        When there is not one value for each vertex.
    """
    everything = np.concatenate([per_vertex(values, mesh.n_vertices) for _, mesh, values in surfaces])
    finite = everything[np.isfinite(everything)]
    limits = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    panels: list[Panel] = []
    for i, (caption, mesh, values) in enumerate(surfaces):
        colours = label_colours(values) if labels else value_colours(values, *limits)
        rows = np.asarray(marked[i] if marked is not None else (), dtype=np.int64)
        shape, colours = with_balls(mesh, colours, mesh.vertices[rows], np.array(INK)) if len(rows) else (mesh, colours)
        shot = Shot(shape, colours, broadside(mesh, up), pixels, sharp=labels)
        panels.append(Panel(caption, shot, None if labels else limits))
    return _write(path, panels, title, renderer)


def _write(path: str | os.PathLike[str], panels: Sequence[Panel], title: str, renderer: Renderer | None) -> str:
    if (ending := Path(path).suffix.lower()) not in FORMATS:
        raise PictureFormat(f"{path}: a picture ends in {', '.join(FORMATS)}, not {ending or 'nothing'}")
    images, why = _drawn([panel.shot for panel in panels], renderer)
    with atomic_write(path) as stream:
        stream.write(encoded(composed(panels, images, title), ending))
    return why


def _drawn(shots: Sequence[Shot], renderer: Renderer | None) -> tuple[list[Floats], str]:
    """The shots by the renderer, or by the first that can; and why it was not the first of all."""
    if renderer is not None:
        return renderer(shots), ""
    try:
        return offscreen(shots), ""
    except RenderingError as error:
        return software(shots), f"drawn by gmds itself: {error}"
