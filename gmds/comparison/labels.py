"""Words beside points of a chart, moved so that they cover neither each other nor the points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from geodesics.arrays import Floats

# points (1/72 inch) from a point of the chart to its word, tried from near to far; set by hand
DISTANCES = (5, 9, 14, 20, 28, 38, 50)
AROUND = 12  # directions that are tried at each distance; set by hand
DOT = 4.0  # pixels from the middle of a point of the chart that no word should cover; set by hand


def place_labels(figure: Any, axis: Any, labels: Sequence[Any], places: Floats) -> None:
    """Give each annotation of a finished matplotlib figure the nearest place where it covers nothing.

    `places` (k, 2) are the points of the chart, in its coordinates. Where all places are taken, the one that covers
    least is. The layout stays as it is.
    """
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    dots = axis.transData.transform(places)
    taken = np.hstack([dots - DOT, dots + DOT])
    inside = np.array(axis.get_window_extent().extents)
    scale = figure.dpi / 72
    angle = np.pi / 4 + 2 * np.pi * np.arange(AROUND) / AROUND
    ways = np.concatenate([d * np.column_stack([np.cos(angle), np.sin(angle)]) for d in DISTANCES])
    for label in labels:
        box = label.get_window_extent()
        size = np.array([box.width, box.height])
        anchor = axis.transData.transform(label.xy)
        corner = anchor + scale * ways - size * (1 - np.sign(np.round(ways, 6))) / 2
        boxes = np.hstack([corner, corner + size])
        outside = np.maximum(inside[:2] - boxes[:, :2], 0).sum(axis=1) + np.maximum(boxes[:, 2:] - inside[2:], 0).sum(
            axis=1
        )
        best = int((_covered(boxes, taken) + 10 * outside + 1e-3 * np.linalg.norm(ways, axis=1)).argmin())
        label.set_position((corner[best] - anchor) / scale)
        taken = np.vstack([taken, boxes[best]])


def _covered(boxes: Floats, taken: Floats) -> Floats:
    """The area of each box (b, 4) that lies on others (t, 4)."""
    low = np.maximum(boxes[:, None, :2], taken[:, :2])
    high = np.minimum(boxes[:, None, 2:], taken[:, 2:])
    return np.asarray((high - low).clip(0).prod(axis=2).sum(axis=1))
