"""The tools of the page to work in take the room that they fill, and leave the surfaces where they are."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest
from pages import PATIENCE, browser, served
from swapped import swapped_pair

from gmds.viewer.workplace import Workplace

EMPTY = """(selector) => {
    const whole = document.querySelector(selector), box = whole.getBoundingClientRect();
    const range = document.createRange(), filled = [];
    for (const walker = document.createTreeWalker(whole, NodeFilter.SHOW_ALL); walker.nextNode();) {
        const node = walker.currentNode;
        if (node.checkVisibility && !node.checkVisibility({ visibilityProperty: true })) continue;
        if (node.nodeType === 3 && node.data.trim()) range.selectNode(node);
        else if (node.matches && node.matches("button, input, select, ol:empty")) range.selectNode(node);
        else continue;
        for (const { top, bottom, height } of range.getClientRects()) if (height) filled.push([top, bottom]);
    }
    filled.sort((one, other) => one[0] - other[0]);
    let [end, widest] = [box.top, 0];
    for (const [top, bottom] of filled) { widest = Math.max(widest, top - end); end = Math.max(end, bottom); }
    return Math.max(widest, box.bottom - end);
}"""  # pixels of the highest strip across an element with nothing in it
STRIP = 26  # pixels: what is less is the space between two rows, a line of text is 22


@pytest.fixture(scope="module")
def running() -> Iterator[Any]:
    with browser() as found:
        yield found


@pytest.fixture(scope="module")
def wrong() -> Any:
    return swapped_pair().wrong


@pytest.mark.parametrize("size", [(390, 844), (1366, 768), (1920, 1080)])
def test_no_box_is_empty(running: Any, wrong: Any, size: tuple[int, int]) -> None:
    place = Workplace(wrong, ("dog.ply", "wolf.off"))
    with served(running, place, *size) as page:
        for part in ("#work", "main > .bar"):
            assert page.evaluate(EMPTY, part) < STRIP, part
        page.click("#tool-wrong")
        assert page.evaluate(EMPTY, "#work") < STRIP


def test_nothing_moves_while_a_map_is_made(running: Any, wrong: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def long(*_: Any, progress: Any, **__: Any) -> None:
        for _ in range(PATIENCE // 20):
            progress("dreaming of " + "very " * 40 + "many animals", 0.25)
            time.sleep(0.02)

    monkeypatch.setattr("gmds.viewer.workplace.matched_again", long)
    place = Workplace(wrong, ("dog.ply", "wolf.off"))
    place.keep({"landmarks": [{"name": str(i), "at": [[0, 0, 0], [0, 0, 0]]} for i in range(30)], "wrong": []})
    with served(running, place, 1366, 768) as page:
        stage = page.locator("#stage").bounding_box()
        page.click("#again")
        page.wait_for_selector("#stop:visible")
        assert page.locator("#progress").is_visible() and page.locator("#stage").bounding_box() == stage
        page.click("#stop")
        page.wait_for_function("() => document.getElementById('work-told').textContent === 'stopped'")
        assert page.locator("#stage").bounding_box() == stage
