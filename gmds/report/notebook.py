"""How a map shows itself in a notebook: a small picture and a few figures, whatever is installed."""

from __future__ import annotations

import base64
import contextlib
import html
from typing import Any

from gmds.maps.point_map import PointMap
from gmds.pictures.figure import composed, encoded
from gmds.pictures.panels import map_panels
from gmds.pictures.software import software
from gmds.report.tables import table_rows
from gmds.report.told import facts
from gmds.report.widget import widget

PIXELS = 260  # across each view, so that three of them fit into a cell; set by hand
MOST_FACES = 200_000  # faces of both surfaces, above which there is no picture: 3 s at 160,000, measured


def mimebundle(answer: PointMap) -> dict[str, Any]:
    """The map as plain text, as HTML (a table, and a picture if one can be drawn soon), and as a widget. Never raises.

    The widget is the page of the map, where anywidget is installed; a notebook shows the best that it can.
    """
    bundle: dict[str, Any] = {"text/plain": repr(answer)}
    with contextlib.suppress(Exception):  # a cell that shows a map must not fail because of how it looks
        bundle["text/html"] = f"<div>{_picture(answer)}{_table(answer)}</div>"
        if _is_small(answer) and (view := widget(answer)) is not None:
            bundle.update({kind: shown for kind, shown in view._repr_mimebundle_()[0].items() if kind not in bundle})
    return bundle


def _table(answer: PointMap) -> str:
    state = table_rows([("status", f"{answer.status.name}: {answer.status.value}")])
    hint = "<code>.report('map.html')</code> makes a page to turn it in a browser."
    told = state + table_rows(facts(answer, None, shares=_is_small(answer)))
    return f'<table style="text-align:left">{told}</table><small>{hint}</small>'


def _is_small(answer: PointMap) -> bool:
    """Whether what takes its time is done all the same."""
    return answer.source.n_faces + answer.target.n_faces <= MOST_FACES


def _picture(answer: PointMap) -> str:
    """The picture as an element of a page; nothing where it cannot be drawn, or not soon."""
    if not _is_small(answer):
        return ""
    try:
        panels = map_panels(answer, pixels=PIXELS)
        picture = encoded(composed(panels, software([panel.shot for panel in panels])), ".png")
    except Exception:
        return ""
    data = base64.b64encode(picture).decode("ascii")
    text = html.escape("source and target; corresponding points have the same colour")
    return f'<img style="max-width: 100%" alt="{text}" src="data:image/png;base64,{data}">'
