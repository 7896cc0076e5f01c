"""Figures hold what they were given."""

from __future__ import annotations

import pickle
import sys
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

import geodesics
from geodesics.errors import BadArgument, BadShape, MissingExtra

MESH = bumpy_sphere(1)


def test_a_figure_has_the_surface_its_values_and_points() -> None:
    pytest.importorskip("plotly")
    values = MESH.vertices[:, 2].copy()
    values[4] = np.inf
    figure = geodesics.plot(MESH, values, points=[0, 7], title="height")
    surface, points = figure.data
    assert np.array_equal(np.stack([surface.x, surface.y, surface.z], axis=1), MESH.vertices)
    assert np.array_equal(np.stack([surface.i, surface.j, surface.k], axis=1), MESH.faces)
    finite = np.delete(values, 4)
    assert np.array_equal(np.delete(surface.intensity, 4), finite) and surface.intensity[4] == finite.min()
    assert np.allclose(np.stack([points.x, points.y, points.z], axis=1), MESH.vertices[[0, 7]])
    assert figure.layout.title.text == "height" and figure.layout.scene.aspectmode == "data"


def test_paths_are_lines_with_a_gap_between_them_and_the_bar_says_what_it_shows() -> None:
    pytest.importorskip("plotly")
    points = geodesics.SurfacePoints.at_vertices(MESH, [1, 2])
    figure = geodesics.plot(MESH, MESH.vertices[:, 2], paths=[MESH.vertices[[3, 5, 6]], points], label="height / mm")
    surface, lines = figure.data
    drawn = np.stack([lines.x, lines.y, lines.z], axis=1).astype(float)
    assert lines.mode == "lines" and np.isnan(drawn[[3, 6]]).all()
    assert np.allclose(drawn[[0, 1, 2, 4, 5]], MESH.vertices[[3, 5, 6, 1, 2]])
    assert surface.colorbar.title.text == "height / mm"
    with pytest.raises(BadShape, match="a path must be"):
        geodesics.plot(MESH, paths=[[1.0, 2.0]])


def test_a_page_is_as_wide_as_its_screen(tmp_path: Path) -> None:
    pytest.importorskip("plotly")
    figure = geodesics.plot(MESH)
    figure.write_html(tmp_path / "page.html", include_plotlyjs=False, post_script="document.title = 'mine';")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "width=device-width" in page and "document.title = 'mine';" in page
    assert "scene.camera.eye" in page  # farther in a window that is higher than wide
    assert "width=device-width" in figure.to_html(include_plotlyjs=False)
    assert "width=device-width" not in figure.to_html(include_plotlyjs=False, full_html=False)  # a part of another page
    assert pickle.loads(pickle.dumps(figure)).layout == figure.layout


def test_colours_and_bad_values() -> None:
    pytest.importorskip("plotly")
    assert geodesics.plot(MESH, np.ones((MESH.n_vertices, 3))).data[0].vertexcolor[0] == "rgb(255,255,255)"
    with pytest.raises(BadShape, match="one for each vertex"):
        geodesics.plot(MESH, [1.0, 2.0])


def test_without_plotly_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "plotly.graph_objects", None)
    with pytest.raises(MissingExtra, match="viz"):
        geodesics.plot(MESH)


@pytest.mark.parametrize("values", [np.full((42, 3), 255), np.full((42, 3), np.nan), np.full(42, 1j), ["a"] * 42])
def test_colours_and_values_are_checked(values: object) -> None:
    pytest.importorskip("plotly")
    with pytest.raises(ValueError, match=r"E604|E107"):
        geodesics.plot(MESH, values)  # type: ignore[arg-type]


@pytest.mark.parametrize("up", [(0, 0, 0), (1,), (np.nan, 0, 1), 5])
def test_up_is_a_direction(up: object) -> None:
    pytest.importorskip("plotly")
    with pytest.raises(ValueError, match="E604: up"):
        geodesics.plot(MESH, up=up)  # type: ignore[arg-type]


def test_one_path_may_stand_alone_and_what_is_none_is_named() -> None:
    pytest.importorskip("plotly")
    mesh = bumpy_sphere(2)
    line = geodesics.SurfacePoints.at_vertices(mesh, [0, 5, 9])
    for alone in (line, line.positions):
        figure = geodesics.plot(mesh, paths=alone)
        np.testing.assert_allclose(figure.data[-1].x[:3], line.positions[:, 0])
    assert [trace.type for trace in geodesics.plot(mesh, paths=None).data] == ["mesh3d"]
    with pytest.raises(BadArgument, match="paths must be lines"):
        geodesics.plot(mesh, paths=5)  # type: ignore[arg-type]
