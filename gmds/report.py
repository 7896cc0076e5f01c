"""A page to look at a map in a browser: one file, no network, both surfaces to be turned."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import os
from importlib.resources import files
from string import Template
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics import Mesh, SurfacePoints
from geodesics.errors import MissingExtra
from geodesics.io import atomic_write
from gmds.colours import MISSING, per_vertex, position_colours, shown_range, value_colours
from gmds.correspondence import Correspondence
from gmds.views import Direction, alignment, broadside

Array = NDArray[np.float64]

GREY = (0.82, 0.82, 0.82)
THRESHOLDS = (0.05, 0.10, 0.25)  # of the protocol: shares of points nearer to the truth than this


def write_report(
    path: str | os.PathLike[str],
    answer: Correspondence,
    errors: ArrayLike | None = None,
    *,
    title: str = "Correspondence",
    names: tuple[str, str] = ("source", "target"),
    up: Direction = (0, 0, 1),
) -> None:
    """One self-contained HTML page on a map: both surfaces in 3-D, corresponding points in the same colour.

    It also shows the distortion, the `errors` (n,) per source vertex if given (geodesic, over sqrt of the target's
    area), and every candidate of the map; a click on the source marks the point on the target. `up` is up in the
    source's coordinates; the target is turned to be seen from the same side. Titles and names are shown as they are,
    never read as markup; scripts other than the page's own are forbidden to run.
    Raises `MissingExtra` without the extra `viz`, `OSError` when the file cannot be written.
    """
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise MissingExtra("a report needs plotly; install it with: pip install 'gmds[viz]'") from error

    errors = None if errors is None else per_vertex(errors, answer.source.n_vertices)
    view = broadside(answer.source, up, azimuth=0, elevation=0)
    turned = view @ alignment(answer)
    data = {
        "surfaces": [_surface(answer.source, view), _surface(answer.target, turned)],
        "views": _views(answer, errors),
        "camera": {"up": {"x": 0, "y": 1, "z": 0}, "eye": {"x": 1.1, "y": 0.55, "z": 2.1}},
    }
    script, plotly = (files("gmds.page") / "report.js").read_text("utf-8"), get_plotlyjs()
    page = Template((files("gmds.page") / "report.html").read_text("utf-8")).substitute(
        hashes=f"{_hash(plotly)} {_hash(script)}",
        title=html.escape(title),
        status=html.escape(answer.status.value),
        source=html.escape(names[0]),
        target=html.escape(names[1]),
        ramp=", ".join(f"#{number:06x}" for number in _numbers(value_colours(np.linspace(0, 1, 10), 0, 1))),
        rows=_rows(answer, errors),
        meta=html.escape(json.dumps(dict(answer.meta), indent=1, default=str)),
        data=json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        plotly=plotly,
        script=script,
    )
    with atomic_write(path) as stream:
        stream.write(page.encode("utf-8", "replace"))


def _hash(script: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode('utf-8')).digest()).decode()}'"


def _numbers(colours: Array) -> list[int]:
    """Colours (n, 3) in [0, 1] as numbers 0xrrggbb."""
    levels = np.rint(255 * colours.clip(0, 1)).astype(np.int64)
    return (levels @ [65536, 256, 1]).tolist()


def _surface(mesh: Mesh, rotation: Array) -> dict[str, Any]:
    """Vertices centred, turned and scaled to extent 1, four decimals; faces."""
    v = mesh.vertices - (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    extent = np.ptp(v, axis=0).max()
    v = (v / (extent if extent > 0 else 1)) @ rotation.T
    return {"vertices": v.round(4).tolist(), "faces": mesh.faces.tolist()}


def _views(answer: Correspondence, errors: Array | None) -> list[dict[str, Any]]:
    """What the page can show: the map, its distortion and errors, then the candidates."""
    target = position_colours(answer.target.vertices)
    views = [_map_view("The map", "Corresponding points have the same colour.", answer, answer.points, target)]
    for name, values, meaning in (
        ("Distortion", answer.distortion, "How badly distances from each point are preserved: dark is trustworthy."),
        ("Error", errors, "Distance on the target from the true point, over the square root of its area."),
    ):
        if values is None:
            continue
        low, high = shown_range(values)
        shown = value_colours(np.where(answer.valid, values, np.nan), low, high)
        grey = np.tile(GREY, (answer.target.n_vertices, 1))
        views.append(_map_view(name, meaning, answer, answer.points, grey, shown))
        views[-1]["range"] = [f"{low:.3g}", f"{high:.3g}"]
    for i, candidate in enumerate(answer.candidates, start=1):
        caption = f"Stress {candidate.stress:.4g}, orientation {candidate.orientation:+.2f} (1 keeps, -1 mirrors)."
        views.append(_map_view(f"Candidate {i}", caption, answer, candidate.points, target))
    return views


def _map_view(
    name: str, caption: str, answer: Correspondence, points: SurfacePoints, target: Array, source: Array | None = None
) -> dict[str, Any]:
    if source is None:
        source = points.interpolate(target)
        source[~answer.valid] = MISSING
    return {
        "name": name,
        "caption": caption,
        "source": _numbers(source),
        "target": _numbers(target),
        "face": points.face.tolist(),
        "weights": points.barycentric.round(4).tolist(),
    }


def _rows(answer: Correspondence, errors: Array | None) -> str:
    """The table's rows as HTML: counts, share of valid vertices, distortion, errors by the protocol."""
    valid = answer.valid
    facts = [
        ("vertices, faces of the source", f"{answer.source.n_vertices:,}, {answer.source.n_faces:,}"),
        ("vertices, faces of the target", f"{answer.target.n_vertices:,}, {answer.target.n_faces:,}"),
        ("vertices with a counterpart", f"{100 * valid.mean():.1f} %"),
    ]
    if valid.any() and np.ptp(answer.distortion) > 0:
        middle, most = np.median(answer.distortion[valid]), answer.distortion[valid].max()
        facts.append(("distortion, median and largest", f"{middle:.4g}, {most:.4g}"))
    if errors is not None and valid.any():
        e = errors[valid]
        shares = ", ".join(f"{100 * (e <= t).mean():.1f} % within {t:g}" for t in THRESHOLDS)
        facts.append(("mean error x100", f"{100 * e.mean():.2f} ({shares})"))
    return "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in facts)
