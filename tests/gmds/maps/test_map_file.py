"""map.npz: what is written comes back, numpy alone can read it, and nothing wrong gets in."""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated_shapes import icosphere
from known_maps import SOURCE, TARGET, load, make_answer, members

from geodesics import Mesh
from gmds.correspondence import Correspondence
from gmds.errors import MapArray, MapMembers, MapMismatch, MapVersion, PickledMember
from gmds.maps.point_map import MatchStatus


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
