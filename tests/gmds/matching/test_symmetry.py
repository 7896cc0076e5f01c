"""self_symmetry(): known symmetries are found, ranked and told from the identity, also where a part has grown."""

from __future__ import annotations

import functools
import json
import runpy
import sys
from pathlib import Path
from typing import Any

import generated_shapes as shapes
import numpy as np
import pytest
from click.testing import CliRunner
from matched_shapes import bumpy
from places import ROOT

import gmds
from geodesics import Mesh, SurfacePoints, write_mesh
from gmds.cli import main
from gmds.correspondence import Correspondence
from gmds.errors import TooFewVertices
from gmds.maps.point_map import MatchStatus


@functools.cache
def symmetries_of_an_ellipsoid() -> list[Correspondence]:
    return gmds.self_symmetry(shapes.moved(shapes.ellipsoid(2)))


def signs(found: Correspondence) -> tuple[float, ...]:
    """What a map does to the three axes of the ellipsoid that `shapes.moved` has turned."""
    straight, mesh = shapes.ellipsoid(2).vertices, found.source
    images = straight[found.vertex_map()]
    assert np.allclose(found.points.positions, mesh.vertices[found.vertex_map()])
    assert np.allclose(np.abs(images), np.abs(straight), atol=1e-6)
    return tuple(np.sign((images * straight).sum(axis=0)))


def test_an_ellipsoid_has_seven_symmetries() -> None:
    found = symmetries_of_an_ellipsoid()
    assert len(found) == len({signs(one) for one in found}) == 7
    assert (1.0, 1.0, 1.0) not in {signs(one) for one in found}
    for one in found:
        assert one.source is one.target and one.status is MatchStatus.GOOD and one.valid.all()
        assert one.meta["symmetry"]["twice"] < 1e-6 and one.meta["symmetry"]["stress"] < 1e-6
        assert one.meta["symmetry"]["reversing"] == (np.prod(signs(one)) < 0)
        assert one.meta["symmetry"]["orientation"] == pytest.approx(np.prod(signs(one)), abs=0.05)


def test_a_self_map_says_the_same_after_saving(tmp_path: Path) -> None:
    one = symmetries_of_an_ellipsoid()[0]
    one.save(tmp_path / "map.npz")
    again = Correspondence.load(tmp_path / "map.npz", one.source, one.target)
    assert again.meta["symmetry"] == one.meta["symmetry"] and again.status is one.status


def test_a_large_mesh_is_solved_on_a_copy() -> None:
    mesh, ticks = shapes.moved(shapes.ellipsoid(3)), list[tuple[str, float]]()
    found = gmds.self_symmetry(mesh, n_vertices=200, progress=lambda *tick: ticks.append(tick))
    straight = shapes.ellipsoid(3).vertices
    wanted = straight[:, None] * np.array([[s, t, u] for s in (1, -1) for t in (1, -1) for u in (1, -1)])[1:]
    assert 1 <= len(found) <= 7 and found[0].status is MatchStatus.GOOD
    for one in found:
        assert one.source is mesh and one.target is mesh and len(one.points) == mesh.n_vertices
        images = SurfacePoints(shapes.ellipsoid(3), one.points.face, one.points.barycentric).positions
        gaps = np.linalg.norm(images[:, None] - wanted, axis=2).mean(axis=0)
        assert gaps.min() < 0.06 * np.sqrt(mesh.area) and one.meta["parameters"] == {"n_vertices": 200}
    fractions = [fraction for _, fraction in ticks]
    assert fractions == sorted(fractions) and ticks[0] == ("measuring", 0.0) and ticks[-1] == ("done", 1.0)


def test_the_animal_of_the_paper_is_symmetric_with_one_part_twice_as_big_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("matplotlib")
    scripts = ROOT / "examples" / "paper"
    monkeypatch.syspath_prepend(str(scripts))
    monkeypatch.setattr(sys, "argv", ["symmetry", "--small", "-o", str(tmp_path)])
    runpy.run_path(str(scripts / "symmetry.py"), run_name="__main__")
    found = json.loads((tmp_path / "symmetry.json").read_text(encoding="utf-8"))["animal"]
    assert found["plain"]["error_x100"] < 2.5 and found["rescaled"]["error_x100"] < 4
    for one in found.values():
        assert one["reversing"] and one["orientation"] < -0.8 and one["twice"] < 0.03
    assert (tmp_path / "symmetry.png").stat().st_size > 5000


def test_an_asymmetric_surface_has_no_good_symmetry() -> None:
    found = gmds.self_symmetry(bumpy())
    assert len(found) <= 1 and all(one.status is MatchStatus.POOR for one in found)


def test_bad_input_raises() -> None:
    with pytest.raises(TooFewVertices):
        gmds.self_symmetry(shapes.tetrahedron())
    with pytest.raises(ValueError, match="n_vertices must be at least 100, not 99"):
        gmds.self_symmetry(bumpy(), n_vertices=99)
    with pytest.raises(TypeError, match="n_vertices"):
        gmds.self_symmetry(bumpy(), n_vertex=300)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="a mesh is expected"):
        gmds.self_symmetry(np.zeros(3))  # type: ignore[arg-type]


def stand_in(count: int) -> Any:
    """A self_symmetry that finds `count` symmetries at once."""

    def found(mesh: Mesh, **options: Any) -> list[Correspondence]:
        points = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)[::-1])
        meta = {"symmetry": {"reversing": True, "twice": 0.0}, "parameters": {"n_vertices": options["n_vertices"]}}
        return [Correspondence.from_points(mesh, points, status=MatchStatus.GOOD, meta=meta) for _ in range(count)]

    return found


@pytest.fixture
def file(tmp_path: Path) -> Path:
    write_mesh(shapes.ellipsoid(1), tmp_path / "shape.off")
    return tmp_path / "shape.off"


def test_the_command_writes_every_map(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(vars(gmds), "self_symmetry", stand_in(2))
    output, picture = file.parent / "sym.npz", file.parent / "sym.png"
    arguments = ["symmetry", file, "-o", output, "--picture", picture, "--report", file.parent / "s.html", "--json"]
    done = CliRunner().invoke(main, list(map(str, arguments)))
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)["symmetries"]
    assert [Path(one["map"]).name for one in told] == ["sym.npz", "sym-2.npz"]
    assert told[0]["reversing"] is True and told[0]["status"] == "GOOD" and told[0]["twice"] == 0
    with np.load(file.parent / "sym-2.npz", allow_pickle=False) as stored:
        assert stored["vertex"][0] == len(stored["vertex"]) - 1
    assert picture.read_bytes().startswith(b"\x89PNG") and (file.parent / "s.html").stat().st_size > 1000


def test_the_command_in_plain_words(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(vars(gmds), "self_symmetry", stand_in(1))
    done = CliRunner().invoke(main, ["symmetry", str(file), "-o", str(file.parent / "map.npz")])
    assert done.exit_code == 0 and "1 of 1" in done.stdout and "GOOD" in done.stdout


def test_the_command_says_when_there_is_none(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(vars(gmds), "self_symmetry", stand_in(0))
    done = CliRunner().invoke(main, ["symmetry", str(file), "-o", str(file.parent / "map.npz"), "--json"])
    assert done.exit_code == 0 and json.loads(done.stdout)["symmetries"] == []
    assert "no symmetry" in done.stderr and not (file.parent / "map.npz").exists()


def test_the_command_reports_a_bad_file(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["symmetry", str(tmp_path / "nothing.off")])
    assert done.exit_code == 1 and "nothing.off" in done.stderr
