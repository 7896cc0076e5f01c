"""Working on a map in a real browser: from legs that are swapped to a corrected map in a file."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import browser, served
from swapped import SwappedPair, swapped_pair

from gmds import Correspondence, geodesic_error
from gmds.landmarks.files import read_landmarks
from gmds.viewer.workplace import Workplace

ON_SCREEN = """([side, vertex]) => {
    turnTo(gmdsPage, side, vertex);
    const scene = gmdsPage.scenes[side], place = scene.place(scene.vertex(vertex));
    const box = scene.plot.getBoundingClientRect();
    return [box.left + place.x, box.top + place.y];
}"""

# Names are drawn once more when the surfaces have come to rest.
SETTLED = "() => !gmdsPage.marks.waiting && performance.now() > gmdsPage.marks.movedAt + 200"


@pytest.fixture(scope="module")
def pair() -> SwappedPair:
    return swapped_pair()


@pytest.fixture(scope="module")
def running() -> Iterator[Any]:
    with browser() as found:
        yield found


def click_on(page: Any, side: int, vertex: int) -> None:
    page.mouse.click(*page.evaluate(ON_SCREEN, [side, vertex]))


def saved(page: Any, kind: str, path: Path) -> Path:
    page.select_option("#save-kind", value=kind)
    with page.expect_download() as offered:
        page.click("#save")
    offered.value.save_as(path)
    return path


def leg_errors(pair: SwappedPair, answer: Correspondence) -> np.ndarray:
    """Errors at those vertices that the wrong map sends to another leg."""
    swapped = geodesic_error(pair.wrong, pair.true) > 0.1
    return geodesic_error(answer, pair.true)[swapped]


def test_swapped_legs_are_corrected_and_saved(pair: SwappedPair, running: Any, tmp_path: Path) -> None:
    assert leg_errors(pair, pair.wrong).mean() > 0.2
    with served(running, Workplace(pair.wrong, ("dog.ply", "wolf.off"))) as page:
        page.click("#tool-place")
        for paw in pair.paws:
            for side, vertex in enumerate(paw):
                click_on(page, side, vertex)
        names = page.locator("#landmark-list input")
        assert names.count() == 2 and page.locator("#landmark-list small").count() == 0
        names.first.fill("left paw")
        names.first.press("Enter")
        page.click("#again")
        page.wait_for_function("() => gmdsPage.data.maps.length > 1 && document.getElementById('progress').hidden")
        assert page.locator("#map option:checked").inner_text().startswith("Match 2, 2 landmarks")
        assert (
            page.locator("#beside option:checked").inner_text() == "Best map" and page.locator("#panel-2").is_visible()
        )
        rated = page.locator("#modes input[value=confidence]")
        assert rated.is_enabled(), "the map that was made is rated, the first is not"
        answer = Correspondence.load(saved(page, "map", tmp_path / "map.npz"), pair.wrong.source, pair.wrong.target)
        page.select_option("#map", index=0)
        assert rated.is_disabled()
        old = Correspondence.load(saved(page, "map", tmp_path / "old.npz"), pair.wrong.source, pair.wrong.target)
        marks = [read_landmarks(saved(page, f".mrk.json {side}", tmp_path / f"{side}.mrk.json")) for side in (0, 1)]
    assert np.array_equal(old.points.face, pair.wrong.points.face)
    assert leg_errors(pair, answer).mean() < 0.05, "the legs are where they belong"
    assert marks[0].names == marks[1].names == ("left paw", "2")
    vertices = np.array(pair.paws)
    for side, mesh in enumerate((pair.wrong.source, pair.wrong.target)):
        far = np.linalg.norm(marks[side].at - mesh.vertices[vertices[:, side]], axis=1)
        assert far.max() < 0.05 * np.sqrt(mesh.area)
    assert answer.meta["landmark_names"] == ["left paw", "2"]
    assert len(answer.meta["parameters"]["landmarks"]["source"]["face"]) == 2


def test_landmarks_are_moved_named_deleted_and_brought_back(pair: SwappedPair, running: Any) -> None:
    place = Workplace(pair.wrong, ("dog.ply", "wolf.off"))
    told = "() => JSON.stringify(gmdsPage.landmarks)"
    with served(running, place) as page:
        page.click("#tool-place")
        stage = page.locator("#stage").bounding_box()
        vertex = int(np.linalg.norm(pair.wrong.source.vertices - [0, -0.3, 1], axis=1).argmin())  # on the flank
        click_on(page, 0, vertex)
        assert page.locator("#landmark-list small").inner_text() == "not yet on the target"
        page.click("#again")
        assert "both surfaces" in page.locator("#work-told").inner_text() and place.job is None
        before = page.evaluate(told)
        page.wait_for_function(SETTLED)
        assert page.locator("#stage").bounding_box() == stage  # what is told moves nothing
        box = page.locator("#labels .label path").bounding_box()
        middle = [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2]
        page.mouse.move(*middle)
        page.mouse.down()
        page.mouse.move(middle[0] + 12, middle[1] + 6, steps=4)
        page.mouse.up()
        moved = page.evaluate(told)
        assert moved != before
        page.click("#undo")
        assert page.evaluate(told) == before
        page.click("#tool-wrong")
        assert page.locator("#brush").is_visible() and page.locator("#stage").bounding_box() == stage
        page.reload()
        page.wait_for_selector("body[data-ready=yes]")
        assert json.loads(page.evaluate(told))[0]["at"][0] == pytest.approx(json.loads(before)[0]["at"][0])
        page.click("[aria-label='Delete landmark 1']")
        assert page.evaluate(told) == "[]"
        page.set_viewport_size({"width": 390, "height": 800})
        surfaces, tools = (page.locator(name).bounding_box()["y"] for name in ("#stage", "#work"))
        assert surfaces < tools, "a phone shows the surfaces first"
        page.wait_for_function("async () => { await gmdsPage.work.sending; return true; }")
    assert place.edits.landmarks == ()


def test_what_is_painted_as_wrong_goes_elsewhere(pair: SwappedPair, running: Any, tmp_path: Path) -> None:
    """With the brush alone, without a landmark: the rest of the map is held, and the legs find their places."""
    place = Workplace(pair.wrong, ("dog.ply", "wolf.off"))
    with served(running, place) as page:
        page.click("#tool-wrong")
        page.evaluate("() => { at('brush').value = 0.12; }")
        camera = page.evaluate("() => JSON.stringify(gmdsPage.scenes[0].camera)")
        for source, _ in pair.paws:
            x, y = page.evaluate(ON_SCREEN, [0, source])
            camera = page.evaluate("() => JSON.stringify(gmdsPage.scenes[0].camera)")
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + 3, y, steps=2)
            page.mouse.up()
            assert page.evaluate("() => JSON.stringify(gmdsPage.scenes[0].camera)") == camera, "painting turns nothing"
        page.click("#again")
        page.wait_for_function("() => gmdsPage.data.maps.length > 1 && document.getElementById('progress').hidden")
        answer = Correspondence.load(saved(page, "map", tmp_path / "map.npz"), pair.wrong.source, pair.wrong.target)
    assert set(answer.meta["marked_wrong"]) >= {source for source, _ in pair.paws}
    assert leg_errors(pair, answer).mean() < 0.05


def test_a_new_landmark_is_seen_below_many(pair: SwappedPair, running: Any) -> None:
    place = Workplace(pair.wrong, ("dog.ply", "wolf.off"))
    places = [mesh.vertices[0].tolist() for mesh in (pair.wrong.source, pair.wrong.target)]
    place.keep({"landmarks": [{"name": f"mark {i}", "at": places} for i in range(20)], "wrong": []})
    with served(running, place) as page:
        page.click("#tool-place")
        click_on(page, 0, int(pair.wrong.source.vertices[:, 2].argmax()))
        box, row = (page.locator(f"#landmark-list{which}").bounding_box() for which in ("", " li.chosen"))
        assert box["y"] - 1 <= row["y"] and row["y"] + row["height"] <= box["y"] + box["height"] + 1
        assert page.evaluate("scrollY") == 0


def test_matching_is_stopped_and_can_begin_again(
    pair: SwappedPair, running: Any, monkeypatch: Any, request: pytest.FixtureRequest
) -> None:
    begun, given_up = [], threading.Event()
    request.addfinalizer(given_up.set)

    def endless(*_: Any, progress: Any, **__: Any) -> None:
        begun.append(1)
        while not given_up.is_set():  # progress() raises when it is to stop
            progress("dreaming", 0.25)

    monkeypatch.setattr("gmds.viewer.workplace.matched_again", endless)
    place = Workplace(pair.wrong, ("dog.ply", "wolf.off"))
    place.keep({"landmarks": [{"name": "a", "at": [[0, 0, 0], [0, 0, 0]]}], "wrong": []})
    with served(running, place) as page:
        for count in (1, 2):
            page.click("#again")
            page.wait_for_function(
                "() => document.getElementById('work-told').textContent.startsWith('dreaming, 25 %')"
            )
            page.click("#stop")
            page.wait_for_function("() => document.getElementById('work-told').textContent === 'stopped'")
            assert len(begun) == count and page.locator("#again").is_enabled()
    assert len(place.maps) == 1
