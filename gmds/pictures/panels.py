"""Pictures without a screen: a map, or values on a surface, as PNG, JPEG, SVG or PDF."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arrays import Floats
from geodesics.errors import MissingExtra
from geodesics.io import atomic_write
from gmds.errors import PictureFormat, RenderingError
from gmds.maps.point_map import PointMap
from gmds.pictures.camera import Direction, alignment, broadside
from gmds.pictures.colours import (
    MISSING,
    label_colours,
    nearest_known,
    per_vertex,
    position_colours,
    shown_range,
    value_colours,
)
from gmds.pictures.offscreen import offscreen
from gmds.pictures.software import Shot, software

Limits = tuple[float, float]
Renderer = Callable[[Sequence[Shot]], list[Floats]]

# what is left out makes the same picture the same file
FORMATS: dict[str, dict[str, Any]] = {
    ".png": {"metadata": {"Software": None}},
    ".jpg": {"pil_kwargs": {"quality": 92}},
    ".jpeg": {"pil_kwargs": {"quality": 92}},
    ".svg": {"metadata": {"Date": None}},
    ".pdf": {"metadata": {"CreationDate": None}},
}
DOTS = 100  # per inch


class Panel(NamedTuple):
    """One part of a picture: its caption, what is drawn, and the range of its colour bar if it has one."""

    caption: str
    shot: Shot
    limits: Limits | None = None


def write_picture(
    path: str | os.PathLike[str],
    answer: PointMap,
    errors: ArrayLike | None = None,
    *,
    title: str = "",
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
    pixels: int = 520,
    renderer: Renderer | None = None,
) -> str:
    """Source and target in which corresponding points have the same colour; the ending of the path names the format.

    With `errors` (n,) per source vertex a third view shows them on the source (where one is not finite, that of the
    nearest vertex), else the map's distortion if it has any. Vertices that are not valid are grey. `up` is up in the
    source's coordinates; the target is turned to be seen from the same side; `pixels` is the longer side of a view.
    Drawn by `renderer`: `gmds.pictures.offscreen.offscreen` (pyvista) or `gmds.pictures.software.software`; unless it
    is given, by the first of them that can. Returns why it was not the first one, or nothing.

    Raises `MissingExtra` without the extra `viz`, `PictureFormat` (E218) for another ending, `RenderingError` (E510)
    when a renderer that was given cannot draw, `OSError` when the file cannot be written.
    """
    panels = map_panels(answer, errors, names=names, up=up, pixels=pixels)
    return _write(path, panels, title, renderer)


def map_panels(
    answer: PointMap,
    errors: ArrayLike | None = None,
    *,
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
    pixels: int = 520,
) -> list[Panel]:
    """The two or three views of `write_picture`."""
    view = broadside(answer.source, up)
    colours = position_colours(answer.target.vertices)
    pulled = answer.points.interpolate(colours)
    pulled[~answer.valid] = MISSING
    panels = [
        Panel(names[0], Shot(answer.source, pulled, view, pixels)),
        Panel(names[1], Shot(answer.target, colours, view @ alignment(answer), pixels)),
    ]
    values = answer.distortion if errors is None else nearest_known(answer.source, errors)
    if errors is not None or values.any():
        limits = shown_range(values)
        shown = value_colours(np.where(answer.valid, values, np.nan), *limits)
        caption = "distortion" if errors is None else "error"
        panels.append(Panel(caption, Shot(answer.source, shown, view, pixels), limits))
    return panels


def write_values(
    path: str | os.PathLike[str],
    surfaces: Sequence[tuple[str, Mesh, ArrayLike]],
    *,
    labels: bool = False,
    title: str = "",
    up: Direction = (0, 0, 1),
    pixels: int = 520,
    renderer: Renderer | None = None,
) -> str:
    """A picture of surfaces side by side, each given as (caption, mesh, values per vertex (n,)).

    Values share one colour range; with `labels` they are whole numbers with a colour each (negative: grey).
    `renderer`, what is returned, and errors are those of `write_picture`.
    """
    everything = np.concatenate([per_vertex(values, mesh.n_vertices) for _, mesh, values in surfaces])
    finite = everything[np.isfinite(everything)]
    limits = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    panels: list[Panel] = []
    for caption, mesh, values in surfaces:
        colours = label_colours(values) if labels else value_colours(values, *limits)
        shot = Shot(mesh, colours, broadside(mesh, up), pixels, sharp=labels)
        panels.append(Panel(caption, shot, None if labels else limits))
    return _write(path, panels, title, renderer)


def composed(panels: Sequence[Panel], images: Sequence[Floats], title: str = "") -> Any:
    """A matplotlib figure of the panels side by side, as they were drawn. Raises `MissingExtra` without `viz`."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtra("a picture needs matplotlib; install it with: pip install 'gmds[viz]'") from error

    boxes = [image.shape[1] + (70 if panel.limits else 0) for panel, image in zip(panels, images, strict=True)]
    width, tallest, head = sum(boxes), max(image.shape[0] for image in images), 60 if title else 34
    height = tallest + head
    figure = Figure(figsize=(width / DOTS, height / DOTS), dpi=DOTS)
    FigureCanvasAgg(figure)
    left = 0
    for panel, image, box in zip(panels, images, boxes, strict=True):
        rows, columns = image.shape[:2]
        bottom = (tallest - rows) // 2
        axis = figure.add_axes((left / width, bottom / height, columns / width, rows / height))
        axis.imshow(image, interpolation="none", aspect="auto")
        axis.set_axis_off()
        where = ((left + columns / 2) / width, (tallest + 8) / height)
        figure.text(*where, panel.caption, ha="center", va="bottom", parse_math=False)
        if panel.limits is not None:
            bar = figure.add_axes(((left + columns) / width, 0.2, 14 / width, 0.5))
            _colour_bar(figure, bar, panel.limits)
        left += box
    figure.text(0.5, 1 - 6 / height, title, ha="center", va="top", size="large", parse_math=False)
    return figure


def encoded(figure: Any, ending: str) -> bytes:
    """A figure as a file with one of the endings in `FORMATS`, the same bytes every time."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "gmds"}):
        figure.savefig(stream, format=ending[1:], **FORMATS[ending])
    return stream.getvalue()


def _write(path: str | os.PathLike[str], panels: Sequence[Panel], title: str, renderer: Renderer | None) -> str:
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise PictureFormat(f"{path}: a picture ends in {', '.join(FORMATS)}, not {ending or 'nothing'}")
    images, why = _drawn([panel.shot for panel in panels], renderer)
    picture = encoded(composed(panels, images, title), ending)
    with atomic_write(path) as stream:
        stream.write(picture)
    return why


def _drawn(shots: Sequence[Shot], renderer: Renderer | None) -> tuple[list[Floats], str]:
    """The shots by the renderer, or by the first that can; and why it was not the first of all."""
    if renderer is not None:
        return renderer(shots), ""
    try:
        return offscreen(shots), ""
    except RenderingError as error:
        return software(shots), f"drawn by gmds itself: {error}"


def _colour_bar(figure: Any, axis: Any, limits: Limits) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    ramp = ListedColormap(value_colours(np.linspace(0, 1, 256), 0, 1))
    figure.colorbar(ScalarMappable(Normalize(*limits), ramp), cax=axis).ax.tick_params(labelsize=8)
