"""The page and the picture as commands write them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import moved
from pages import elements, page_data

from geodesics import SurfacePoints, write_mesh
from gmds import Correspondence
from gmds.cli import main
from gmds.shapes import quadruped

SOURCE, TARGET = "a<img src=x>&amp;.off", "b.obj"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two meshes, the true map of one to the other, and a wrong one."""
    place = tmp_path_factory.mktemp("pair")
    shape = quadruped(n_vertices=300)
    other = moved(shape, seed=2)
    write_mesh(shape, place / SOURCE)
    write_mesh(other, place / TARGET)
    for name, images in (("truth", np.arange(300)), ("map", np.roll(np.arange(300), 7))):
        Correspondence.from_points(shape, SurfacePoints.at_vertices(other, images)).save(place / f"{name}.npz")
    return place


def run(folder: Path, *args: str) -> Result:
    files = ["--source", folder / SOURCE, "--target", folder / TARGET, "--truth", folder / "truth.npz"]
    return CliRunner().invoke(main, ["evaluate", *map(str, [folder / "map.npz", *files, *args])])


def test_evaluate_shows_the_errors(folder: Path, tmp_path: Path) -> None:
    done = run(folder, "--report", str(tmp_path / "r.html"), "--picture", str(tmp_path / "p.svg"), "--points", "50")
    assert done.exit_code == 0, done.output
    data = page_data(tmp_path / "r.html")
    assert "known at 50 points" in next(mode["help"] for mode in data["modes"] if mode["key"] == "error")
    assert data["maps"][0]["curve"][-1] <= 1 and [shown["name"] for shown in data["surfaces"]] == [SOURCE, TARGET]
    assert "img" not in elements(tmp_path / "r.html").tags
    assert "error" in (tmp_path / "p.svg").read_text() and "<img" not in (tmp_path / "p.svg").read_text()
    assert f"wrote {tmp_path / 'p.svg'}" in done.stderr


def test_up_is_said_or_goes_by_the_format(folder: Path, tmp_path: Path) -> None:
    def heights(*options: str) -> np.ndarray:
        assert run(folder, "--report", str(tmp_path / "r.html"), *options).exit_code == 0
        return page_data(tmp_path / "r.html")["surfaces"][0]["vertices"].reshape(-1, 3)[:, 1]

    z, y = (quadruped(n_vertices=300).vertices[:, axis] for axis in (2, 1))
    assert np.corrcoef(heights(), z)[0, 1] > 0.999
    assert np.corrcoef(heights("--up", "y"), y)[0, 1] > 0.999


def test_formats_in_which_y_is_up(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from gmds.cli.view_options import write_views

    given = []
    monkeypatch.setattr("gmds.report.page.write_report", lambda *_, up, **__: given.append(up))
    for name in ("dog.off", "dog.OBJ", "dog.glb"):
        write_views(None, tmp_path / "r.html", None, title="", names=(name, "cat.off"))
    write_views(None, tmp_path / "r.html", None, title="", names=("dog.obj", "cat.off"), up="x")
    assert given == [(0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0)]


def test_a_picture_in_an_unknown_format_is_refused_before_anything_is_read(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["match", "nothing.off", "nothing.off", "--picture", "p.tif"])
    assert done.exit_code == 2 and "'p.tif' must end in .png" in done.stderr
