"""The page of a map inside a cell of a notebook, where anywidget is installed."""

from __future__ import annotations

from typing import Any

from gmds.maps.point_map import PointMap
from gmds.report.page import drawings, page_text

HEIGHT = 620  # pixels: the surfaces with what is above and below them; set by hand
SHOW = """
const ONE_COLUMN = 720; // pixels: what is narrower has one surface under the other, as report.css has it
export default { render({ model, el }) {
  const frame = document.createElement("iframe");
  frame.setAttribute("sandbox", "allow-scripts allow-downloads");
  frame.setAttribute("title", "A map, to turn");
  frame.style = "width: 100%; border: 0";
  const narrow = () => el.clientWidth > 0 && el.clientWidth < ONE_COLUMN;
  const fit = () => { frame.style.height = `${model.get("height") * (narrow() ? 1.5 : 1)}px`; };
  fit();
  const watch = new ResizeObserver(fit);
  watch.observe(el);
  frame.srcdoc = model.get("page");
  el.append(frame);
  return () => watch.disconnect();
} };
"""


def widget(answer: PointMap) -> Any:
    """The page as a widget; None without anywidget. It runs in a frame that can reach neither notebook nor network."""
    try:
        from anywidget import AnyWidget
        from traitlets import Int, Unicode
    except ImportError:
        return None

    class MapView(AnyWidget):
        """What a cell shows."""

        _esm = SHOW
        page = Unicode().tag(sync=True)
        height = Int(HEIGHT).tag(sync=True)

    text = page_text(answer, None, drawings(answer, (0, 0, 1)), "Correspondence", ("source", "target"))
    return MapView(page=text)
