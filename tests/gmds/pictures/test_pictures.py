"""Pictures without a screen: corresponding points look alike, what is near hides what is behind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import drawing_process
import numpy as np
import pytest
from generated_shapes import ellipsoid, icosphere, moved, rectangle, tetrahedron

import gmds.pictures.offscreen
from geodesics import Mesh, SurfacePoints
from gmds import Correspondence
from gmds.cli.fields import PICTURES
from gmds.errors import PictureFormat, RenderingError
from gmds.landmarks.checking import place_landmarks
from gmds.pictures.camera import alignment, broadside
from gmds.pictures.colours import BARE, MISSING, css, label_colours, position_colours, value_colours
from gmds.pictures.figure import FORMATS
from gmds.pictures.judgement import judgement
from gmds.pictures.named import AWAY, HIGH, LETTER, Box, Mark, free_place
from gmds.pictures.offscreen import offscreen
from gmds.pictures.panels import map_panels, write_picture
from gmds.pictures.scales import TOPS, beyond, range_of
from gmds.pictures.software import Shot, render, software, view_rotation
from gmds.pictures.values import INK, write_values
from gmds.report.modes import modes
from gmds.shapes import quadruped, truth


@pytest.fixture(scope="module")
def answer() -> Correspondence:
    source, target = quadruped(n_vertices=500), quadruped("walk", head_scale=2, n_vertices=600, seed=1)
    valid, distortion = np.arange(500) % 50 > 0, np.linspace(0, 0.3, 500)
    return Correspondence.from_points(source, truth(source, target), valid=valid, distortion=distortion)


def test_writing_into_a_missing_folder_raises(answer: Correspondence, tmp_path: Path) -> None:
    with pytest.raises(OSError, match="nowhere"):
        write_picture(tmp_path / "nowhere" / "x.png", answer, pixels=60, renderer=software)


def test_maps_without_any_counterpart_and_errors_without_numbers_can_be_shown(tmp_path: Path) -> None:
    shape = tetrahedron()
    answer = Correspondence.from_points(
        shape, SurfacePoints.at_vertices(shape, [0, 1, 2, 3]), valid=np.zeros(4, dtype=bool)
    )
    write_picture(tmp_path / "out.png", answer, errors=np.full(4, np.nan), renderer=software)
    with pytest.raises(ValueError, match="each of the 4 vertices"):
        write_picture(tmp_path / "out.png", answer, errors=np.zeros(3))
    with pytest.raises(ValueError, match="each of the 4 vertices"):
        write_values(tmp_path / "out.png", [("short", shape, [1.0])])


def test_the_ending_names_the_format(answer: Correspondence, tmp_path: Path) -> None:
    begins = {".png": b"\x89PNG", ".jpg": b"\xff\xd8\xff", ".jpeg": b"\xff\xd8\xff", ".svg": b"<?xml", ".pdf": b"%PDF"}
    assert set(begins) == set(FORMATS) == set(PICTURES)
    for ending, first in begins.items():
        twice = [tmp_path / f"{name}{ending}" for name in "ab"]
        for path in twice:
            write_picture(path, answer, pixels=60, renderer=software, names=("<a>", "&b"))
        assert twice[0].read_bytes() == twice[1].read_bytes() and twice[0].read_bytes().startswith(first)
    assert "&lt;a&gt;" in (tmp_path / "a.svg").read_text()
    for name in ("map.tif", "map"):
        with pytest.raises(PictureFormat, match=r"E218.*map.*\.png, \.jpg"):
            write_picture(tmp_path / name, answer)
    assert not list(tmp_path.glob("map*"))


def test_both_renderers_draw_the_same(answer: Correspondence, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gmds.pictures.offscreen, "_run", drawing_process.ALONE)
    colours = position_colours(answer.target.vertices)
    labels = label_colours(np.arange(answer.target.n_vertices) // 50)
    view = broadside(answer.target)
    shots = [Shot(answer.target, colours, view, 160), Shot(answer.target, labels, view, 160, sharp=True)]
    try:
        theirs = offscreen(shots)
    except RenderingError as error:
        pytest.skip(str(error))
    for own, other in zip(software(shots), theirs, strict=True):
        assert own.shape == other.shape and other.max() <= 1
        drawn = [(image.min(axis=2) < 0.99) for image in (own, other)]
        assert (drawn[0] != drawn[1]).mean() < 0.02, "the same outline"
        both = drawn[0] & drawn[1]
        hues = [image[both] / np.linalg.norm(image[both], axis=1, keepdims=True) for image in (own, other)]
        assert np.quantile((hues[0] * hues[1]).sum(axis=1), 0.1) > 0.98, "the same colours, but for the light"


WORKERS = {
    "import os; os.abort()": "signal 6",
    "import sys; sys.stderr.write('bad X server connection'); sys.exit(3)": "exit code 3: bad X server connection",
    "import time; time.sleep(60)": "did not draw within 1 s",
    "pass": "drew nothing",
}


@pytest.mark.parametrize("code", WORKERS)
def test_a_driver_that_fails_is_told_and_the_picture_drawn_all_the_same(
    answer: Correspondence, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str
) -> None:
    (tmp_path / "worker.py").write_text(code)
    monkeypatch.setattr(gmds.pictures.offscreen, "WORKER", tmp_path / "worker.py")
    monkeypatch.setattr(gmds.pictures.offscreen, "PATIENCE", 1 if "sleep" in code else 60)
    monkeypatch.setattr(gmds.pictures.offscreen, "_installed", lambda: True)
    why = answer.picture(tmp_path / "map.png", pixels=60)
    assert WORKERS[code] in why and "E510" in why and (tmp_path / "map.png").exists()
    with pytest.raises(RenderingError, match=WORKERS[code]):
        answer.picture(tmp_path / "other.png", pixels=60, renderer=offscreen)
    assert not (tmp_path / "other.png").exists()


def test_without_pyvista_the_picture_is_drawn_and_the_extra_named(
    answer: Correspondence, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gmds.pictures.offscreen, "_installed", lambda: False)
    assert "pip install 'matplotlib>=3.8'" in answer.picture(tmp_path / "map.png", pixels=60)
    assert (tmp_path / "map.png").exists()


def test_a_truth_that_is_known_at_few_points_is_drawn_as_balls(answer: Correspondence) -> None:
    errors = np.full(500, np.nan)
    errors[[3, 400]] = 0.1, 0.2
    panel = map_panels(answer, errors)[2]
    balls, colours = panel.shot.mesh.vertices[500:].reshape(2, -1, 3), panel.shot.colours[500:].reshape(2, -1, 3)
    assert panel.caption == "error" and panel.label == "error / √area"
    assert (panel.shot.colours[:500] == BARE).all() and np.ptp(colours, axis=1).max() == 0
    assert np.allclose(balls.mean(axis=1), answer.source.vertices[[3, 400]])
    assert not np.allclose(colours[0, 0], colours[1, 0])
    most = np.where(np.arange(500) % 3 > 0, 0.1, np.nan)
    assert map_panels(answer, most)[2].shot.mesh.n_vertices == 500, "as many as most vertices are a surface"


def pixels_of(path: Path) -> np.ndarray:
    from matplotlib.image import imread

    assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    return imread(path)[:, :, :3]


def test_the_picture_shows_source_target_and_errors(answer: Correspondence, tmp_path: Path) -> None:
    plain = Correspondence.from_points(answer.source, answer.points)
    write_picture(tmp_path / "two.png", plain, pixels=150, renderer=software)
    write_picture(
        tmp_path / "three.png", answer, errors=np.linspace(0, 1, 500), title="$x <b>", pixels=150, renderer=software
    )
    two, three = pixels_of(tmp_path / "two.png"), pixels_of(tmp_path / "three.png")
    assert three.shape[1] > 1.3 * two.shape[1]
    assert 0.1 < (two.min(axis=2) < 0.98).mean() < 0.9


def test_values_and_labels_make_pictures(tmp_path: Path) -> None:
    sphere = icosphere(2)
    z = np.where(np.arange(sphere.n_vertices) == 0, np.inf, sphere.vertices[:, 2])
    write_values(
        tmp_path / "values.png",
        [("height", sphere, z), ("flat", rectangle(3, 3), np.zeros(16))],
        pixels=120,
        renderer=software,
    )
    write_values(
        tmp_path / "labels.png", [("sign", sphere, np.sign(z).astype(int))], labels=True, pixels=120, renderer=software
    )
    assert pixels_of(tmp_path / "values.png").size and pixels_of(tmp_path / "labels.png").size


def test_pictures_repeat_byte_for_byte(answer: Correspondence, tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        write_picture(tmp_path / name, answer, pixels=100)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_sphere_seen_from_anywhere_is_a_disc_of_the_right_size() -> None:
    sphere = icosphere(4)
    for azimuth, elevation in ((0, 0), (50, 30)):
        black = render(sphere, np.zeros((sphere.n_vertices, 3)), rotation=view_rotation(azimuth, elevation), pixels=200)
        assert (1 - black).mean(axis=2).sum() == pytest.approx(np.pi * (0.47 * 200) ** 2, rel=0.02)


def test_what_is_nearer_hides_what_is_behind() -> None:
    near, far = [[1, -1, -1], [1, 1, -1], [1, 0, 1]], [[0, -1, -1], [0, 1, -1], [0, 0, 1]]
    colours = np.repeat([[1.0, 0, 0], [0, 0, 1.0]], 3, axis=0)
    for vertices, own in ((near + far, colours), (far + near, colours[::-1])):
        mesh = Mesh(vertices, [[0, 1, 2], [3, 4, 5]])
        image = render(mesh, own, rotation=view_rotation(0, 0), pixels=60)
        red, _, blue = image[30, image.shape[1] // 2]
        assert red > 0.5 and blue < 0.1


def test_covered_pixels_are_those_whose_centre_is_in_a_triangle() -> None:
    """A naive twin: each pixel's centre is tested against each triangle in turn."""
    mesh, rotation = tetrahedron(), view_rotation(20, 35)
    colours = np.eye(4)[:, :3]
    image = render(mesh, colours, rotation=rotation, pixels=40, oversampling=1)
    camera = mesh.vertices @ rotation.T
    span = np.ptp(camera[:, :2], axis=0)
    scale = 0.94 * 40 / span.max()
    height, width = image.shape[:2]
    centre = (camera[:, :2].min(0) + camera[:, :2].max(0)) / 2
    xy = (camera[:, :2] - centre) * scale * [1, -1] + [width / 2, height / 2]
    covered = np.zeros((height, width), dtype=bool)
    for row, column in np.ndindex(height, width):
        for face in mesh.faces:
            system = np.vstack([xy[face].T, np.ones(3)])
            weights = np.linalg.solve(system, [column + 0.5, row + 0.5, 1])
            covered[row, column] |= bool((weights >= -1e-9).all())
    assert np.array_equal(covered, image.min(axis=2) < 1)


def test_the_target_is_turned_to_be_seen_from_the_same_side() -> None:
    shape = ellipsoid(2)
    turned = moved(shape, scale=7.0, seed=5)
    answer = Correspondence.from_points(shape, SurfacePoints.at_vertices(turned, np.arange(turned.n_vertices)))
    back = (turned.vertices - turned.vertices.mean(0)) @ alignment(answer).T / 7
    assert np.allclose(back, shape.vertices - shape.vertices.mean(0), atol=1e-9)


def test_cameras_are_rotations_even_for_odd_shapes() -> None:
    needle = Mesh([[0, 0, 0], [1e-6, 0, 1], [0, 0, 2.5]], [[0, 1, 2]])
    for mesh in (icosphere(1), rectangle(2, 2), needle):
        for up in ((0, 0, 1), (0, 1, 0), (1, 2, 3)):
            r = broadside(mesh, up)
            assert np.allclose(r @ r.T, np.eye(3), atol=1e-9) and np.linalg.det(r) == pytest.approx(1)
            assert (r @ up)[1] > 0  # up is up


def test_colours_stay_in_range_and_missing_values_are_grey() -> None:
    for colours in (
        position_colours(icosphere(2).vertices),
        position_colours(np.zeros((4, 3))),
        value_colours([0, 1, np.nan, np.inf, -5], 0, 1),
        value_colours([2.0, 2.0], 2, 2),
        label_colours(np.arange(-1, 40)),
    ):
        assert np.isfinite(colours).all() and colours.min() >= 0 and colours.max() <= 1
    assert len(np.unique(label_colours(np.arange(40)).round(3), axis=0)) == 40
    grey = value_colours([np.nan], 0, 1)[0]
    assert np.ptp(grey) == 0
    assert css([[1, 0.5, 0], [2, -1, 0]]) == ["#ff8000", "#ff0000"]


def test_value_colours_grow_lighter_so_that_grey_prints_read() -> None:
    light = value_colours(np.linspace(0, 1, 50), 0, 1) @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(light) > 0).all()


DEUTAN = [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
PROTAN = [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]


CONES = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
]
OKLAB = [
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
]


@pytest.mark.parametrize("eyes", [np.eye(3), DEUTAN, PROTAN])  # in linear light; Machado, Oliveira, Fernandes 2009
def test_the_four_feet_have_four_colours(eyes: object) -> None:
    """Also while it walks, and as three kinds of eyes see them: 0.08 in OKLab, four times what is just seen."""
    animal = quadruped("walk", n_vertices=500)
    colours = position_colours(animal.vertices)
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    seen = np.cbrt((linear @ np.transpose(eyes)).clip(0, 1) @ np.transpose(CONES)) @ np.transpose(OKLAB)
    x, y, z = animal.vertices.T
    low, fore = z < z.min() + 0.1 * np.ptp(z), x > np.median(x[z < z.min() + 0.1 * np.ptp(z)])
    feet = [seen[low & (fore == f) & ((y > 0) == s)].mean(axis=0) for f in (True, False) for s in (True, False)]
    assert min(np.linalg.norm(a - b) for i, a in enumerate(feet) for b in feet[:i]) > 0.08


def test_left_and_right_differ_for_eyes_without_red_or_green() -> None:
    """Positions mirrored across the shape must differ once red and green are seen as one."""
    animal = quadruped(n_vertices=500)
    colours = position_colours(animal.vertices)
    seen = np.stack([0.6 * colours[:, 0] + 0.4 * colours[:, 1], colours[:, 2]], axis=1)
    limbs = [np.flatnonzero((animal.vertices[:, 2] < 0.5) & (s * animal.vertices[:, 1] > 0)) for s in (1, -1)]
    left, right = (seen[limb].mean(axis=0) for limb in limbs)
    assert np.linalg.norm(left - right) > 0.1


def test_what_has_no_counterpart_is_grey_on_both_surfaces(answer: Correspondence) -> None:
    front = answer.source.vertices[:, 0] > 0
    here, there, _ = map_panels(replace(answer, valid=front), pixels=60)
    gone = (there.shot.colours == MISSING).all(axis=1)
    covered = replace(answer, valid=front).covered
    assert np.array_equal((here.shot.colours == MISSING).all(axis=1), ~front)
    assert np.array_equal(gone, ~covered) and 0.2 < gone.mean() < 0.8
    assert not (map_panels(identity(answer.target), pixels=60)[1].shot.colours == MISSING).all(axis=1).any()


def identity(mesh: Mesh) -> Correspondence:
    return Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))


def test_names_do_not_stand_on_each_other() -> None:
    """A name alone is above its point on the outer side; of a crowd each has a place of its own."""
    left, box = free_place(Mark("LM4", 220, 50), 400, [])
    assert not left and box == (220 + AWAY, 50 - AWAY - HIGH, 220 + AWAY + 3 * LETTER, 50 - AWAY)
    taken: list[Box] = []
    for k in range(8):
        taken.append(free_place(Mark(f"LM{k}", 200 + 5 * k, 60 + 2 * k), 400, taken)[1])
    for i, one in enumerate(taken):
        for other in taken[:i]:
            assert one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]


def test_names_stand_within_the_view_also_where_letters_are_large() -> None:
    """On a sheet letters are larger beside the view: of a crowd at its edge each name is whole, in its own place."""
    taken: list[Box] = []
    for k in range(6):
        taken.append(free_place(Mark(f"LM {k}", 560 - 9 * k, 100 + 3 * k), 560, taken, 1.2)[1])
    for i, one in enumerate(taken):
        assert one[0] >= 0 and one[2] <= 560 and one[2] - one[0] == pytest.approx(4 * LETTER * 1.2)
        assert all(a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1] for a in taken[:i] for b in [one])


def test_marked_vertices_get_a_ball_where_they_can_be_seen(tmp_path: Path) -> None:
    sphere = icosphere(3)
    shots: list[Shot] = []

    def keep(given: Sequence[Shot]) -> list[np.ndarray]:
        shots.extend(given)
        return software(given)

    values = sphere.vertices[:, 2]
    write_values(tmp_path / "a.png", [("a", sphere, values)], marked=[[0, 7]], renderer=keep)
    shot = shots[0]
    assert shot.mesh.n_vertices == sphere.n_vertices + 12
    balls = shot.mesh.vertices[sphere.n_vertices :].reshape(2, 6, 3)
    assert np.allclose(balls.mean(axis=1), sphere.vertices[[0, 7]])
    assert np.allclose(shot.colours[sphere.n_vertices :], INK)
    assert np.array_equal(shot.colours[: sphere.n_vertices], value_colours(values, values.min(), values.max()))


def test_landmarks_are_balls_with_names_where_they_can_be_seen(answer: Correspondence) -> None:
    """A name stands at the pixel where its ball is drawn; one behind the body has a ball and no name."""
    side = answer.source.vertices[:, 1]
    rows = [int(answer.source.vertices[:, 0].argmax()), int(side.argmax()), int(side.argmin())]
    placed = place_landmarks((np.array(rows), answer.points[rows]), answer.source, answer.target)
    panels = map_panels(replace(placed, names=("nose", "left", "right")).applied(answer)[0], pixels=400)
    for panel, mesh in zip(panels[:2], (answer.source, answer.target), strict=True):
        assert panel.shot.mesh.n_vertices == mesh.n_vertices + 3 * 6
        assert {mark.name for mark in panel.marks} < {"nose", "left", "right"} and len(panel.marks) >= 1
        image = software([panel.shot])[0]
        for _, x, y, _ in panel.marks:
            assert image[int(y), int(x)].max() < 0.3, "the ball is dark"
    assert not panels[2].marks


@pytest.mark.parametrize("scale", [0.01, 1.0])
def test_scales_of_pictures_end_where_those_of_pages_do(scale: float) -> None:
    """Whatever the values are, so that two maps can be compared."""
    mesh = icosphere(1)
    points = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    values = scale * np.linspace(0, 0.9, mesh.n_vertices)
    answer = Correspondence.from_points(mesh, points, distortion=values)
    page = {mode["key"]: mode for mode in modes(list(TOPS))}
    shown = {"distortion": judgement(answer, None, "doubt"), "error": judgement(answer, values, "doubt")}
    shown["growth"] = judgement(answer, None, "growth")
    shown["confidence"] = judgement(replace(answer, confidence=values), None, "doubt")
    for key, one in shown.items():
        high = page[key]["high"]
        assert one.limits == (-high if page[key]["signed"] else 0, high), key


@pytest.mark.parametrize(("largest", "said"), [(0.2, False), (0.25, False), (0.4, True)])
def test_a_bar_says_when_values_go_on_beyond_its_end(largest: float, said: bool, tmp_path: Path) -> None:
    mesh = icosphere(1)
    answer = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))
    write_picture(tmp_path / "errors.svg", answer, np.linspace(0, largest, mesh.n_vertices), pixels=120)
    text = (tmp_path / "errors.svg").read_text(encoding="utf-8")
    assert ("and more" in text) == said and "and less" not in text
    assert beyond(np.array([-1.0, 0.1, np.nan]), range_of("growth")) == (True, False)
