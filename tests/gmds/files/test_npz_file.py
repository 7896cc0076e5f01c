"""Arrays of strangers: lying headers, bombs, pickles, odd packings cost nothing and are told (rows F18, S01, S02)."""

from __future__ import annotations

import io
import os
import pickle
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated_shapes import icosphere

from gmds.batch.surface_file import read_surface
from gmds.benchmarking.truth_files import BadTruth, read_landmarks_mat, read_truth, read_truth_npz, read_vts
from gmds.errors import SurfaceFileError
from gmds.files import mat as mat_file
from gmds.files.npz import PickledArray, read_npy, read_npz
from gmds.files.values import BadValuesFile, read_values


def npy(shape: tuple[int, ...] = (3,), descr: str = "<i8", body: bytes = bytes(24)) -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": descr, "fortran_order": False, "shape": shape})
    return stream.getvalue() + body


def packed(path: Path, members: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


@pytest.mark.parametrize("dtype", ["<f8", ">i4", "|b1", "<U3", "<c16", "|u1"])
@pytest.mark.parametrize("shape", [(0,), (3,), (2, 3), (0, 4), ()])
def test_sound_arrays_come_back(tmp_path: Path, dtype: str, shape: tuple[int, ...]) -> None:
    array = np.arange(np.prod(shape, dtype=int)).reshape(shape).astype(dtype)
    np.save(tmp_path / "a.npy", array)
    np.savez_compressed(tmp_path / "a.npz", plain=array, turned=np.array(array, order="F"))
    found = read_npz(tmp_path / "a.npz")
    for again in (read_npy(tmp_path / "a.npy"), found["plain"], found["turned"]):
        assert again.dtype == array.dtype and np.array_equal(again, array)


@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_every_version_of_the_header_is_read(tmp_path: Path, version: tuple[int, int]) -> None:
    with (tmp_path / "a.npy").open("wb") as stream:
        np.lib.format.write_array(stream, np.arange(6).reshape(2, 3), version=version)
    assert read_npy(tmp_path / "a.npy").tolist() == [[0, 1, 2], [3, 4, 5]]


LIES = {
    "10^12 numbers": npy((10**12,)),
    "10^30 numbers": npy((10**30,)),
    "too few": npy((4,)),
    "negative": npy((-3,)),
    "two negatives": npy((-1, -3)),
    "no header": b"\x93NUMPY\x01\x00",
    "no array": b"hello",
    "odd header": b"\x93NUMPY\x01\x00\x10\x00{'descr': (((((  \n",
    "unknown dtype": npy(descr="<q9"),
    "too much": npy(body=bytes(25)),
}


@pytest.mark.parametrize("lie", LIES)
def test_a_header_that_lies_costs_nothing(tmp_path: Path, lie: str) -> None:
    (tmp_path / "a.npy").write_bytes(LIES[lie])
    with pytest.raises(ValueError, match="header"):
        read_npy(tmp_path / "a.npy")
    with pytest.raises(ValueError, match="header"):
        read_npz(packed(tmp_path / "a.npz", {"a.npy": LIES[lie]}))


def test_archives_that_are_none(tmp_path: Path) -> None:
    good = npy()
    for name, members, method in (
        ("other members", {"a.npy": good, "b.txt": b""}, zipfile.ZIP_DEFLATED),
        ("other packing", {"a.npy": good}, zipfile.ZIP_LZMA),
        ("other packing", {"a.npy": good}, zipfile.ZIP_BZIP2),
    ):
        with pytest.raises(ValueError, match=r"no whole \.npz archive"):
            read_npz(packed(tmp_path / name, members, method))
    whole = packed(tmp_path / "a.npz", {"a.npy": good}).read_bytes()
    for end in range(0, len(whole), 7):
        (tmp_path / "cut.npz").write_bytes(whole[:end])
        with pytest.raises(ValueError, match=r"no whole \.npz archive"):
            read_npz(tmp_path / "cut.npz")
    with pytest.warns(UserWarning, match="Duplicate"), zipfile.ZipFile(tmp_path / "a.npz", "a") as archive:
        archive.writestr("a.npy", good)
    with pytest.raises(ValueError, match="a name of its own"):
        read_npz(tmp_path / "a.npz")


def test_a_bomb_is_not_inflated(tmp_path: Path) -> None:
    """9 GB of zeros in a few kilobytes of declared size."""
    path = packed(tmp_path / "a.npz", {"a.npy": npy((9 << 30,), "|u1", bytes(1000))})
    with pytest.raises(ValueError, match="declares 9663676416 bytes"):
        read_npz(path)


def test_pickles_are_refused_by_every_reader(tmp_path: Path) -> None:
    class Canary:
        def __reduce__(self) -> tuple[Any, ...]:
            return (open, (str(tmp_path / "canary"), "w"))

    content = npy((1,), "|O", pickle.dumps([Canary()]))
    (tmp_path / "a.npy").write_bytes(content)
    members = {f"{name}.npy": content for name in ("src", "gt", "version", "original_vertices")}
    path = packed(tmp_path / "a.npz", members)
    readers: list[tuple[Callable[[], object], type[Exception]]] = [
        (lambda: read_npy(tmp_path / "a.npy"), PickledArray),
        (lambda: read_npz(path), PickledArray),
        (lambda: read_values(tmp_path / "a.npy", 1), BadValuesFile),
        (lambda: read_truth_npz(path), BadTruth),
        (lambda: read_surface(path), SurfaceFileError),
    ]
    for read, error in readers:
        with pytest.raises(error, match="never loaded"):
            read()
    assert not (tmp_path / "canary").exists()


def test_pipes_are_not_waited_for(tmp_path: Path) -> None:
    mesh = icosphere(0)
    for name in ("a.npz", "a.npy", "a.vts"):
        os.mkfifo(tmp_path / name)
    readers: list[Callable[[], object]] = [
        lambda: read_npy(tmp_path / "a.npy"),
        lambda: read_npz(tmp_path / "a.npz"),
        lambda: read_surface(tmp_path / "a.npz"),
        lambda: read_truth(tmp_path / "a.npz", mesh, mesh),
        lambda: read_vts(tmp_path / "a.vts"),
    ]
    for read in readers:
        with pytest.raises(OSError, match="not a regular file"):
            read()


@pytest.mark.parametrize("bad", [[0.5, 1.0], [-1, 2], [np.nan, 1], [2.0**63, 1], ["a", "b"], [True, False], [1j, 2]])
def test_truth_that_is_no_index_is_refused_not_rounded(tmp_path: Path, bad: list[Any]) -> None:
    np.savez(tmp_path / "t.npz", src=[0, 1], gt=bad)
    with pytest.raises(BadTruth, match="E231"):
        read_truth_npz(tmp_path / "t.npz")
    np.savez(tmp_path / "t.npz", src=np.array([0.0, 1.0]), gt=np.array([3, 4], dtype=np.uint8))
    assert read_truth_npz(tmp_path / "t.npz")[1].tolist() == [3, 4]


def test_a_mat_file_that_kills_its_reader_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "t.mat").write_bytes(b"any bytes")
    killer = "import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)"
    for script, says in (
        (killer, "signal 11"),
        ("import time\ntime.sleep(60)", "given up"),
        (mat_file.READ, "ended with"),
    ):
        monkeypatch.setattr(mat_file, "READ", script)
        monkeypatch.setattr(mat_file, "SECONDS", 2 if "sleep" in script else 60)
        with pytest.raises(BadTruth, match=says):
            read_landmarks_mat(tmp_path / "t.mat")


def test_mat_files_that_do_not_agree_with_themselves(tmp_path: Path) -> None:
    from scipy.io import savemat

    good = {"points": np.array([[1], [2]]), "baryc": np.array([[3, 0.2, 0.3, 0.5], [1, 1, 0, 0]]), "verts": [[1], [5]]}
    savemat(tmp_path / "t.mat", good)
    assert read_landmarks_mat(tmp_path / "t.mat")[1].tolist() == [0, 4]
    for key, value in (
        ("verts", [[1]]),
        ("verts", [[0], [1]]),
        ("verts", np.array([[0], [1]], dtype=np.uint8)),
        ("baryc", np.array([[3, 0, 0, 0], [1, 1, 0, 0]])),
        ("baryc", np.array([[3, np.nan, 0, 0], [1, 1, 0, 0]])),
        ("baryc", np.array([[0, 1, 0, 0], [1, 1, 0, 0]])),
    ):
        savemat(tmp_path / "t.mat", {**good, key: value})
        with pytest.raises(BadTruth, match=r"t\.mat"):
            read_landmarks_mat(tmp_path / "t.mat")
