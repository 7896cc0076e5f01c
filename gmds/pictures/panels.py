"""The picture of a map without a screen, as PNG, JPEG, SVG or PDF."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike

from gmds.maps.made_with import landmarks_of
from gmds.maps.overlap import covered_of
from gmds.maps.point_map import PointMap
from gmds.pictures.balls import with_balls
from gmds.pictures.camera import Direction, alignment, broadside
from gmds.pictures.colours import BARE, MISSING, few_known
from gmds.pictures.figure import Panel
from gmds.pictures.judgement import judgement
from gmds.pictures.matching_colours import matching_colours
from gmds.pictures.named import marks_of
from gmds.pictures.scales import beyond
from gmds.pictures.software import Shot
from gmds.pictures.values import coloured
from gmds.pictures.writing import Renderer, write_panels

LANDMARK = (0.12, 0.12, 0.12)  # sRGB, nearly black, which no matching colour is; set by hand


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
    Landmarks that the map was made with are balls, with their names where they can be seen.

    Parameters
    ----------
    path : path
        Its ending names the format: .png, .jpg, .svg or .pdf.
    answer : Correspondence
        The map, of n source vertices.
    errors : array of shape (n,), optional
        Over the root of the target's area, shown on the source in a third view: where one is not finite, that of the
        nearest vertex, and as balls where few are known, at most half of them. Without errors it shows doubt, 1 less
        the confidence of the map, or its distortion where nobody rated it.
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
    return write_panels(path, panels, title, renderer)


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
    colours = matching_colours(answer.target).copy()
    pulled = answer.points.interpolate(colours)
    pulled[~answer.valid] = MISSING
    colours[~covered_of(answer)] = MISSING
    views = view, view @ alignment(answer)
    panels = [
        _with_landmarks(caption, side, answer, Shot(mesh, looks, way, pixels))
        for caption, side, mesh, looks, way in zip(
            names, (1, 2), (answer.source, answer.target), (pulled, colours), views, strict=True
        )
    ]
    caption, values, limits, label, signed = judgement(answer, errors, show)
    if errors is not None or values.any():
        values = np.where(answer.valid, values, np.nan)
        shape, shown = answer.source, coloured(values, limits, signed=signed)
        if errors is not None and len(known := few_known(np.asarray(errors, dtype=np.float64))):
            plain = np.tile(BARE, (shape.n_vertices, 1))
            shape, shown = with_balls(shape, plain, shape.vertices[known], shown[known])
        shot = Shot(shape, shown, view, pixels)
        panels.append(Panel(caption, shot, limits, label, signed, beyond=beyond(values, limits)))
    return panels


def _with_landmarks(caption: str, side: int, answer: PointMap, shot: Shot) -> Panel:
    """A view of the source (1) or the target (2), with the landmarks that the map was made with, by name."""
    given = [(one[0], np.asarray(one[side], dtype=np.float64)) for one in landmarks_of(answer)]
    if not given:
        return Panel(caption, shot)
    names, places = [name for name, _ in given], np.stack([place for _, place in given])
    shape, colours = with_balls(shot.mesh, shot.colours, places, np.array(LANDMARK))
    drawn = Shot(shape, colours, shot.rotation, shot.pixels)
    return Panel(caption, drawn, marks=marks_of(drawn, shot.mesh, names, places))
