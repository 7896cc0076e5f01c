"""A collection of shapes in one figure: tree, matrix in the order of its leaves, and map in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.cluster.hierarchy as hierarchy

from geodesics.arrays import Floats
from geodesics.errors import MissingExtra
from geodesics.extras import how_to_install
from gmds.comparison.clustering import families, leaf_order, plane_map, tree
from gmds.comparison.labels import place_labels
from gmds.pictures.colours import label_colours

# all three set by hand, so that words do not cover each other
MOST_LABELS = 60  # with more shapes, the map names each family once
PICTURE_POINTS = 68  # points (1/72 inch) across a picture of a shape
MOST_NUMBERED = 12  # with more shapes, the matrix is colours alone


def comparison_figure(names: Sequence[str], matrix: Floats, pictures: Sequence[Floats] | None = None) -> Any:
    """A matplotlib figure of the `tree`, the matrix (k, k) and the `plane_map` of the shapes with these names.

    Shapes of one family (names that differ in their number only) have one colour. `pictures`, images of the shapes,
    stand at the leaves of the tree. Raises `MissingExtra` without the extra `viz`.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtra(f"a picture needs matplotlib; install it with: {how_to_install('viz')}") from error

    family = families(names)
    number = np.unique(family, return_inverse=True)[1]
    colours = label_colours(number)
    linkage = tree(matrix)
    order = leaf_order(linkage)
    height = float(np.clip(1.5 + 0.13 * len(names), 5, 24)) if pictures is None else max(5.0, 0.8 * len(names))
    family, names = ([name.replace("$", r"\$") for name in those] for those in (family, names))  # no formulas
    figure = Figure(figsize=(8 + 1.2 * height, height), dpi=110, layout="constrained")
    FigureCanvasAgg(figure)
    left, middle, right = figure.subplots(1, 3, width_ratios=(3.4, height, 1.05 * height))
    size = float(np.clip(62 * (height - 1) / len(names), 3, 9))
    title = 10 + 0.3 * (height - 5)
    _draw_tree(left, linkage, [names[i] for i in order], colours[order], size)
    if pictures is not None:
        _draw_pictures(left, [pictures[i] for i in order])
    shown = middle.imshow(matrix[np.ix_(order, order)], cmap="cividis", aspect="auto", interpolation="nearest")
    middle.set_xticks([])
    middle.set_yticks([])
    if len(names) <= MOST_NUMBERED:
        _write_values(middle, matrix[np.ix_(order, order)])
        middle.set_xticks(np.arange(len(names)), [names[i] for i in order], fontsize=size, rotation=45, ha="right")
        middle.tick_params(axis="x", length=0)
        for label, colour in zip(middle.get_xticklabels(), colours[order], strict=True):
            label.set_color(0.65 * colour)
    figure.colorbar(shown, ax=middle, fraction=0.04, pad=0.02, label="share by which distances differ")
    labels = _draw_map(right, names, family, plane_map(matrix), colours, title)
    for axis, text in ((left, "tree"), (middle, "dissimilarity"), (right, "map (classical multidimensional scaling)")):
        axis.set_title(text, fontsize=title)
    place_labels(figure, right, labels, plane_map(matrix))
    return figure


def _draw_tree(axis: Any, linkage: Floats, names: Sequence[str], colours: Floats, size: float) -> None:
    """The tree with its leaves from top to bottom, named in their colours, beside the rows of the matrix."""
    if len(linkage):
        drawn = hierarchy.dendrogram(linkage, no_plot=True)
        for across, along in zip(drawn["dcoord"], drawn["icoord"], strict=True):
            axis.plot(across, along, color="0.35", linewidth=0.8)
    axis.set_ylim(10 * len(names), 0)
    axis.set_xlim(1.02 * linkage[:, 2].max() if len(linkage) else 1, 0)
    axis.yaxis.tick_right()
    axis.set_yticks(10 * np.arange(len(names)) + 5, names, fontsize=size)
    for label, colour in zip(axis.get_yticklabels(), colours, strict=True):
        label.set_color(0.65 * colour)
    axis.tick_params(axis="y", length=0)
    axis.spines[["left", "top", "right"]].set_visible(False)
    axis.locator_params(axis="x", nbins=4)


def _draw_pictures(axis: Any, pictures: Sequence[Floats]) -> None:
    """A picture at every leaf of the tree, between it and its name."""
    from matplotlib.offsetbox import AnnotationBbox, OffsetImage

    shift = (0.5 * PICTURE_POINTS + 4, 0)
    for i, picture in enumerate(pictures):
        image = OffsetImage(picture, zoom=PICTURE_POINTS / max(picture.shape[:2]))
        place = (0, 10 * i + 5)
        box = AnnotationBbox(image, place, shift, boxcoords="offset points", frameon=False, annotation_clip=False)
        axis.add_artist(box)
    axis.tick_params(axis="y", pad=PICTURE_POINTS + 8)


def _write_values(axis: Any, matrix: Floats) -> None:
    """Every dissimilarity as a number in its cell, in black or white, whichever is read more easily."""
    for (i, j), value in np.ndenumerate(matrix):
        if i != j:
            ink = "black" if value > 0.55 * matrix.max() else "white"
            axis.text(j, i, f"{value:.3f}", ha="center", va="center", fontsize=8, color=ink)


def _draw_map(
    axis: Any,
    names: Sequence[str],
    family: Sequence[str],
    places: Floats,
    colours: Floats,
    size: float,
) -> list[Any]:
    """The map, with the names of all shapes; of many, those of the families, of this size, where they are clear."""
    written = []
    axis.scatter(*places.T, c=colours, s=26, edgecolors="white", linewidths=0.5)
    if len(names) <= MOST_LABELS:
        for name, place, colour in zip(names, places, colours, strict=True):
            written.append(_write(axis, name, place, 0.65 * colour, 8))
    else:
        label = np.asarray(family)
        for name in sorted(set(family)):
            ours, others = places[label == name], places[label != name]
            clear = np.linalg.norm(ours[:, None] - others, axis=2).min(axis=1, initial=np.inf).argmax()
            written.append(_write(axis, name, ours[clear], 0.6 * colours[label == name][0], size))
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_box_aspect(1)
    axis.margins(0.2 if len(names) <= MOST_LABELS else 0.1)
    axis.locator_params(nbins=6)
    return written


def _write(axis: Any, text: str, place: Floats, colour: Floats, size: float) -> Any:
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=2, foreground="white")]
    shift = {"xytext": (4, 4), "textcoords": "offset points"}
    leader = {"arrowstyle": "-", "color": colour, "linewidth": 0.6, "shrinkA": 0, "shrinkB": 3}
    return axis.annotate(text, place, color=colour, fontsize=size, path_effects=halo, arrowprops=leader, **shift)
