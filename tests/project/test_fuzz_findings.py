"""What fuzzing found (`benchmarks/fuzzing/fuzz.py`), a test each, so that it stays found."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from file_cases import PLY, PLY_HEAD, F, V, binary_ply
from generated_shapes import icosphere
from other_formats import vtk, vtp

from geodesics import FormatError, Mesh, MeshError, SurfacePoints, read_mesh, write_mesh
from gmds import Correspondence, __version__
from gmds.appearance.reading import BadLook, read_look
from gmds.benchmarking.datasets import UnknownDataset, dataset_pairs
from gmds.cli.settings import read_settings
from gmds.errors import BadSetting
from gmds.mds.losses import LeastSquares
from gmds.provenance import method_in_words

MADE: dict[str, Any] = {"n_samples": 12, "orientation": "any", "rng": 1, **method_in_words(None, LeastSquares())}
ENTRY = {"name": "p", "source": "x/a.off", "target": "scaled/b.off", "truth": "scaled/b.npz"}
TEXTURED = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"


def a_map(path: Path, meta: Any) -> Path:
    mesh = icosphere(0)
    at = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    Correspondence.from_points(mesh, at, meta=meta).save(path)
    return path


def test_a_map_holds_settings(tmp_path: Path) -> None:
    path = a_map(tmp_path / "a.npz", {"parameters": MADE, "versions": {"gmds": __version__}})
    held = {"samples": 12, "orientation": "any", "parts": "neither", "seed": 1, "loss": "least-squares"}
    assert read_settings(path)["matching"] == held, "a map of before there were parts has none"


@pytest.mark.parametrize("name", ["n_samples", "orientation", "rng", "loss", "distance"])
def test_a_map_that_lacks_a_parameter_holds_no_settings(name: str, tmp_path: Path) -> None:
    made = {key: value for key, value in MADE.items() if key != name}
    path = a_map(tmp_path / "a.npz", {"parameters": made, "versions": {"gmds": __version__}})
    with pytest.raises(BadSetting, match="holds no settings"):
        read_settings(path)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("n_samples", "12", "matching.samples must be a whole number"),
        ("n_samples", None, "matching.samples must be a whole number"),
        ("orientation", "anny", "did you mean 'any'"),
        ("rng", [1], "matching.seed must be a whole number"),
        ("loss", 3, "made with the loss 3"),
        ("distance", ["x"], "made with the distance"),
    ],
)
def test_the_settings_of_a_map_are_checked_as_those_of_a_file_are(
    name: str, value: Any, says: str, tmp_path: Path
) -> None:
    path = a_map(tmp_path / "a.npz", {"parameters": {**MADE, name: value}, "versions": {"gmds": __version__}})
    with pytest.raises(BadSetting, match=says):
        read_settings(path)


@pytest.mark.parametrize("versions", [None, "0.1", 3])
def test_versions_of_a_map_may_be_anything(versions: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    read_settings(a_map(tmp_path / "a.npz", {"parameters": MADE, "versions": versions}))
    assert "was made by gmds None" in capsys.readouterr().err


@pytest.mark.parametrize("cut", [60, -1000])
def test_a_picture_that_ends_too_soon_is_no_texture(cut: int, tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    whole = io.BytesIO()
    image.fromarray(np.random.default_rng(0).integers(0, 255, (32, 32, 3), dtype=np.uint8)).save(whole, "png")
    (tmp_path / "a.png").write_bytes(whole.getvalue()[:cut])
    mesh = tmp_path / "a.obj"
    mesh.write_text(TEXTURED)
    with pytest.raises(BadLook, match=r"E217.*a.png is no image"):
        read_look(mesh, read_mesh(mesh), tmp_path / "a.png")


@pytest.mark.parametrize("element", ["vertex", "face"])
@pytest.mark.parametrize("content", [PLY.encode(), binary_ply()])
def test_an_element_of_a_ply_that_is_declared_twice(element: str, content: bytes, tmp_path: Path) -> None:
    line = f"element {element} 4\n".encode()
    (tmp_path / "a.ply").write_bytes(content.replace(line, 2 * line))
    with pytest.raises(FormatError, match=f"element {element} twice"):
        read_mesh(tmp_path / "a.ply")


def test_listings_of_pairs_are_text(tmp_path: Path) -> None:
    (tmp_path / "corres").mkdir()
    (tmp_path / "test_pairs.txt").write_bytes(b"a b\xff\n")
    with pytest.raises(UnknownDataset, match="not UTF-8"):
        dataset_pairs(tmp_path)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"\xff", "not UTF-8"),
        (b"[" * 100_000, "not a list of pairs"),
        (json.dumps([{"name": "p", "source": "a.off"}]).encode(), "target"),
        (json.dumps([{**ENTRY, "truth": 3}]).encode(), "pair 'p'.*must be text"),
        (json.dumps([{**ENTRY, "name": [3]}]).encode(), "not a list of pairs"),
        (json.dumps([{**ENTRY, "group": None}]).encode(), "must be text"),
        (b"[3]", "not a list of pairs"),
        (b"3", "not a list of pairs"),
    ],
)
def test_pairs_that_are_no_pairs(content: bytes, says: str, tmp_path: Path) -> None:
    (tmp_path / "pairs.json").write_bytes(content)
    with pytest.raises(UnknownDataset, match=says):
        dataset_pairs(tmp_path)


def test_pairs_without_a_group(tmp_path: Path) -> None:
    (tmp_path / "pairs.json").write_text(json.dumps([ENTRY]))
    assert [(pair.name, pair.group) for pair in dataset_pairs(tmp_path)] == [("p", "")]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["a.stl", "a.ply", "a.vtk", "a.glb", "a.vtp"])
def test_a_nan_that_signals_is_refused_without_a_warning(name: str, tmp_path: Path) -> None:
    single = np.array([0x7F800001], "<u4").tobytes()
    write_mesh(Mesh(V, F), tmp_path / name) if name[-4:] not in (".vtk", ".ply", ".vtp") else None
    made = {
        "a.vtk": vtk("3.0", True).replace(b"double", b"float").replace(V.astype(">f8").tobytes(), single[::-1] * 12)
    }
    made["a.ply"] = (
        PLY_HEAD.replace("ascii", "binary_little_endian").encode() + single * 12 + bytes([3, *bytes(12)]) * 4
    )
    made["a.vtp"] = vtp("raw").replace(b"Float64", b"Float32", 1).replace(V.tobytes(), single * 24)
    content = made.get(name) or (tmp_path / name).read_bytes().replace(V[0].astype("<f4").tobytes(), single * 3)
    (tmp_path / name).write_bytes(content)
    with pytest.raises((FormatError, MeshError), match=r"E101|E204"):
        read_mesh(tmp_path / name)


def test_cells_that_are_declared_to_take_no_numbers(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_bytes(vtk().replace(b"POLYGONS 4 16", b"POLYGONS 4 0"))
    with pytest.raises(FormatError, match=r"E205: .*cell 0 of 4"):
        read_mesh(tmp_path / "a.vtk")
