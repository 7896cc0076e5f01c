"""Views side by side as a figure, and the figure as a file."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import MissingExtra
from geodesics.extras import how_to_install
from gmds.pictures.colours import diverging_colours, value_colours
from gmds.pictures.named import Mark, write_names
from gmds.pictures.software import Shot

Limits = tuple[float, float]

# what is left out makes the same picture the same file
FORMATS: dict[str, dict[str, Any]] = {
    ".png": {"metadata": {"Software": None}},
    ".jpg": {"pil_kwargs": {"quality": 92}},
    ".jpeg": {"pil_kwargs": {"quality": 92}},
    ".svg": {"metadata": {"Date": None}},
    ".pdf": {"metadata": {"CreationDate": None}},
}
BAR = 88  # pixels for a colour bar, its numbers and its label; set by hand
DOTS = 100  # per inch: matplotlib measures in inches, and texts are as large beside the views as at that resolution


class Panel(NamedTuple):
    """One part of a picture: its caption, what is drawn, and the range of its colour bar if it has one.

    The bar has a label, which says the unit; `signed` ones go from below 0 to as far above it. `marks` are names in it.
    """

    caption: str
    shot: Shot
    limits: Limits | None = None
    label: str = ""
    signed: bool = False
    marks: Sequence[Mark] = ()


def composed(panels: Sequence[Panel], images: Sequence[Floats], title: str = "") -> Any:
    """A matplotlib figure of the panels side by side, as they were drawn. Raises `MissingExtra` without `viz`."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtra(f"a picture needs matplotlib; install it with: {how_to_install('viz')}") from error

    boxes = [image.shape[1] + (BAR if panel.limits else 0) for panel, image in zip(panels, images, strict=True)]
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
        write_names(axis, panel.marks, columns)
        where = ((left + columns / 2) / width, (tallest + 8) / height)
        figure.text(*where, panel.caption, ha="center", va="bottom", parse_math=False)
        if panel.limits is not None:
            bar = figure.add_axes(((left + columns) / width, 0.2, 14 / width, 0.5))
            _colour_bar(figure, bar, panel)
        left += box
    figure.text(0.5, 1 - 6 / height, title, ha="center", va="top", size="large", parse_math=False)
    return figure


@contextlib.contextmanager
def without_glyph_warnings() -> Iterator[None]:
    """While text is drawn: signs that the font lacks become boxes, which one sees; nobody need be told on stderr."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=r"Glyph .* missing from")
        yield


def encoded(figure: Any, ending: str) -> bytes:
    """A figure as a file with one of the endings in `FORMATS`, the same bytes every time."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "gmds"}), without_glyph_warnings():
        figure.savefig(stream, format=ending[1:], **FORMATS[ending])
    return stream.getvalue()


def _colour_bar(figure: Any, axis: Any, panel: Panel) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    steps = np.linspace(-1, 1, 256)
    ramp = ListedColormap(diverging_colours(steps, 1) if panel.signed else value_colours(steps, -1, 1))
    bar = figure.colorbar(ScalarMappable(Normalize(*(panel.limits or (0, 1))), ramp), cax=axis)
    bar.ax.tick_params(labelsize=8)
    bar.set_label(panel.label.replace("$", r"\$"), fontsize=8)
