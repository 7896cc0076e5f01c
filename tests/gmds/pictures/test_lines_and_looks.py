"""Isolines, borders of labels, textures, colours about zero, bars that say what they show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import icosphere, rectangle

from geodesics import Mesh, write_mesh
from gmds import Correspondence
from gmds.cli.looks_drawn import draw_values
from gmds.pictures.camera import broadside
from gmds.pictures.colours import MISSING, diverging_colours, label_colours
from gmds.pictures.figure import Panel, composed
from gmds.pictures.lines import borders, isolines, round_levels, with_lines
from gmds.pictures.panels import map_panels
from gmds.pictures.software import Shot, software
from gmds.pictures.textured import textured
from gmds.pictures.values import LINE, write_values
from gmds.shapes import quadruped, truth


def test_isolines_of_the_height_of_a_sphere_are_circles() -> None:
    sphere = icosphere(4)
    for level in (-0.5, 0.3, 0.9):
        segments = isolines(sphere, sphere.vertices[:, 2], [level])
        assert np.allclose(segments[..., 2], level)
        length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum()
        assert length == pytest.approx(2 * np.pi * np.sqrt(1 - level**2), rel=0.01)
    assert len(isolines(sphere, np.full(sphere.n_vertices, np.nan), [0.0])) == 0
    assert len(isolines(sphere, np.zeros(sphere.n_vertices), [0.0])) == 0


@pytest.mark.parametrize(("low", "high"), [(0, 2.07), (-3.1, 4), (0, 1e-9), (1e6, 1e6 + 7), (0, 0.95)])
def test_levels_are_round_and_about_a_dozen(low: float, high: float) -> None:
    levels = round_levels(low, high)
    assert 5 <= len(levels) <= 13 and low < levels.min() and levels.max() < high
    step = np.diff(levels).mean()
    assert round(step / 10 ** np.floor(np.log10(step * 1.001)), 6) in (1, 2, 5)
    assert np.allclose(levels / step, np.rint(levels / step))
    assert len(round_levels(2.0, 2.0)) == 0


def test_borders_go_between_labels_alone() -> None:
    square = rectangle(10, 10)
    assert len(borders(square, np.zeros(square.n_vertices))) == 0
    x = square.vertices[:, 0]
    segments = borders(square, (x > np.median(x)).astype(int))
    ends = segments.reshape(-1, 3)[:, 0]
    step = np.unique(x)[1] - np.unique(x)[0]
    assert len(segments) and np.abs(ends - np.median(x)).max() <= step


def test_lines_are_seen_in_either_picture_of_values(tmp_path: Path) -> None:
    sphere, shots = icosphere(3), []

    def keep(given: Sequence[Shot]) -> list[np.ndarray]:
        shots.extend(given)
        return software(given)

    z = sphere.vertices[:, 2]
    write_values(tmp_path / "a.png", [("a", sphere, z)], isolines=True, pixels=80, renderer=keep)
    write_values(tmp_path / "b.png", [("b", sphere, z > 0)], labels=True, pixels=80, renderer=keep)
    for shot in shots:
        added = shot.colours[sphere.n_vertices :]
        assert len(added) > 100 and np.allclose(added, LINE)
    shape, colours = with_lines(sphere, np.ones((sphere.n_vertices, 3)), np.zeros((2, 2, 3)), LINE)
    assert shape.n_vertices == len(colours) == sphere.n_vertices, "a line without length is left out"


def test_colours_about_zero_are_white_there_and_differ_on_either_side() -> None:
    values = np.array([-2, -1, -0.5, 0, 0.5, 1, np.nan])
    colours = diverging_colours(values, 1.0)
    assert colours.min() >= 0 and colours.max() <= 1 and np.ptp(colours[3]) < 0.02 and colours[3].min() > 0.93
    assert np.allclose(colours[0], colours[1]) and np.allclose(colours[6], MISSING)
    light = colours @ [0.2126, 0.7152, 0.0722]
    assert light[1] == pytest.approx(light[5], abs=0.12) and light[1] < light[2] < light[3] > light[4] > light[5]
    seen = np.stack([0.6 * colours[:, 0] + 0.4 * colours[:, 1], colours[:, 2]], axis=1)  # red and green seen as one
    assert np.linalg.norm(seen[1] - seen[5]) > 0.5


def test_bars_say_what_they_show_and_growth_has_zero_in_the_middle() -> None:
    pytest.importorskip("matplotlib")
    source, target = quadruped(n_vertices=200), quadruped(head_scale=2, n_vertices=200)
    answer = Correspondence.from_points(source, truth(source, target))
    panel = map_panels(replace(answer, confidence=np.full(200, 0.5)), pixels=60, show="growth")[2]
    assert panel.signed and panel.limits is not None and panel.limits[0] == -panel.limits[1] < 0
    assert "length" in panel.label
    figure = composed([panel], software([panel.shot]))
    assert panel.label in [axis.get_ylabel() for axis in figure.axes]


def test_a_texture_lies_where_its_coordinates_say() -> None:
    image_of = pytest.importorskip("PIL.Image").fromarray
    square = Mesh([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], [[0, 1, 2], [0, 2, 3]])
    corners = square.vertices[square.faces][..., [0, 2]] * 0.98 + 0.01
    pixels = np.zeros((2, 2, 3), dtype=np.uint8)
    pixels[0, 0], pixels[0, 1], pixels[1, 0], pixels[1, 1] = [255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0]
    shot = textured(square, corners, image_of(pixels), broadside(square), 60)
    x, z = shot.mesh.vertices[:, 0], shot.mesh.vertices[:, 2]
    for (right, top), colour in {
        (False, True): (1, 0, 0), (True, True): (0, 1, 0), (False, False): (0, 0, 1), (True, False): (1, 1, 0),
    }.items():  # fmt: skip
        there = ((x > 0.55) if right else (x < 0.45)) & ((z > 0.55) if top else (z < 0.45))
        assert there.any() and np.allclose(shot.colours[there], colour)
    corners[0] = np.nan
    grey = (textured(square, corners, image_of(pixels), broadside(square), 60).colours == MISSING).all(axis=1)
    assert grey.mean() == pytest.approx(0.5)


def test_all_bones_are_shown_and_the_target_from_the_side_of_the_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source, target = quadruped(n_vertices=200), quadruped("walk", n_vertices=210, seed=1)
    lying = Mesh(target.vertices @ np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]), target.faces)  # -y is up
    true = truth(source, target)
    answer = Correspondence.from_points(source, type(true)(lying, true.face, true.barycentric))
    bones = np.eye(4)[np.arange(210) % 4]
    kept = {}
    monkeypatch.setattr("gmds.pictures.values.write_panels", lambda path, panels, *_: kept.update(panels=panels) or "")
    draw_values(tmp_path / "a.png", answer, (0, 0, 1), "weights", (bones, bones[:200]))
    panels: list[Panel] = kept["panels"]
    assert np.allclose(panels[0].shot.colours, label_colours(np.arange(4))[np.arange(210) % 4])
    ups = [panel.shot.rotation[1] for panel in panels]
    assert ups[1] @ [0, 0, 1] > 0.9 and ups[0] @ [0, -1, 0] > 0.9


def test_a_file_with_y_up_is_drawn_upright(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from click.testing import CliRunner

    from gmds.cli import main

    ways = []

    def kept(path: Path, surfaces: list, *, up: tuple, **_: object) -> str:
        ways.append(up)
        return ""

    monkeypatch.setattr("gmds.pictures.values.write_values", kept)
    for name in ("ball.obj", "ball.glb", "ball.ply"):
        write_mesh(icosphere(1), tmp_path / name)
        args = ["distances", str(tmp_path / name), "--from", "0", "-o", str(tmp_path / "d.npz")]
        result = CliRunner().invoke(main, [*args, "--picture", str(tmp_path / "d.png")])
        assert result.exit_code == 0, result.output
    assert ways == [(0, 1, 0), (0, 1, 0), (0, 0, 1)]


def test_rows_of_views_share_a_bar(tmp_path: Path) -> None:
    """Four views, two a row: a bar a row."""
    ball = icosphere(1)
    along = ball.vertices[:, 2]
    shots: list[Shot] = []
    drawn: dict[str, list[Panel]] = {}

    def renderer(given: Sequence[Shot]) -> list[np.ndarray]:
        shots.extend(given)
        return software(given)

    write_values(tmp_path / "a.png", [(name, ball, along) for name in "abcd"], pixels=60, columns=2, renderer=renderer)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gmds.pictures.values.write_panels", lambda _, panels, *__: drawn.update(panels=panels) or "")
        write_values(tmp_path / "b.png", [(name, ball, along) for name in "abcd"], label="height", pixels=60)
        same = drawn["panels"]
    assert len(shots) == 4
    row, square = (composed(same, software([panel.shot for panel in same]), "", columns) for columns in (None, 2))
    bars = [sum(axis.get_ylabel() == "height" for axis in figure.axes) for figure in (row, square)]
    assert bars == [1, 2], "neighbours with the same scale have one bar"
    assert row.get_size_inches()[0] > 1.5 * square.get_size_inches()[0]
    assert square.get_size_inches()[1] == pytest.approx(2 * row.get_size_inches()[1])


def test_signed_values_and_others_have_a_range_each(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ball, kept = icosphere(1), {}
    height = ball.vertices[:, 2]
    monkeypatch.setattr("gmds.pictures.values.write_panels", lambda _, panels, *__: kept.update(panels=panels) or "")
    write_values(tmp_path / "b.png", [("a", ball, 0.5 * height), ("b", ball, height**2 + 1)], signed=[True, False])
    first, second = kept["panels"]
    assert first.limits == pytest.approx((-0.5, 0.5)) and first.signed
    assert second.limits == pytest.approx((1 + (height**2).min(), 2)) and not second.signed
