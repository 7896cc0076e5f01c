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
HEAD, TITLE = 34, 26  # pixels for captions above a row of views, and for the title; set by hand
DOTS = 100  # per inch: matplotlib measures in inches, and texts are as large beside the views as at that resolution


class Panel(NamedTuple):
    """One part of a picture: its caption, what is drawn, and the range of its colour bar if it has one.

    The bar has a label, which says the unit; `signed` ones go from below 0 to as far above it. `marks` are names in it.
    `beyond` says whether values are less than the bar's lower end, and whether they are more than its upper one.
    """

    caption: str
    shot: Shot
    limits: Limits | None = None
    label: str = ""
    signed: bool = False
    marks: Sequence[Mark] = ()
    beyond: tuple[bool, bool] = (False, False)


def composed(panels: Sequence[Panel], images: Sequence[Floats], title: str = "", columns: int | None = None) -> Any:
    """A matplotlib figure of the panels side by side, so many in a row, as they were drawn.

    Neighbours with the same colour bar have one, beside the last of them. Raises `MissingExtra` without `viz`.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtra(f"a picture needs matplotlib; install it with: {how_to_install('viz')}") from error

    spots = list(zip(panels, images, strict=True))
    many = columns or len(spots)
    rows = [_Row(spots[i : i + many]) for i in range(0, len(spots), many)]
    width, height = max(row.width for row in rows), sum(row.height for row in rows) + (TITLE if title else 0)
    figure = Figure(figsize=(width / DOTS, height / DOTS), dpi=DOTS)
    FigureCanvasAgg(figure)
    top = height - (TITLE if title else 0)
    for row in rows:
        top -= row.height
        row.draw(figure, top, (width, height))
    figure.text(0.5, 1 - 6 / height, title, ha="center", va="top", size="large", parse_math=False)
    return figure


class _Row:
    """Panels in a row, with what they were drawn as; where two have the same bar, the first goes without."""

    def __init__(self, spots: Sequence[tuple[Panel, Floats]]) -> None:
        self.spots = spots
        bars = [(panel.limits, panel.label, panel.signed) for panel, _ in spots]
        self.has_bar = [bar[0] is not None and bar not in bars[i + 1 : i + 2] for i, bar in enumerate(bars)]
        self.tallest = max(image.shape[0] for _, image in spots)
        self.height = self.tallest + HEAD
        self.width = sum(image.shape[1] for _, image in spots) + BAR * sum(self.has_bar)

    def draw(self, figure: Any, under: int, size: tuple[int, int]) -> None:
        """Draw them `under` pixels above the lower end of a figure of that size."""
        (width, height), left = size, 0
        for (panel, image), with_bar in zip(self.spots, self.has_bar, strict=True):
            rows, columns = image.shape[:2]
            bottom = under + (self.tallest - rows) // 2
            axis = figure.add_axes((left / width, bottom / height, columns / width, rows / height))
            axis.imshow(image, interpolation="none", aspect="auto")
            axis.set_axis_off()
            write_names(axis, panel.marks, columns)
            where = ((left + columns / 2) / width, (under + self.tallest + 8) / height)
            figure.text(*where, panel.caption, ha="center", va="bottom", parse_math=False)
            left += columns
            if with_bar:
                place = (left / width, (under + 0.2 * self.height) / height, 14 / width, 0.5 * self.height / height)
                _colour_bar(figure, figure.add_axes(place), panel)
                left += BAR


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
    below, above = panel.beyond
    for words, y, side in (("and less" if below else "", -0.02, "top"), ("and more" if above else "", 1.02, "bottom")):
        bar.ax.text(0, y, words, transform=bar.ax.transAxes, va=side, fontsize=8)
