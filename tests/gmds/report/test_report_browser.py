"""The page in a real browser: nothing is fetched, nothing goes wrong, and what lights up is the true partner."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cut_shapes import half_animal
from generated_shapes import subdivided
from pages import HOSTILE, Visit, browser, page_data

from geodesics import SurfacePoints
from gmds import Correspondence
from gmds.maps.point_map import Candidate
from gmds.maps.words import WORDS
from gmds.report.drawing import MOST_VERTICES
from gmds.report.page import write_report
from gmds.shapes import quadruped, truth


@pytest.fixture(scope="module")
def answer() -> Correspondence:
    source, target = quadruped(n_vertices=1500), quadruped("walk", head_scale=2, n_vertices=1400, seed=1)
    mirrored = Candidate(truth(source, target, mirrored=True), 0.2, -0.8)
    valid = np.arange(1500) % 10 > 0
    spread = np.linspace(0, 0.3, 1500)
    points = truth(source, target)
    return Correspondence.from_points(source, points, valid=valid, distortion=spread, candidates=(mirrored,))


@pytest.fixture(scope="module")
def running() -> Iterator[Any]:
    with browser() as found:
        yield found


@pytest.fixture(scope="module")
def file(answer: Correspondence, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    write_report(path, answer, errors=np.linspace(0, 0.2, 1500), title=HOSTILE, names=(HOSTILE, HOSTILE))
    return path


@pytest.fixture(scope="module")
def visit(running: Any, file: Path) -> Visit:
    return Visit(running, file)


@pytest.fixture
def page(visit: Visit) -> Any:
    """The page as it is when opened."""
    visit.page.keyboard.press("Escape")
    visit.page.select_option("#map", index=0)
    visit.page.check("input[value=match]", force=True)
    visit.page.click("#reset")
    return visit.page


def camera_of(page: Any, side: int) -> dict[str, Any]:
    """The camera of a panel, and how large the panel is."""
    return page.evaluate(
        "(side) => { const {plot, camera} = gmdsPage.scenes[side]; const box = plot.getBoundingClientRect();"
        "return {...camera, box: [box.left, box.top, box.width, box.height]}; }",
        side,
    )


def on_screen(page: Any, side: int, positions: np.ndarray) -> np.ndarray:
    """Where drawn positions (p, 3) are on the screen, and how far away: a camera with 45 degrees from top to bottom."""
    camera = camera_of(page, side)
    eye, up = (np.array([camera[name][axis] for axis in "xyz"]) for name in ("eye", "up"))
    back = eye / np.linalg.norm(eye)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    left, top, width, height = camera["box"]
    d = positions - eye
    depth = -d @ back
    focal = height / 2 / np.tan(np.pi / 8)
    return np.stack(
        [
            left + width / 2 + focal * (d @ right) / depth,
            top + height / 2 - focal * (d @ np.cross(back, right)) / depth,
            depth,
        ],
        axis=1,
    )


def front_face(seen: np.ndarray, faces: np.ndarray, pointer: np.ndarray) -> int:
    """The face in front at a place of the screen: each is asked whether it covers the place, and how far away it is."""
    corners = seen[faces]
    systems = np.stack([corners[..., 0], corners[..., 1], np.ones(corners.shape[:2])], axis=1)
    proper = np.flatnonzero(np.linalg.det(systems) != 0)
    weights = np.linalg.solve(systems[proper], np.tile([*pointer, 1.0], (len(proper), 1))[..., None])[..., 0]
    depth = 1 / (weights / corners[proper, :, 2]).sum(axis=1)
    return int(proper[np.where(weights.min(axis=1) >= 0, depth, np.inf).argmin()])


def read_out(page: Any) -> dict[str, str]:
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return page.evaluate("() => ({...document.getElementById('readout').dataset})")


def mark_of(page: Any, side: int) -> np.ndarray:
    box = page.locator(f"#mark-{side}").bounding_box()
    return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])


def test_it_loads_without_a_network_or_a_word_on_the_console(visit: Visit, file: Path) -> None:
    assert visit.page.evaluate("document.body.dataset.ready") == "yes"
    assert visit.asked == [file.as_uri()]
    assert visit.said == []
    assert file.stat().st_size < 6e6


def test_names_are_shown_as_they_are_and_run_nothing(visit: Visit) -> None:
    assert visit.page.title() == " ".join(HOSTILE.split())
    assert visit.page.locator("h1").inner_text() == HOSTILE
    assert visit.page.locator("#panel-0 bdi").inner_text() == HOSTILE
    assert visit.page.locator("img[src=x]").count() == 0


@pytest.mark.parametrize("side", [0, 1])
def test_pointing_lights_up_the_true_partner(answer: Correspondence, page: Any, file: Path, side: int) -> None:
    data = page_data(file)
    vertices = data["surfaces"][side]["vertices"].reshape(-1, 3)
    others = data["surfaces"][1 - side]["vertices"].reshape(-1, 3)
    images = (answer if side == 0 else answer.inverse()).points
    found = answer.valid if side == 0 else answer.covered
    seen, faces = on_screen(page, side, vertices), data["surfaces"][side]["faces"].reshape(-1, 3)
    left, top, width, height = camera_of(page, side)["box"]
    hits = 0
    for x, y in np.stack(np.meshgrid(np.linspace(0.2, 0.8, 7), np.linspace(0.3, 0.7, 4)), axis=-1).reshape(-1, 2):
        pointer = np.array([left + x * width, top + y * height])
        page.mouse.move(*pointer)
        told = read_out(page)
        if "vertex" not in told:
            continue
        vertex = int(told["vertex"])
        hits += 1
        assert vertex in faces[front_face(seen, faces, pointer)]
        assert np.allclose(mark_of(page, side), seen[vertex, :2], atol=1)
        if not found[vertex]:
            assert told["face"] == ""
            continue
        assert int(told["face"]) == images.face[vertex]
        weights = np.array(told["weights"].split(), dtype=float)
        assert np.allclose(weights, images.barycentric[vertex], atol=1e-4)
        corners = others[images.mesh.faces[images.face[vertex]]]
        place = on_screen(page, 1 - side, (weights @ corners)[None])[0, :2]
        assert np.allclose(mark_of(page, 1 - side), place, atol=1)
    assert hits >= 5


def test_what_is_drawn_is_where_the_page_believes_it_is(answer: Correspondence, page: Any, file: Path) -> None:
    """The colour on the screen at a vertex in front is that of the vertex, but for the light."""
    from io import BytesIO

    from matplotlib.image import imread

    data = page_data(file)
    vertices, colours = data["surfaces"][0]["vertices"].reshape(-1, 3), data["maps"][0]["colours"].reshape(-1, 3)
    page.mouse.move(2, 2)
    image = imread(BytesIO(page.screenshot()))[:, :, :3]
    seen = on_screen(page, 0, vertices)
    rows = [
        i
        for i in np.flatnonzero(answer.valid)[::9]
        if page.evaluate("(p) => !gmdsPage.scenes[0].place(p).hidden", vertices[i].tolist())
    ]
    shown = image[seen[rows, 1].round().astype(int), seen[rows, 0].round().astype(int)]
    direction = colours[rows] / np.linalg.norm(colours[rows], axis=1, keepdims=True)
    alike = (shown * direction).sum(axis=1) / np.linalg.norm(shown, axis=1)
    assert len(rows) > 40 and np.median(alike) > 0.999 and (alike > 0.97).mean() > 0.75  # some are at an outline


def painted_at(page: Any, side: int, places: np.ndarray) -> np.ndarray:
    """What is on the canvas of a panel, where the page believes that positions (p, 3) are: red, green and blue."""
    return np.array(
        page.evaluate(
            """([side, places]) => {
                const scene = gmdsPage.scenes[side], {gl, canvas} = scene.painter, one = new Uint8Array(4);
                scene.drawNow();
                const fine = canvas.width / scene.plot.clientWidth;
                return places.map((place) => {
                    const [x, y] = project(scene.lens, place).map((c) => Math.floor(c * fine));
                    gl.readPixels(x, canvas.height - 1 - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, one);
                    return Array.from(one.slice(0, 3));
                });
            }""",
            [side, places.tolist()],
        ),
        dtype=float,
    )


def in_front(page: Any, side: int, places: np.ndarray) -> np.ndarray:
    """Which of the positions (p, 3) the surface does not hide, and the panel shows."""
    seen = """([side, places]) => places.map((p) => {
        const scene = gmdsPage.scenes[side], {x, y, hidden} = scene.place(p);
        return !hidden && x > 1 && y > 1 && x < scene.plot.clientWidth - 1 && y < scene.plot.clientHeight - 1;
    })"""
    at_outline = painted_at(page, side, places).sum(axis=1) == 0
    return np.array(page.evaluate(seen, [side, places.tolist()])) & ~at_outline


@pytest.mark.parametrize("side", [0, 1])
def test_squares_are_dark_at_the_same_points_of_both_surfaces(
    answer: Correspondence, page: Any, file: Path, side: int
) -> None:
    """A point of the source is in the square of its image: cells of the target's box, every second one darker."""
    data = page_data(file)
    places = data["surfaces"][side]["vertices"].reshape(-1, 3)
    seats = data["maps"][0]["there"]["position"].reshape(-1, 3) / 65535 - 0.5 if side == 0 else places
    cells = seats * 14  # squares from one end of the target to the other
    deep = np.abs(cells - np.rint(cells)).min(axis=1) > 0.2  # within its square
    rows = np.flatnonzero(deep & (answer.valid if side == 0 else True))[::3]
    rows = rows[in_front(page, side, places[rows])]
    plain = painted_at(page, side, places[rows])
    page.check("#squares", force=True)
    ratio = painted_at(page, side, places[rows]).sum(axis=1) / plain.sum(axis=1)
    dark = np.floor(cells[rows]).astype(int).sum(axis=1) % 2 == 1
    assert len(rows) > 40 and 0.2 < dark.mean() < 0.8
    assert np.median(ratio[dark]) == pytest.approx(0.72, abs=0.02) and np.median(ratio[~dark]) == pytest.approx(1)
    assert np.mean((ratio < 0.86) == dark) > 0.95  # some are at an outline
    page.check("input[value=distortion]", force=True)
    assert not page.locator("#squares").is_visible(), "squares belong to matching colours"
    page.check("input[value=match]", force=True)
    page.uncheck("#squares", force=True)
    assert np.array_equal(painted_at(page, side, places[rows]), plain)


def test_edges_are_drawn_where_faces_meet_and_nowhere_else(page: Any, file: Path) -> None:
    surface = page_data(file)["surfaces"][0]
    places, faces = surface["vertices"].reshape(-1, 3), surface["faces"].reshape(-1, 3)
    page.evaluate("() => gmdsPage.scenes[0].look(zoomed(gmdsPage.scenes[0].camera, 0.3))")  # faces of many pixels
    middles, edges = places[faces[::6]].mean(axis=1), places[faces[::6, :2]].mean(axis=1)
    rows = np.flatnonzero(in_front(page, 0, middles) & in_front(page, 0, edges))
    before = [painted_at(page, 0, where[rows]).sum(axis=1) for where in (middles, edges)]
    page.check("#wireframe")
    after = [painted_at(page, 0, where[rows]).sum(axis=1) for where in (middles, edges)]
    page.uncheck("#wireframe")
    inside, along = (late / early for late, early in zip(after, before, strict=True))
    assert len(rows) > 40 and np.median(inside) == 1 and np.median(along) < 0.85


def test_edges_are_light_where_colours_are_dark(answer: Correspondence, running: Any, tmp_path: Path) -> None:
    """Without errors everything is dark blue, on which dark lines cannot be seen."""
    file = tmp_path / "exact.html"
    write_report(file, answer, errors=np.zeros(1500))
    visit = Visit(running, file)
    page, surface = visit.page, page_data(file)["surfaces"][0]
    places, faces = surface["vertices"].reshape(-1, 3), surface["faces"].reshape(-1, 3)
    page.check("#modes input[value=error]", force=True)
    page.evaluate("() => gmdsPage.scenes[0].look(zoomed(gmdsPage.scenes[0].camera, 0.3))")
    edges = places[faces[::6, :2]].mean(axis=1)
    edges = edges[in_front(page, 0, edges)]
    before = painted_at(page, 0, edges).sum(axis=1)
    page.check("#wireframe")
    assert len(edges) > 40 and np.median(painted_at(page, 0, edges).sum(axis=1) / before) > 1.3
    visit.context.close()


def test_switching_map_and_colours(answer: Correspondence, page: Any, file: Path) -> None:
    data = page_data(file)
    painted = "() => Array.from(gmdsPage.scenes[0].painted)"

    def expected(rgb: np.ndarray) -> list[int]:
        return rgb.reshape(-1).tolist()

    assert page.evaluate(painted) == expected(data["maps"][0]["colours"])
    first = page.locator("#cards").inner_text()
    assert "of the source has a counterpart" in first and "median distortion" in first
    page.select_option("#map", index=1)
    assert page.evaluate(painted) == expected(data["maps"][1]["colours"])
    assert page.locator("input[value=distortion]").is_disabled()
    badge, facts = page.locator("#badge"), page.locator("#facts").inner_text()
    assert (badge.inner_text(), badge.get_attribute("class")) == ("Candidate", "badge plain")
    assert "another one to compare" in page.locator("#status").inner_text()
    assert page.locator("#cards").inner_text().split("\n")[:2] == ["0.2", "stress (small is good)"]
    assert "median distortion" not in page.locator("#cards").inner_text()
    assert "orientation" in facts and "mean error" not in facts
    assert page.locator("#next").inner_text().startswith("Compare it with the best map")
    assert not page.locator("#curve").is_visible(), "the errors of this map are not known"
    other = answer.candidates[0].points
    page.fill("#go-vertex", "77")
    page.click("#go button")
    assert int(read_out(page)["face"]) == other.face[77]
    page.select_option("#map", index=0)
    assert int(read_out(page)["face"]) == answer.points.face[77], "a marked pair follows the map"
    assert badge.inner_text() == "UNRATED" and "mean error" in page.locator("#facts").inner_text()
    assert page.locator("#cards").inner_text() == first
    for mode in ("distortion", "valid", "error"):
        before = page.evaluate(painted)
        page.check(f"input[value={mode}]", force=True)
        assert page.evaluate(painted) != before
        assert page.locator("#legend-ramp").is_visible() == (mode != "valid")
        assert page.locator("#histogram").is_visible() == (mode != "valid")
    assert page.locator("#curve").is_visible()
    ramp = data["ramp"].reshape(-1, 3)
    shares = np.clip(data["maps"][0]["values"]["error"][0] / 0.25, 0, 1)  # the fixed scale
    steps = np.rint(shares * (len(ramp) - 1)).astype(int)
    assert np.mean(np.array(page.evaluate(painted)) == np.array(expected(ramp[steps]))) > 0.99  # rounding aside
    page.check("#fit")
    assert (
        np.array_equal(page.evaluate(painted)[-3:], ramp[-1]) and page.locator("#high").inner_text() == "0.196 and more"
    )
    page.uncheck("#fit")
    assert page.locator("#high").inner_text() == "0.25"


def test_no_word_of_another_map_moves_the_surfaces(running: Any, tmp_path: Path) -> None:
    """Whatever the candidates need for their figures is kept free while the best map is shown."""
    source = quadruped(n_vertices=500)
    points = SurfacePoints.at_vertices(source, np.arange(500))
    other = Candidate(points, 0.2, -0.8)
    answer = Correspondence.from_points(source, points, candidates=(other, other))
    write_report(tmp_path / "two.html", answer, errors=np.ones((3, 500)), title="A name that is rather long, " * 3)
    for width, height in ((1366, 650), (390, 800)):
        page = Visit(running, tmp_path / "two.html", width=width, height=height).page
        boxes = []
        for number in (0, 1, 2, 0):
            page.select_option("#map", index=number)
            boxes.append([page.locator(part).bounding_box() for part in ("#stage", "h1", "#modes")])
        assert [box[0] for box in boxes] == [boxes[0][0]] * 4
        assert width == 390 or boxes == boxes[:1] * 4


def test_every_click_keeps_a_pair_and_escape_lets_all_go(page: Any) -> None:
    left, top, width, height = camera_of(page, 0)["box"]
    pins = "() => gmdsPage.pins.map(({side, vertex}) => [side, vertex])"
    for x in (0.45, 0.5):
        page.mouse.click(left + x * width, top + 0.5 * height)
        assert [0, int(read_out(page)["vertex"])] in page.evaluate(pins)
    page.mouse.move(left + 2, top + 2)
    assert page.locator("#pin-table tr").count() == 2 and page.locator("#pins .pin").count() == 4
    with page.expect_download() as offered:
        page.click("#save-pins")
    lines = Path(offered.value.path()).read_text(encoding="utf-8").splitlines()
    assert len(lines) == 3 and lines[0].startswith("pair,given_on,source_vertex,target_face")
    page.keyboard.press("Escape")
    assert read_out(page) == {} and page.evaluate(pins) == []


def test_keys_turn_both_surfaces_and_a_box_lets_go_of_the_other(page: Any) -> None:
    first = camera_of(page, 0)
    page.focus("#panel-0")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("+")
    assert camera_of(page, 0)["eye"] == camera_of(page, 1)["eye"] != first["eye"]
    page.uncheck("#together")
    page.focus("#panel-0")
    page.keyboard.press("ArrowUp")
    assert camera_of(page, 0)["eye"] != camera_of(page, 1)["eye"]
    page.check("#together")


def test_dragging_turns_both_surfaces(page: Any) -> None:
    before = camera_of(page, 1)
    left, top, width, height = camera_of(page, 0)["box"]
    page.mouse.move(left + width / 2, top + height / 2)
    page.mouse.down()
    page.mouse.move(left + width / 2 + 40, top + height / 2, steps=3)
    page.mouse.up()
    assert camera_of(page, 1)["eye"] == pytest.approx(camera_of(page, 0)["eye"])
    assert camera_of(page, 1)["eye"] != before["eye"]
    turned = camera_of(page, 1)["eye"]
    page.mouse.wheel(0, -120)
    page.wait_for_function("(eye) => JSON.stringify(gmdsPage.scenes[1].camera.eye) !== JSON.stringify(eye)", arg=turned)
    assert camera_of(page, 1)["eye"] == camera_of(page, 0)["eye"], "the wheel zooms both"


def test_the_largest_value_is_found_and_turned_to(answer: Correspondence, page: Any) -> None:
    page.check("input[value=distortion]", force=True)
    page.click("#largest")
    rows = np.flatnonzero(answer.valid)
    assert int(read_out(page)["vertex"]) == rows[answer.distortion[rows].argmax()]


def test_a_narrow_window_shows_one_surface_under_the_other(running: Any, file: Path) -> None:
    page = Visit(running, file, width=390, height=800).page
    first, second = (page.locator(f"#panel-{side}").bounding_box() for side in (0, 1))
    assert second["y"] >= first["y"] + first["height"]
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.set_viewport_size({"width": 390, "height": 640})  # what the bars of a browser leave of a phone
    readout = page.locator("#readout").bounding_box()
    assert readout["y"] + readout["height"] <= 640, "what is told stays in view"


def test_the_map_beside_it_is_told_of_as_well(page: Any) -> None:
    page.select_option("#beside", index=2)
    page.evaluate("gmdsPage.mark({ side: 0, vertex: 151 })")
    partner = page.evaluate("gmdsPage.partner(0, 151, gmdsPage.beside).vertex")
    name = page.locator("#beside option").nth(2).inner_text()
    assert f"With {name} it goes to nearest vertex {partner}" in page.locator("#readout").inner_text()
    page.select_option("#beside", index=0)
    page.evaluate("gmdsPage.mark({ side: 0, vertex: 151 })")
    assert "With " not in page.locator("#readout").inner_text()


def test_colours_that_a_candidate_lacks_come_back_with_the_map_that_has_them(page: Any) -> None:
    page.check("input[value=distortion]", force=True)
    page.select_option("#map", index=1)
    assert page.evaluate("gmdsPage.mode.key") == "match"
    page.select_option("#map", index=0)
    assert page.evaluate("gmdsPage.mode.key") == "distortion"
    page.select_option("#map", index=1)
    page.check("input[value=growth]", force=True)
    page.select_option("#map", index=0)
    assert page.evaluate("gmdsPage.mode.key") == "growth", "what was chosen last"


def test_a_vertex_that_is_not_there_is_told_with_those_that_are(page: Any) -> None:
    page.fill("#go-vertex", "99999")
    page.press("#go-vertex", "Enter")
    assert "has no vertex 99999: they are numbered from 0 to 1499." in page.locator("#readout").inner_text()


def test_what_has_no_counterpart_on_the_target_is_grey(running: Any, tmp_path: Path) -> None:
    half = half_animal()
    answer = Correspondence.from_points(half.part, half.true)
    write_report(tmp_path / "half.html", answer)
    page = Visit(running, tmp_path / "half.html").page
    shown = np.array(page.evaluate("Array.from(gmdsPage.colours(1))")).reshape(-1, 3)
    grey = (shown == page_data(tmp_path / "half.html")["missing"]).all(axis=1)
    assert np.array_equal(grey, ~answer.covered) and 0.3 < grey.mean() < 0.6


def test_large_surfaces_are_drawn_as_copies_and_answer_at_once(running: Any, tmp_path: Path) -> None:
    """More vertices a side than are drawn: copies are, and the page says so; those of 50,000 have as many vertices."""
    mesh = subdivided(quadruped(n_vertices=3_100))
    assert mesh.n_vertices > MOST_VERTICES
    identity = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    answer = Correspondence.from_points(mesh, identity, distortion=np.linspace(0, 1, mesh.n_vertices))
    write_report(tmp_path / "large.html", answer)
    assert (tmp_path / "large.html").stat().st_size < 3e6
    page = Visit(running, tmp_path / "large.html").page
    assert "vertices, drawn with" in page.locator("#panel-0 h2").inner_text()
    quickest = page.evaluate("""() => {
        const scene = gmdsPage.scenes[0];
        return Math.min(...Array.from({length: 20}, (_, i) => {
            const start = performance.now();
            gmdsPage.mark({side: 0, vertex: scene.vertexAt(150 + 8 * i, 200) + 1});
            return performance.now() - start;
        }));
    }""")
    assert quickest < 100  # ms; 6 on a slow processor


def test_figures_and_curve_are_those_of_the_candidate_shown(
    answer: Correspondence, running: Any, tmp_path: Path
) -> None:
    errors = np.stack([np.linspace(0, 0.1, 1500), np.linspace(0.1, 0.9, 1500)])
    write_report(tmp_path / "both.html", answer, errors=errors)
    page = Visit(running, tmp_path / "both.html").page
    widths = "() => [...document.querySelectorAll('#curve polyline')].map((line) => 1 + 2 * line.matches('.chosen'))"
    assert "5.00\nmean error x100" in page.locator("#cards").inner_text() and page.evaluate(widths) == [3, 1]
    page.select_option("#map", index=1)
    assert page.evaluate(widths) == [1, 3]
    assert "50.00\nmean error x100" in page.locator("#cards").inner_text()
    assert "50.00" in page.locator("#facts").inner_text() and page.locator("#badge").inner_text() == "Candidate"


def test_a_link_brings_back_what_was_shown(running: Any, file: Path) -> None:
    page = Visit(running, file).page
    page.select_option("#map", index=1)
    page.select_option("#beside", value="0")
    page.fill("#go-vertex", "12")
    page.click("#go button")
    page.click("[data-side=top]")
    page.click("#copy-link")
    page.wait_for_function("() => /Copied|address/.test(at('copy-link').textContent)")
    shown = page.evaluate("stateOf(gmdsPage)")
    page.goto(f"{file.as_uri()}#{shown}")
    page.reload()
    page.wait_for_selector("body[data-ready]")
    assert page.evaluate("stateOf(gmdsPage)") == shown and "map=1" in shown and "0.12" in shown
    assert page.locator("#panel-2").is_visible()
    page.goto(f"{file.as_uri()}#map=nonsense&pins=7.9,0.99999999&look=1,2;&beside=77&morph=x")
    page.reload()
    page.wait_for_selector("body[data-ready=yes]")
    assert page.evaluate("gmdsPage.pins.length") == 0


def test_the_readout_is_in_view_on_a_laptop_while_pointing(running: Any, file: Path) -> None:
    page = Visit(running, file, width=1366, height=650).page  # what a browser leaves of 768
    for mode in ("match", "distortion", "error"):
        page.check(f"input[value={mode}]", force=True)
        box = page.locator("#readout").bounding_box()
        assert box["y"] + box["height"] <= 650
        before = page.locator("#stage").bounding_box()
        left, top, width, height = camera_of(page, 0)["box"]
        page.mouse.move(left + 0.45 * width, top + 0.5 * height)
        assert page.locator("#stage").bounding_box() == before, "nothing jumps"


def test_names_of_landmarks_stand_outside_and_within_the_panel(
    answer: Correspondence, running: Any, tmp_path: Path
) -> None:
    """From wherever it is looked at, in a narrow window as well; the tip of the tail has its name outside."""
    source, target = answer.source.vertices, answer.points.positions
    tips = [source[:, 0].argmin(), source[:, 0].argmax(), source[:, 2].argmax()]
    given = [(name, source[i], target[i]) for name, i in zip(("tail", "nose", "tip of the ear"), tips, strict=True)]
    write_report(tmp_path / "named.html", answer, landmarks=given)
    page = Visit(running, tmp_path / "named.html", width=390, height=800).page
    for look in ("front", "left", "back"):
        page.click(f"[data-side={look}]")
        page.evaluate("() => new Promise((done) => setTimeout(done, 200))")
        shown = page.locator("#labels .label")
        assert shown.count() == 6
        for label in shown.all():
            panel = page.locator(f"#panel-{label.get_attribute('data-panel')} .plot").bounding_box()
            text = label.locator("text").bounding_box()
            assert panel["x"] <= text["x"] and text["x"] + text["width"] <= panel["x"] + panel["width"]
    page.click("[data-side=front]")
    page.evaluate("() => new Promise((done) => setTimeout(done, 200))")
    tail, nose = (page.locator(f"#labels [data-landmark='{i}'][data-panel='0']") for i in (0, 1))
    left, right = sorted((tail, nose), key=lambda one: one.locator("path").bounding_box()["x"])
    assert (left.locator("text").get_attribute("text-anchor"), right.locator("text").get_attribute("text-anchor")) == (
        "end",
        None,
    )


def test_without_webgl_the_page_says_so(running: Any, file: Path) -> None:
    context = running.new_context(offline=True)
    page = context.new_page()
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto(file.as_uri())
    page.wait_for_selector("body[data-ready=no]")
    told = page.locator("#trouble").inner_text()
    assert "cannot draw in 3-D" in told and "can still be read" in told and page.locator("#facts tr").count() > 3
    context.close()


def test_every_term_has_a_mark_that_says_what_it_means(page: Any) -> None:
    page.select_option("#map", index=1)
    meant = [mark.get_attribute("title") for mark in page.locator(".cards abbr, .status abbr").all()]
    assert {WORDS[word] for word in ("status", "stress", "orientation")} <= set(meant)
    page.select_option("#map", index=0)
    meant = [mark.get_attribute("title") for mark in page.locator(".cards abbr").all()]
    assert WORDS["distortion"] in meant and WORDS["error"] in meant
    page.check("input[value=distortion]", force=True)
    mark = page.locator("#legend-label abbr")
    assert mark.get_attribute("title").startswith(WORDS["distortion"])
    mark.focus()  # as a finger or the Tab key does, where nothing hovers
    shown = "(mark) => getComputedStyle(mark, '::after').content"
    assert WORDS["distortion"][:40] in mark.evaluate(shown)


def test_a_length_and_the_axes_of_the_file_are_drawn(answer: Correspondence, page: Any, file: Path) -> None:
    """The ruler is as long as it says where the middle of the view is, in units of the file."""
    axes = page.locator("#triads .triad").first
    assert axes.locator("text").all_text_contents()[:3] == ["x", "y", "z"]
    length, pixels = page.evaluate(
        """() => { const ruler = document.querySelector('#triads .triad .ruler');
        return [Number(ruler.parentNode.querySelector('text').textContent), ruler.getBBox().width]; }"""
    )
    camera = camera_of(page, 0)
    away = np.linalg.norm([camera["eye"][axis] - camera["center"][axis] for axis in "xyz"])
    size = page_data(file)["surfaces"][0]["unit"]
    focal = camera["box"][3] / 2 / np.tan(np.pi / 8)
    assert length > 0 and pixels == pytest.approx(length / size * focal / away, rel=1e-3)


def test_the_picture_of_the_page_has_all_panels(page: Any) -> None:
    from io import BytesIO

    from matplotlib.image import imread

    with page.expect_download() as offered:
        page.click("#save-view")
    image = imread(BytesIO(Path(offered.value.path()).read_bytes()))[..., :3]
    halves = np.array_split(image, 2, axis=1)
    assert image.shape[1] > 1.5 * image.shape[0] and all(
        np.unique(half.reshape(-1, 3), axis=0).shape[0] > 500 for half in halves
    )


def test_the_picture_of_the_page_says_what_its_colours_stand_for(page: Any, file: Path) -> None:
    """Every colour of the scale is in the lower line, and the names of the surfaces are above them."""
    from io import BytesIO

    from matplotlib.image import imread

    page.check("input[value=distortion]", force=True)
    with page.expect_download() as offered:
        page.click("#save-view")
    image = np.round(255 * imread(BytesIO(Path(offered.value.path()).read_bytes()))[..., :3]).astype(int)
    ramp = np.asarray(page_data(file)["ramp"]).reshape(-1, 3)
    lower, upper = image[-26:].reshape(-1, 3), image[:26].reshape(-1, 3)
    there = [np.abs(lower - colour).sum(axis=1).min() <= 6 for colour in ramp[4:-4:8].astype(int)]
    assert all(there) and len(np.unique(upper, axis=0)) > 10


def test_the_picture_of_the_page_shows_what_is_marked(page: Any) -> None:
    """Pins are in it where they are on the page; so are axes and the scale, which are always there."""
    from io import BytesIO

    from matplotlib.image import imread

    def saved() -> np.ndarray:
        with page.expect_download() as offered:
            page.click("#save-view")
        return imread(BytesIO(Path(offered.value.path()).read_bytes()))[..., :3]

    before = saved()
    page.evaluate("gmdsPage.pin({ side: 0, vertex: 151 })")
    changed = np.abs(saved() - before).max(axis=2) > 0.2
    rows, columns = np.nonzero(changed)
    half = before.shape[1] // 2
    spots = page.evaluate("""() => [0, 1].map((side) => {
        const scene = gmdsPage.scenes[side], partner = gmdsPage.partner(0, 151);
        const place = scene.place(side ? partner.position : scene.vertex(151));
        return [place.x * scene.canvas.width / scene.plot.clientWidth + side * gmdsPage.scenes[0].canvas.width,
            (place.y + 26) * scene.canvas.height / scene.plot.clientHeight];
    })""")
    for side, (x, y) in enumerate(spots):
        mine = columns >= half if side else columns < half
        assert mine.any() and abs(columns[mine].mean() - x) < 4 and abs(rows[mine].mean() - y) < 4
        assert np.hypot(columns[mine] - x, rows[mine] - y).max() < 14
    corner = before[-86:-26, 20:100]  # above the line about the colours: the axes, on the paper of the panel
    assert len(np.unique((255 * corner).astype(int).reshape(-1, 3), axis=0)) > 10


def test_errors_have_two_fixed_scales(page: Any) -> None:
    page.check("input[value=distortion]", force=True)
    assert not page.locator("#fine").is_visible()
    page.check("input[value=error]", force=True)
    assert page.locator("#high").inner_text() == "0.25"
    page.check("#fine")
    assert page.locator("#high").inner_text() == "0.1 and more"
    assert "0.1" in page.locator("#histogram").inner_text()
    page.uncheck("#fine")
    assert page.locator("#high").inner_text() == "0.25"


def test_few_true_points_are_dots_and_print_crops_nothing(answer: Correspondence, running: Any, tmp_path: Path) -> None:
    errors = np.full(1500, np.nan)
    errors[::100] = 0.1
    write_report(tmp_path / "few.html", answer, errors=errors)
    page = Visit(running, tmp_path / "few.html").page
    assert page.evaluate("gmdsPage.scenes[0].painter.dots") == 0
    page.check("input[value=error]", force=True)
    assert page.evaluate("gmdsPage.scenes[0].painter.dots") == 15
    is_grey = "(side) => gmdsPage.colours(side).every((c, i) => c === gmdsPage.data.missing[i % 3])"
    grey = page.evaluate(f"[0, 1].map({is_grey})")
    assert grey == [True, True], "nothing is known between the dots"
    page.evaluate("gmdsPage.pin({ side: 0, vertex: 151 })")
    assert "Error at the nearest known point 0.100" in page.locator("#readout").inner_text()
    assert page.evaluate("getComputedStyle(gmdsPage.scenes[0].plot).touchAction") == "pan-y", "a finger scrolls"
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 760, "height": 1100})  # a sheet of A4
    assert page.evaluate("document.documentElement.scrollWidth") <= 760
    boxes = [page.locator(f"#panel-{side}").bounding_box() for side in (0, 1)]
    assert all(box["x"] >= 0 and box["x"] + box["width"] <= 760 and box["height"] > 250 for box in boxes)
    assert page.locator("#map").is_visible() and not page.locator("#go").is_visible()


def test_the_source_becomes_the_target(answer: Correspondence, running: Any, file: Path) -> None:
    page = Visit(running, file).page
    page.evaluate("() => { at('morph').value = 1; at('morph').dispatchEvent(new Event('input')); }")
    shown = np.array(page.evaluate("Array.from(gmdsPage.scenes[0].positions)")).reshape(-1, 3)
    goal = page_data(file)["maps"][0]["there"]["position"].reshape(-1, 3) / 65535 - 0.5
    assert np.allclose(shown, goal, atol=1e-5)
