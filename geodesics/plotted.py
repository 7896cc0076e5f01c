"""A figure of plotly whose page is as wide as the screen that it is on."""

from __future__ import annotations

from typing import Any

import plotly.graph_objects as go

VIEWPORT = '<meta name="viewport" content="width=device-width, initial-scale=1">'
SCRIPT = f"document.head.insertAdjacentHTML('beforeend', '{VIEWPORT}');"


class Plotted(go.Figure):  # type: ignore[misc]
    """What `plot` returns; without VIEWPORT, which plotly leaves out, a phone draws words too small to read."""

    def to_html(self, *args: Any, **options: Any) -> str:
        return str(super().to_html(*args, **_with_viewport(options)))

    def write_html(self, *args: Any, **options: Any) -> None:
        super().write_html(*args, **_with_viewport(options))


def _with_viewport(options: dict[str, Any]) -> dict[str, Any]:
    """The same with SCRIPT before the scripts that run on the page."""
    if not options.get("full_html", True):
        return options
    given = options.get("post_script") or []
    return options | {"post_script": [SCRIPT, *([given] if isinstance(given, str) else given)]}
