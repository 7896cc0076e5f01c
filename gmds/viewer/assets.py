"""The script, the style and the controls that a page to work in has besides those of a page to look at."""

from __future__ import annotations

from importlib.resources import files

SCRIPTS = ("server.js", "brush.js", "asking.js", "work.js")


def _text(name: str) -> str:
    return (files("gmds.viewer") / name).read_text("utf-8")


SCRIPT = "".join(map(_text, SCRIPTS))
STYLE = _text("work.css")
CONTROLS = _text("work.html")
