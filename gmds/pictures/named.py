"""Names of points in a picture: which points can be seen, and where their names stand."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Bools, Floats, Integers
from gmds.pictures.software import OVERSAMPLING, Shot

CLOSE = 0.02  # of the size of a surface by which a point may lie behind what covers it, and is seen all the same
HALO = 2.5  # points of white about the letters of a name; set by hand
LETTER, AWAY = 7, 6  # pixels of a view: of a letter at most, and from a point to its name, which stands outside
HIGH = 11  # pixels of a view: of letters of 8 points


Box = tuple[float, float, float, float]  # left, upper, right and lower pixel of a name


class Mark(NamedTuple):
    """A name in a view, at the pixel (x, y) from its upper left corner, in a colour of matplotlib."""

    name: str
    x: float
    y: float
    ink: str | tuple[float, ...] = "black"


def marks_of(shot: Shot, mesh: Mesh, names: Sequence[str], places: Floats) -> list[Mark]:
    """The names of those places (k, 3) on a mesh that are seen in a shot, which may show more than the mesh."""
    xy = spots(shot, places)
    there = seen(mesh.vertices @ shot.rotation.T, mesh.faces, places @ shot.rotation.T)
    return [Mark(names[i], xy[i, 0], xy[i, 1]) for i in np.flatnonzero(there).tolist()]


def spots(shot: Shot, places: Floats) -> Floats:
    """Pixels (k, 2) of a shot, from its upper left corner, where places (k, 3) are."""
    return shot.frame(OVERSAMPLING, places).xy / OVERSAMPLING


def write_names(axis: Any, marks: Iterable[Mark], wide: float, size: float = 8, scale: float = 1.0) -> None:
    """Write names into a view that is so wide, in letters of `size` points that stand out from what is under them.

    `scale`: how much larger than usual letters are beside the view, as where the view is drawn smaller than they are.
    """
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=HALO, foreground="white")]
    taken: list[Box] = []
    for mark in marks:
        left, box = free_place(mark, wide, taken, scale)
        taken.append(box)
        at, side = (box[2], "right") if left else (box[0], "left")
        look = {"fontsize": size, "color": mark.ink, "parse_math": False, "path_effects": halo}
        axis.text(at, box[3], mark.name, ha=side, **look)


def free_place(mark: Mark, wide: float, taken: Sequence[Box], scale: float = 1.0) -> tuple[bool, Box]:
    """Whether a name stands left of its point, and where: above it, on the outer side, unless another name is there.

    Then it stands below, or on the other side, or as much higher or lower as it takes, up to four lines, and within the
    view where it can.
    """
    outer, long, high = leftwards(mark.x, mark.name, wide), len(mark.name) * LETTER * scale, HIGH * scale
    tried: list[tuple[bool, Box]] = []
    for line in range(4):
        for below, left in ((False, outer), (True, outer), (False, not outer), (True, not outer)):
            foot = mark.y + AWAY + (line + 1) * high if below else mark.y - AWAY - line * high
            start = mark.x - AWAY - long if left else mark.x + AWAY
            box = (start, foot - high, start + long, foot)
            if _within(box, wide) and not any(_meet(box, other) for other in taken):
                return left, box
            tried.append((left, box))
    return next((one for one in tried if _within(one[1], wide)), tried[0])


def _within(box: Box, wide: float) -> bool:
    return box[0] >= 0 and box[2] <= wide


def _meet(one: Box, other: Box) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def leftwards(x: float, name: str, wide: float) -> bool:
    """Whether a name stands left of its point, at x of a view so wide: on the outer side, if there is room."""
    long = len(name) * LETTER + AWAY
    return long < x < wide / 2 or (x + long > wide and long < x)


def seen(camera: Floats, faces: Integers, marks: Floats) -> Bools:
    """Which places (k, 3) no face covers, in coordinates whose third axis points at the viewer."""
    corners = camera[faces]
    low, high = corners[..., :2].min(axis=1), corners[..., :2].max(axis=1)
    margin = CLOSE * np.ptp(camera, axis=0).max()
    there: Bools = np.asarray(np.isfinite(marks).all(axis=1), dtype=np.bool_)
    for i in np.flatnonzero(there):
        over = corners[((low <= marks[i, :2]) & (marks[i, :2] <= high)).all(axis=1)]
        a, b, c = over[:, 0], over[:, 1] - over[:, 0], over[:, 2] - over[:, 0]
        area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
        proper = area != 0
        a, b, c, area = a[proper], b[proper], c[proper], area[proper]
        d = marks[i] - a
        v = (d[:, 0] * c[:, 1] - d[:, 1] * c[:, 0]) / area
        w = (b[:, 0] * d[:, 1] - b[:, 1] * d[:, 0]) / area
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        height = a[:, 2] + v * b[:, 2] + w * c[:, 2]
        there[i] = not (height[inside] > marks[i, 2] + margin).any()
    return there
