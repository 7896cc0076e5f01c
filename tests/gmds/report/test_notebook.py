"""In a notebook a map shows itself: picture, table, and never an error."""

from __future__ import annotations

import base64
import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated_shapes import icosphere, tetrahedron
from pages import browser

import gmds.pictures.panels
import gmds.report.notebook
from geodesics import SurfacePoints
from gmds import Correspondence


def identity(subdivisions: int = 2) -> Correspondence:
    sphere = icosphere(subdivisions)
    points = SurfacePoints.at_vertices(sphere, np.arange(sphere.n_vertices))
    return Correspondence.from_points(sphere, points, meta={"note": "<img src=x onerror=alert(1)>"})


def tags(text: str) -> list[str]:
    found: list[str] = []
    parser = HTMLParser()
    parser.handle_starttag = lambda tag, _: found.append(tag)  # type: ignore[method-assign]
    parser.feed(text)
    return found


def test_a_map_shows_a_picture_and_a_table() -> None:
    bundle = identity()._repr_mimebundle_(include=None, exclude=None)
    assert bundle["text/plain"] == "Correspondence(162 -> 162 vertices, 162 valid, UNRATED)"
    picture = re.search(r"data:image/png;base64,([^\"]+)", bundle["text/html"])
    assert picture and base64.b64decode(picture[1]).startswith(b"\x89PNG")
    assert "162, 100.0 %" in bundle["text/html"] and len(bundle["text/html"]) < 200_000
    assert tags(bundle["text/html"]).count("img") == 1


@pytest.mark.parametrize(("module", "name"), [(gmds.report.notebook, "composed"), (gmds.report.notebook, "_table")])
def test_what_fails_leaves_the_rest(monkeypatch: pytest.MonkeyPatch, module: Any, name: str) -> None:
    def broken(*_: object, **__: object) -> str:
        raise RuntimeError("no")

    monkeypatch.setattr(module, name, broken)
    bundle = identity()._repr_mimebundle_()
    assert "text/plain" in bundle
    assert ("text/html" in bundle) == (name == "composed")
    assert "img" not in tags(bundle.get("text/html", ""))


def test_large_surfaces_and_empty_maps_show_a_table(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gmds.report.notebook, "MOST_FACES", 100)
    assert "img" not in tags(identity()._repr_mimebundle_()["text/html"])
    shape = tetrahedron()
    nothing = Correspondence.from_points(
        shape, SurfacePoints.at_vertices(shape, [0, 1, 2, 3]), valid=np.zeros(4, dtype=bool)
    )
    assert "0, 0.0 %" in nothing._repr_mimebundle_()["text/html"]


def test_a_notebook_runs_and_shows_the_map(tmp_path: Path) -> None:
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    book = nbformat.v4.new_notebook()
    made = "import numpy, geodesics, gmds\nshape = gmds.shapes.quadruped(n_vertices=300)\n"
    made += "points = geodesics.SurfacePoints.at_vertices(shape, numpy.arange(300))\n"
    made += "gmds.Correspondence.from_points(shape, points)"
    book.cells.append(nbformat.v4.new_code_cell(made))
    nbclient.NotebookClient(
        book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    shown = book.cells[0].outputs[0]["data"]
    assert "300, 100.0 %" in shown["text/html"] and "data:image/png" in shown["text/html"]
    assert shown["text/plain"].startswith("Correspondence(300 -> 300 vertices")


def test_with_anywidget_a_map_is_the_page(tmp_path: Path) -> None:
    """In a browser, in the frame that the widget makes: it is drawn, and cannot reach what is around it."""
    pytest.importorskip("anywidget")
    answer = identity()
    bundle = answer._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in bundle and "<img" in bundle["text/html"]
    assert "max-width: 100%" in bundle["text/html"]  # a narrow cell shows all of it
    view = gmds.report.notebook.widget(answer)
    script = (
        str(view._esm).replace("export default", "const shown =")
        + f"const state = {json.dumps({'page': view.page, 'height': 500})};".replace("</", "<\\/")
        + "shown.render({ model: { get: (name) => state[name] }, el: document.body });"
    )
    (tmp_path / "cell.html").write_text(f"<!DOCTYPE html><body><script>{script}</script></body>", encoding="utf-8")
    with browser() as running:
        page = running.new_page()
        page.goto((tmp_path / "cell.html").as_uri())
        frame = page.frame_locator("iframe")
        frame.locator("body[data-ready=yes]").wait_for(timeout=60_000)
        assert frame.locator("#cards").inner_text().startswith("100.0 %")
        assert page.evaluate("document.querySelector('iframe').contentDocument") is None
        for width, height in ((1000, 500), (390, 750)):  # one surface under the other takes more room
            page.set_viewport_size({"width": width, "height": 800})
            page.wait_for_function(f"document.querySelector('iframe').clientHeight === {height}")


def test_without_anywidget_it_is_a_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", None)
    assert set(identity()._repr_mimebundle_()) == {"text/plain", "text/html"}
