"""map.npz: what is written comes back, numpy alone can read it, and nothing wrong gets in."""

from __future__ import annotations

import hashlib
import io
import json
import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shapes import bumpy_sphere, icosphere

from geodesics import FormatError, Mesh, SurfacePoints
from gmds.correspondence import Correspondence, MatchStatus
from gmds.errors import MapArray, MapMembers, MapMismatch, MapVersion, PickledMember
from gmds.map_file import write_map

SOURCE, TARGET = bumpy_sphere(1), icosphere(2)


def make_answer() -> Correspondence:
    rng = np.random.default_rng(0)
    n = SOURCE.n_vertices
    points = SurfacePoints(TARGET, rng.integers(0, TARGET.n_faces, n), rng.dirichlet(np.ones(3), n))
    meta = {"seed": 3, "parameters": {"n_samples": np.int64(7), "weights": np.arange(2.0)}, "timings": {"solve": 0.5}}
    valid, distortion = rng.random(n) > 0.2, rng.random(n).astype(np.float32).astype(np.float64)
    return Correspondence(SOURCE, TARGET, points, valid, distortion, MatchStatus.AMBIGUOUS, (), meta)


def members(path: Path) -> dict[str, Any]:
    with np.load(path, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def test_round_trip_is_exact(tmp_path: Path) -> None:
    answer = make_answer()
    answer.save(tmp_path / "map.npz")
    again = Correspondence.load(tmp_path / "map.npz", SOURCE, TARGET)
    for name in ("face", "barycentric"):
        assert (getattr(again.points, name) == getattr(answer.points, name)).all()
    assert (again.valid == answer.valid).all()
    assert (again.distortion == answer.distortion).all()
    assert again.status is MatchStatus.AMBIGUOUS
    assert again.meta == {"seed": 3, "parameters": {"n_samples": 7, "weights": [0.0, 1.0]}, "timings": {"solve": 0.5}}
    again.save(tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == (tmp_path / "map.npz").read_bytes()


def test_numpy_alone_reads_the_documented_members(tmp_path: Path) -> None:
    make_answer().save(tmp_path / "map.npz")
    arrays = members(tmp_path / "map.npz")
    expected = {
        "face": "<i4",
        "barycentric": "<f8",
        "vertex": "<i8",
        "valid": "|b1",
        "distortion": "<f4",
        "meta": "|u1",
    }
    assert {name: array.dtype.str for name, array in arrays.items()} == expected
    assert (arrays["vertex"] == make_answer().vertex_map()).all()
    meta = json.loads(arrays["meta"].tobytes().decode())
    assert (meta["format"], meta["version"]) == ("gmds-map", 1)
    digest = hashlib.sha256(SOURCE.vertices.tobytes() + SOURCE.faces.tobytes()).hexdigest()
    assert meta["source"] == {"vertices": SOURCE.n_vertices, "faces": SOURCE.n_faces, "sha256": digest}


def test_other_meshes_are_refused(tmp_path: Path) -> None:
    make_answer().save(tmp_path / "map.npz")
    with pytest.raises(MapMismatch, match=r"E212.*target with vertices 162"):
        Correspondence.load(tmp_path / "map.npz", SOURCE, icosphere(1))
    nudged = SOURCE.vertices.copy()
    nudged[0, 0] = np.nextafter(nudged[0, 0], 9)
    with pytest.raises(MapMismatch, match=r"source with sha256"):
        Correspondence.load(tmp_path / "map.npz", Mesh(nudged, SOURCE.faces), TARGET)


@pytest.fixture
def parts(tmp_path: Path) -> dict[str, Any]:
    make_answer().save(tmp_path / "map.npz")
    return members(tmp_path / "map.npz")


def load(path: Path) -> Correspondence:
    return Correspondence.load(path, SOURCE, TARGET)


@pytest.mark.parametrize("name", ["face", "barycentric", "vertex", "valid", "distortion", "meta"])
def test_a_missing_member_is_named(tmp_path: Path, parts: dict[str, Any], name: str) -> None:
    del parts[name]
    np.savez(tmp_path / "bad.npz", **parts)
    with pytest.raises(MapMembers, match=f"E210.*lacks {name}"):
        load(tmp_path / "bad.npz")


def test_extra_and_repeated_members_are_refused(tmp_path: Path, parts: dict[str, Any]) -> None:
    np.savez(tmp_path / "bad.npz", **parts, surprise=np.zeros(3))
    with pytest.raises(MapMembers, match="surprise"):
        load(tmp_path / "bad.npz")
    np.savez(tmp_path / "twice.npz", **parts)
    with pytest.warns(UserWarning, match="Duplicate"), zipfile.ZipFile(tmp_path / "twice.npz", "a") as archive:
        archive.writestr("face.npy", b"")
    with pytest.raises(MapMembers, match=r"repeated members .'face'"):
        load(tmp_path / "twice.npz")


BAD_ARRAYS = {
    "float faces": ("face", lambda a: a.astype(float)),
    "int64 faces": ("face", lambda a: a.astype(np.int64)),
    "short": ("valid", lambda a: a[:-1]),
    "flat weights": ("barycentric", lambda a: a.ravel()),
    "nan weight": ("barycentric", lambda a: np.where(np.arange(len(a))[:, None] == 2, np.nan, a)),
    "weights off one": ("barycentric", lambda a: a * 2),
    "negative weight": ("barycentric", lambda a: a + np.array([1.5, -1.5, 0])),
    "infinite distortion": ("distortion", lambda a: a + np.float32(np.inf)),
    "face out of range": ("face", lambda a: a + np.int32(10**6)),
    "negative face": ("face", lambda a: -a - np.int32(1)),
    "meta no JSON": ("meta", lambda a: a[:-5]),
    "meta two-dimensional": ("meta", lambda a: a[None]),
    "meta deep": ("meta", lambda a: np.frombuffer(b"[" * 200_000, np.uint8)),
}


@pytest.mark.parametrize("case", BAD_ARRAYS)
def test_wrong_arrays_are_refused(tmp_path: Path, parts: dict[str, Any], case: str) -> None:
    name, spoil = BAD_ARRAYS[case]
    parts[name] = spoil(parts[name])
    np.savez(tmp_path / "bad.npz", **parts)
    with pytest.raises(MapArray, match="E211"):
        load(tmp_path / "bad.npz")


@pytest.mark.parametrize(("size", "says"), [(16_000_000, "not UTF-8 JSON"), (16_000_001, "at most 16 MB")])
def test_meta_of_more_than_16_megabytes_is_not_taken(
    tmp_path: Path, parts: dict[str, Any], size: int, says: str
) -> None:
    parts["meta"] = np.zeros(size, np.uint8)
    np.savez_compressed(tmp_path / "bad.npz", **parts)
    with pytest.raises(MapArray, match=says):
        load(tmp_path / "bad.npz")


@pytest.mark.parametrize("change", [{"version": 2}, {"version": "1"}, {"format": "else"}, {"version": None}])
def test_versions_from_the_future_are_refused(tmp_path: Path, parts: dict[str, Any], change: dict[str, Any]) -> None:
    meta = {**json.loads(parts["meta"].tobytes()), **change}
    parts["meta"] = np.frombuffer(json.dumps(meta).encode(), np.uint8)
    np.savez(tmp_path / "bad.npz", **parts)
    with pytest.raises(MapVersion, match="E213"):
        load(tmp_path / "bad.npz")


class Canary:
    """Unpickling this leaves a file behind."""

    def __init__(self, path: Path) -> None:
        self.path = str(path)

    def __reduce__(self) -> tuple[Any, ...]:
        return (open, (self.path, "w"))


def test_pickles_are_never_opened(tmp_path: Path, parts: dict[str, Any]) -> None:
    parts["face"] = np.array([Canary(tmp_path / "canary")] * SOURCE.n_vertices, dtype=object)
    np.savez(tmp_path / "bad.npz", **parts)
    with pytest.raises(PickledMember, match="E220"):
        load(tmp_path / "bad.npz")
    assert not (tmp_path / "canary").exists()


def test_a_lying_header_costs_nothing(tmp_path: Path, parts: dict[str, Any]) -> None:
    np.savez(tmp_path / "whole.npz", **parts)
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "<i4", "fortran_order": False, "shape": (10**15,)})
    with zipfile.ZipFile(tmp_path / "whole.npz") as old, zipfile.ZipFile(tmp_path / "bad.npz", "w") as new:
        for name in old.namelist():
            new.writestr(name, stream.getvalue() if name == "face.npy" else old.read(name))
    with pytest.raises(MapArray, match="1000000000000000"):
        load(tmp_path / "bad.npz")


def test_every_truncation_is_noticed(tmp_path: Path) -> None:
    make_answer().save(tmp_path / "map.npz")
    whole = (tmp_path / "map.npz").read_bytes()
    for end in [*range(80), *range(80, len(whole), 37), len(whole) - 1]:
        (tmp_path / "cut.npz").write_bytes(whole[:end])
        with pytest.raises(FormatError, match="E210"):
            load(tmp_path / "cut.npz")


def test_flipped_bytes_never_get_through_unnoticed(tmp_path: Path) -> None:
    answer = make_answer()
    answer.save(tmp_path / "map.npz")
    whole = bytearray((tmp_path / "map.npz").read_bytes())
    for position in np.random.default_rng(1).integers(0, len(whole), 600):
        changed = whole.copy()
        changed[position] ^= 0x41
        (tmp_path / "bad.npz").write_bytes(changed)
        try:
            again = load(tmp_path / "bad.npz")
        except FormatError:
            continue
        assert (again.points.face == answer.points.face).all()  # only unused bytes of the archive changed
        assert (again.points.barycentric == answer.points.barycentric).all()


def test_a_missing_file_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "none.npz")


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.npz")
    with pytest.raises(OSError, match="regular"):
        load(tmp_path / "pipe.npz")


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "map.npz"
    make_answer().save(path)
    before = path.read_bytes()
    with pytest.raises(TypeError, match="JSON"):
        write_map(path, {}, {"bad": object()}, SOURCE, TARGET)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        make_answer().save(path)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["map.npz"]
