"""A page to look at a map in a browser: one file, no network, both surfaces to be turned."""

from __future__ import annotations

import html
import os
from collections.abc import Sequence
from importlib.resources import files
from string import Template
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from geodesics.io import atomic_write
from gmds.maps.made_with import NamedPair
from gmds.maps.point_map import PointMap
from gmds.pictures.camera import Direction, alignment, broadside
from gmds.pictures.colours import MISSING, css, diverging_colours, value_colours
from gmds.report import tables
from gmds.report.content import content
from gmds.report.drawing import Drawing, drawing
from gmds.report.modes import MATCHED_COLOUR, UNMATCHED_COLOUR
from gmds.report.packing import fingerprint_of, packed_data

SCRIPTS = (
    "unpack.js",
    "camera.js",
    "draw.js",
    "scene.js",
    "charts.js",
    "marks.js",
    "telling.js",
    "page.js",
    "finding.js",
    "out.js",
    "controls.js",
)


def write_report(
    path: str | os.PathLike[str],
    answer: PointMap,
    errors: ArrayLike | None = None,
    *,
    title: str = "Correspondence",
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
    landmarks: Sequence[NamedPair] | None = None,
) -> None:
    """One self-contained HTML page on a map: both surfaces in 3-D, corresponding points in the same colour.

    Pointing at one surface lights up the partner on the other. The page also shows the distortion, what has no
    counterpart, and every candidate of the map. A surface with more than 12,000 vertices is drawn as a copy with some
    8,000; what is told of a vertex holds for the whole surface. No script but the page's own may run.

    Parameters
    ----------
    path : path
        The page; the old one or the new one, never half of one.
    answer : Correspondence
        The map, of n source vertices.
    errors : array of shape (n,) or (k, n), optional
        Geodesic errors over the root of the target's area, NaN where the truth is not known; with k rows, of the map
        and of its first k - 1 candidates.
    title : str
        Shown as it is, never read as markup.
    names : two str
        Of source and target, likewise.
    up : three floats
        What is up in the source's coordinates. The target is turned to be seen from the same side.
    landmarks : sequence of (str, position or None, position or None), optional
        Names, and places (3,) on source and target, to be shown. Without them those that the map was made with.

    Raises
    ------
    ValueError
        For errors of another shape.
    OSError
        When the file cannot be written.

    See Also
    --------
    gmds.pictures.write_picture : A picture of the same.
    """
    page = page_text(answer, _checked(errors, answer), drawings(answer, up), title, names, landmarks=landmarks)
    with atomic_write(path) as stream:
        stream.write(page.encode("utf-8", "replace"))


class Work(NamedTuple):
    """What a page to work in has that one to look at has not: scripts, style, controls, data, and whom it may ask.

    `colours` are ways of colouring that maps which are made there have, and the first perhaps has not.
    """

    scripts: str = ""
    style: str = ""
    controls: str = ""
    data: Any = None
    policy: str = ""
    colours: Sequence[str] = ()


def drawings(answer: PointMap, up: Direction) -> tuple[Drawing, Drawing]:
    """Both surfaces as they are drawn, the target seen from the same side as the source."""
    view = broadside(answer.source, up, azimuth=0, elevation=0)
    return drawing(answer.source, view), drawing(answer.target, view @ alignment(answer))


def page_text(
    answer: PointMap,
    errors: Floats | None,
    drawn: tuple[Drawing, Drawing],
    title: str,
    names: tuple[str, str],
    *,
    landmarks: Sequence[NamedPair] | None = None,
    work: Work | None = None,
) -> str:
    """The whole page; `errors` (k, n) of the map and of its first candidates."""
    work = work or Work()
    data = {**content(answer, errors, drawn, names, landmarks, work.colours), "work": work.data}
    script = "".join(map(_part, SCRIPTS)).replace("\nstart().catch", f"\n{work.scripts}\nstart().catch")
    ramp = ", ".join(css(value_colours(np.linspace(0, 1, 10), 0, 1)))
    signed = ", ".join(css(diverging_colours(np.linspace(-1, 1, 11), 1)))
    legend = np.array([MATCHED_COLOUR, UNMATCHED_COLOUR])
    best = data["maps"][0]["told"]
    return Template(_part("report.html")).substitute(
        hashes=fingerprint_of(script),
        policy=work.policy,
        style=Template(_part("report.css")).substitute(ramp=ramp, signed=signed, missing=css(np.array([MISSING]))[0])
        + work.style,
        title=html.escape(title),
        badge=best["badge"],
        verdict=best["verdict"],
        status=html.escape(best["status"]),
        about_status=tables.about("status"),
        cards=tables.cards(best["cards"]),
        modes=tables.choices([(mode["key"], mode["label"]) for mode in data["modes"]]),
        swatches=tables.swatches(zip(css(legend), ("has a counterpart", "has none"), strict=True)),
        work=work.controls,
        source=html.escape(names[0]),
        target=html.escape(names[1]),
        source_size=_size(answer.source, drawn[0]),
        target_size=_size(answer.target, drawn[1]),
        advice=tables.advice(best["next"]),
        words=tables.words(),
        facts=tables.table_rows(best["facts"]),
        made=tables.made(answer),
        data=packed_data(data),
        script=script,
    )


def _checked(errors: ArrayLike | None, answer: PointMap) -> Floats | None:
    """Errors as (k, n), k at most the number of maps."""
    if errors is None:
        return None
    rows = np.atleast_2d(np.asarray(errors, dtype=np.float64))
    n, most = answer.source.n_vertices, 1 + len(answer.candidates)
    if rows.ndim != 2 or rows.shape[1] != n or not 1 <= len(rows) <= most:
        raise BadArgument(
            f"there must be one error for each of the {n} vertices, in at most {most} rows, not an array of shape "
            f"{np.shape(errors)}"
        )
    return rows


def _size(mesh: Mesh, drawn: Drawing) -> str:
    """How many vertices a surface has, and how many of them are drawn."""
    whole = f"{mesh.n_vertices:,} vertices"
    return whole if len(drawn.origin) == mesh.n_vertices else f"{whole}, drawn with {len(drawn.origin):,}"


def _part(name: str) -> str:
    return (files("gmds.report") / name).read_text("utf-8")
