"""A figure of plotly whose page fits the screen that it is on."""

from __future__ import annotations

from functools import cache
from typing import Any

VIEWPORT = '<meta name="viewport" content="width=device-width, initial-scale=1">'
EYE = 1.25  # plotly's own place of the camera along each axis, from which a surface fits the height of a window
FREE = 0.8  # of the width of a phone, which the bar of colours leaves; read off a window of 390 pixels
# words are as large as elsewhere on a phone, and the whole surface is seen in a window that is higher than wide
SCRIPT = f"""document.head.insertAdjacentHTML('beforeend', '{VIEWPORT}');
const far = {EYE} * innerHeight / ({FREE} * innerWidth);
if (far > {EYE}) Plotly.relayout('{{plot_id}}', {{'scene.camera.eye': {{x: far, y: far, z: far}}}});"""


@cache
def figure_class() -> Any:
    """What `plot` returns; a copy of it is a plain figure. Raises `ImportError` without plotly."""
    import plotly.graph_objects as go

    class Plotted(go.Figure):  # type: ignore[misc]
        def to_html(self, *args: Any, **options: Any) -> str:
            return str(super().to_html(*args, **_with_script(options)))

        def write_html(self, *args: Any, **options: Any) -> None:
            super().write_html(*args, **_with_script(options))

        def __reduce__(self) -> Any:
            return go.Figure, super().__reduce__()[1]

    return Plotted


def _with_script(options: dict[str, Any]) -> dict[str, Any]:
    """The same with SCRIPT before the scripts that run on the page."""
    if not options.get("full_html", True):
        return options
    given = options.get("post_script") or []
    return options | {"post_script": [SCRIPT, *([given] if isinstance(given, str) else given)]}
