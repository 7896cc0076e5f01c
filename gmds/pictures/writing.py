"""Panels to a file, drawn by the first renderer that can."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

from geodesics.arrays import Floats
from geodesics.io import atomic_write
from gmds.errors import PictureFormat, RenderingError
from gmds.pictures.figure import FORMATS, Panel, composed, encoded
from gmds.pictures.offscreen import offscreen
from gmds.pictures.software import Shot, software

Renderer = Callable[[Sequence[Shot]], list[Floats]]


def write_panels(
    path: str | os.PathLike[str],
    panels: Sequence[Panel],
    title: str,
    renderer: Renderer | None,
    columns: int | None = None,
) -> str:
    """Write the picture, with so many panels a row; why it was not drawn by the first renderer, or nothing.

    Raises as `write_picture` does.
    """
    if (ending := Path(path).suffix.lower()) not in FORMATS:
        raise PictureFormat(f"{path}: a picture ends in {', '.join(FORMATS)}, not {ending or 'nothing'}")
    images, why = _drawn([panel.shot for panel in panels], renderer)
    with atomic_write(path) as stream:
        stream.write(encoded(composed(panels, images, title, columns), ending))
    return why


def _drawn(shots: Sequence[Shot], renderer: Renderer | None) -> tuple[list[Floats], str]:
    """The shots by the renderer, or by the first that can; and why it was not the first of all."""
    if renderer is not None:
        return renderer(shots), ""
    try:
        return offscreen(shots), ""
    except RenderingError as error:
        return software(shots), f"drawn by gmds itself: {error}"
