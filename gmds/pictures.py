"""Pictures without a screen: a map, or values on a surface, as PNG."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics import Mesh
from geodesics.errors import MissingExtra
from geodesics.io import atomic_write
from gmds.colours import MISSING, label_colours, per_vertex, position_colours, shown_range, value_colours
from gmds.correspondence import Correspondence
from gmds.rendering import render
from gmds.views import Direction, alignment, broadside

Array = NDArray[np.float64]
Panel = tuple[str, Array, tuple[float, float] | None]  # caption, image, range of the colour bar


def write_picture(
    path: str | os.PathLike[str],
    answer: Correspondence,
    errors: ArrayLike | None = None,
    *,
    title: str = "",
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
    pixels: int = 520,
) -> None:
    """A PNG of source and target in which corresponding points have the same colour.

    With `errors` (n,) per source vertex a third view shows them on the source, else the map's distortion if it has
    any. Vertices that are not valid are grey. `up` is up in the source's coordinates; the target is turned to be
    seen from the same side. Raises `MissingExtra` without the extra `viz`, `OSError` when the file cannot be written.
    """
    view = broadside(answer.source, up)
    colours = position_colours(answer.target.vertices)
    pulled = answer.points.interpolate(colours)
    pulled[~answer.valid] = MISSING
    panels: list[Panel] = [
        (names[0], render(answer.source, pulled, rotation=view, pixels=pixels), None),
        (names[1], render(answer.target, colours, rotation=view @ alignment(answer), pixels=pixels), None),
    ]
    values = answer.distortion if errors is None else per_vertex(errors, answer.source.n_vertices)
    if errors is not None or values.any():
        limits = shown_range(values)
        shown = value_colours(np.where(answer.valid, values, np.nan), *limits)
        caption = "distortion" if errors is None else "error"
        panels.append((caption, render(answer.source, shown, rotation=view, pixels=pixels), limits))
    _write(path, panels, title)


def write_values(
    path: str | os.PathLike[str],
    surfaces: Sequence[tuple[str, Mesh, ArrayLike]],
    *,
    labels: bool = False,
    title: str = "",
    up: Direction = (0, 0, 1),
    pixels: int = 520,
) -> None:
    """A PNG of surfaces side by side, each given as (caption, mesh, values per vertex (n,)).

    Values share one colour range; with `labels` they are whole numbers with a colour each (negative: grey).
    Raises `MissingExtra` without the extra `viz`, `OSError` when the file cannot be written.
    """
    everything = np.concatenate([per_vertex(values, mesh.n_vertices) for _, mesh, values in surfaces])
    finite = everything[np.isfinite(everything)]
    limits = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    panels: list[Panel] = []
    for caption, mesh, values in surfaces:
        colours = label_colours(values) if labels else value_colours(values, *limits)
        image = render(mesh, colours, rotation=broadside(mesh, up), pixels=pixels, sharp=labels)
        panels.append((caption, image, None if labels else limits))
    _write(path, panels, title)


def _write(path: str | os.PathLike[str], panels: list[Panel], title: str) -> None:
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtra("a picture needs matplotlib; install it with: pip install 'gmds[viz]'") from error

    boxes = [image.shape[1] + (70 if limits else 0) for _, image, limits in panels]
    width, tallest, head = sum(boxes), max(image.shape[0] for _, image, _ in panels), 60 if title else 34
    height = tallest + head
    figure = Figure(figsize=(width / 100, height / 100), dpi=100)
    FigureCanvasAgg(figure)
    left = 0
    for (caption, image, limits), box in zip(panels, boxes, strict=True):
        rows, columns = image.shape[:2]
        bottom = (tallest - rows) // 2
        axis = figure.add_axes((left / width, bottom / height, columns / width, rows / height))
        axis.imshow(image, interpolation="none", aspect="auto")
        axis.set_axis_off()
        where = ((left + columns / 2) / width, (tallest + 8) / height)
        figure.text(*where, caption, ha="center", va="bottom", parse_math=False)
        if limits is not None:
            bar = figure.add_axes(((left + columns) / width, 0.2, 14 / width, 0.5))
            _colour_bar(figure, bar, limits)
        left += box
    figure.text(0.5, 1 - 6 / height, title, ha="center", va="top", size="large", parse_math=False)
    with atomic_write(path) as stream:
        figure.savefig(stream, format="png", metadata={"Software": None})


def _colour_bar(figure: Any, axis: Any, limits: tuple[float, float]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    ramp = ListedColormap(value_colours(np.linspace(0, 1, 256), 0, 1))
    figure.colorbar(ScalarMappable(Normalize(*limits), ramp), cax=axis).ax.tick_params(labelsize=8)
