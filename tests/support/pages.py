"""Reading the page that `gmds.report` writes, and a browser to look at it with."""

from __future__ import annotations

import base64
import gzip
import json
import os
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

HOSTILE = "</script><script>document.title='owned'</script><img src=x onerror=\"document.title='owned'\"> &amp; ʃ\u202e"
PATIENCE = 60_000  # ms: the machine may have other things to do
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


class Elements(HTMLParser):
    """Every tag with its attributes, and the text inside each script."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[str] = []
        self.scripts: list[tuple[dict, str]] = []
        self.policy = ""
        self._inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list) -> None:
        self.tags.append(tag)
        self.attributes += [name for name, _ in attrs]
        self._inside = tag == "script"
        if tag == "script":
            self.scripts.append((dict(attrs), ""))
        if tag == "meta" and dict(attrs).get("http-equiv") == "Content-Security-Policy":
            self.policy = dict(attrs)["content"]

    def handle_endtag(self, tag: str) -> None:
        self._inside = False

    def handle_data(self, data: str) -> None:
        if self._inside:
            attrs, text = self.scripts[-1]
            self.scripts[-1] = (attrs, text + data)


def elements(path: Path) -> Elements:
    """What the page is made of."""
    return Elements(path.read_text(encoding="utf-8"))


def unpacked(path: Path, name: str) -> str:
    """A text that the page carries packed."""
    packed = next(text for attrs, text in elements(path).scripts if attrs.get("id") == name)
    return gzip.decompress(base64.b64decode(packed)).decode("utf-8")


def page_data(path: Path) -> dict[str, Any]:
    """The data of a page, its arrays as arrays."""

    def revived(thing: dict) -> Any:
        return np.frombuffer(base64.b64decode(thing["bytes"]), thing["dtype"]) if "dtype" in thing else thing

    return json.loads(unpacked(path, "data"), object_hook=revived)


@contextmanager
def browser() -> Iterator[Any]:
    """A chromium without a window; the test is skipped where there is none, or no playwright to drive it."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright", exc_type=ImportError)
    found = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
    if found is None:
        pytest.skip("needs chromium")
    with sync_api.sync_playwright() as driver:
        try:
            running = driver.chromium.launch(executable_path=found, args=FLAGS)
        except sync_api.Error as error:
            pytest.skip(f"chromium does not start: {str(error).splitlines()[0]}")
        yield running
        running.close()


@contextmanager
def served(running: Any, place: Any, width: int = 1366, height: int = 650) -> Iterator[Any]:
    """The page of a workplace of `gmds.viewer`, in a window of that many pixels; it must say nothing on the console."""
    from gmds.viewer.server import PageServer

    with PageServer(place) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.02,))
        thread.start()
        context = running.new_context(viewport={"width": width, "height": height})
        page, said = context.new_page(), []
        page.set_default_timeout(PATIENCE)
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(server.link)
        page.wait_for_selector("body[data-ready=yes]")
        try:
            yield page
        finally:  # else a test that fails would wait for the server for ever
            context.close()
            server.shutdown()
            thread.join()
        assert said == []


class Visit:
    """A page opened without a network: what it asked for and what it said on the console are kept."""

    def __init__(self, running: Any, path: Path, width: int = 1280, height: int = 900) -> None:
        self.context = running.new_context(viewport={"width": width, "height": height}, offline=True)
        self.page = self.context.new_page()
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.said.append(f"error: {error}"))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.set_default_timeout(PATIENCE)
        self.page.goto(path.as_uri(), timeout=PATIENCE)
        self.page.wait_for_selector("body[data-ready]")
