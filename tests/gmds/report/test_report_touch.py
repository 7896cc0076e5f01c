"""The page under fingers, on a phone as chromium emulates one: what is sent are touches, not clicks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from gmds import Correspondence
from gmds.report.page import write_report
from gmds.shapes import quadruped, truth
from tests.support.pages import browser

STEPS = 20  # of a stroke, as a screen tells of a finger


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    source, target = quadruped(n_vertices=1500), quadruped("walk", n_vertices=1400, seed=1)
    path = tmp_path_factory.mktemp("page") / "report.html"
    write_report(path, Correspondence.from_points(source, truth(source, target)))
    return path


@pytest.fixture(scope="module")
def running() -> Iterator[Any]:
    with browser() as found:
        yield found


@pytest.fixture
def page(running: Any, file: Path) -> Iterator[Any]:
    context = running.new_context(viewport={"width": 390, "height": 700}, has_touch=True, is_mobile=True, offline=True)
    page = context.new_page()
    page.goto(file.as_uri())
    page.wait_for_selector("body[data-ready]")
    yield page
    context.close()


def stroke(page: Any, *ways: tuple[float, float], start: tuple[float, float] = (0, 0)) -> None:
    """A finger for each way, put on the source and moved by so many pixels; two begin 60 pixels apart."""
    box = page.locator("#panel-0 .plot").bounding_box()
    x, y = box["x"] + box["width"] / 2 + start[0], box["y"] + box["height"] / 2 + start[1]
    session = page.context.new_cdp_session(page)

    def send(kind: str, share: float) -> None:
        points = [{"x": x + 60 * i + share * dx, "y": y + share * dy, "id": i} for i, (dx, dy) in enumerate(ways)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [] if kind == "touchEnd" else points})

    send("touchStart", 0)
    for i in range(1, STEPS + 1):
        send("touchMove", i / STEPS)
        page.wait_for_timeout(16)
    send("touchEnd", 1)
    page.wait_for_timeout(100)


def camera(page: Any) -> dict[str, dict[str, float]]:
    return page.evaluate("gmdsPage.scenes[0].camera")


def scrolled(page: Any) -> float:
    return page.evaluate("scrollY")


@pytest.mark.parametrize("way", [(0, -150), (30, -150), (-60, -120)])
def test_a_finger_that_goes_up_scrolls_the_page_and_leaves_the_surface(page: Any, way: tuple[float, float]) -> None:
    before = camera(page)
    stroke(page, way)
    assert camera(page) == before
    assert scrolled(page) > 50


@pytest.mark.parametrize("way", [(120, 0), (-120, 30), (100, -90)])
def test_a_finger_that_goes_sideways_turns_the_surface_and_leaves_the_page(page: Any, way: tuple[float, float]) -> None:
    before = camera(page)
    stroke(page, way)
    assert abs(camera(page)["eye"]["x"] - before["eye"]["x"]) > 0.2
    assert scrolled(page) == 0


def test_a_finger_that_began_sideways_may_go_up_and_still_turns(page: Any) -> None:
    """What the first pixels said holds until the finger is lifted."""
    page.evaluate("scrollTo(0, 0)")
    box = page.locator("#panel-0 .plot").bounding_box()
    x, y = box["x"] + 150, box["y"] + box["height"] / 2
    session = page.context.new_cdp_session(page)
    send = lambda kind, *at: session.send(  # noqa: E731
        "Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": a, "y": b} for a, b in at]}
    )
    send("touchStart", (x, y))
    for i in range(1, STEPS + 1):
        send("touchMove", (x + 2 * i, y))
    level = camera(page)
    for i in range(1, STEPS + 1):
        send("touchMove", (x + 2 * STEPS, y - 4 * i))
        page.wait_for_timeout(16)
    send("touchEnd")
    assert abs(camera(page)["eye"]["y"] - level["eye"]["y"]) > 0.1
    assert scrolled(page) == 0


def test_two_fingers_zoom_and_move_and_leave_the_page(page: Any) -> None:
    before = camera(page)
    stroke(page, (-60, 0), (60, 0))
    near = camera(page)
    away = [sum((one["eye"][k] - one["center"][k]) ** 2 for k in "xyz") ** 0.5 for one in (before, near)]
    assert away[1] < 0.6 * away[0]
    stroke(page, (0, -80), (0, -80))
    assert camera(page)["center"] != near["center"]
    assert scrolled(page) == 0 and page.evaluate("visualViewport.scale") == 1


def test_a_tap_marks_a_pair_and_turns_nothing(page: Any) -> None:
    before = camera(page)
    x, y = on_screen(page, 30)
    page.touchscreen.tap(x, y)
    assert camera(page) == before
    assert page.evaluate("gmdsPage.pins.length") == 1


def test_what_a_finger_tapped_is_told_until_the_next_tap(page: Any) -> None:
    """A finger leaves the surface as it is lifted, which is no reason to forget what it tapped."""
    told = []
    for vertex in (30, 900):
        page.touchscreen.tap(*on_screen(page, vertex))
        told.append(page.locator("#readout").get_attribute("data-vertex"))
        assert page.locator("#readout").inner_text().startswith(f"Vertex {told[-1]} of ")
    assert told[0] != told[1]


def on_screen(page: Any, vertex: int) -> tuple[float, float]:
    """Where a vertex of the source is on the screen."""
    return page.evaluate(
        """(vertex) => {
        const scene = gmdsPage.scenes[0], box = scene.plot.getBoundingClientRect();
        const { x, y } = scene.place(scene.vertex(vertex));
        return [box.left + x, box.top + y];
    }""",
        vertex,
    )
