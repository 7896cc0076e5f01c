"""map.npz: damaged, cut, packed otherwise, or only half written."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from known_maps import SOURCE, TARGET, load, make_answer, with_candidates

from geodesics import FormatError
from gmds import Correspondence
from gmds.errors import MapArray
from gmds.maps.npz_format import write_map


def test_every_truncation_is_noticed(tmp_path: Path) -> None:
    make_answer().save(tmp_path / "map.npz")
    whole = (tmp_path / "map.npz").read_bytes()
    for end in [*range(80), *range(80, len(whole), 37), len(whole) - 1]:
        (tmp_path / "cut.npz").write_bytes(whole[:end])
        with pytest.raises(FormatError, match="E210"):
            load(tmp_path / "cut.npz")


@pytest.mark.parametrize("make", [make_answer, with_candidates])
def test_flipped_bytes_never_get_through_unnoticed(tmp_path: Path, make: Callable[[], Correspondence]) -> None:
    answer = make()
    answer.save(tmp_path / "map.npz")
    whole, sound = bytearray((tmp_path / "map.npz").read_bytes()), load(tmp_path / "map.npz")
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
        for mine, theirs in zip(again.candidates, sound.candidates, strict=True):
            assert (mine.points.barycentric == theirs.points.barycentric).all()


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


def test_a_map_that_holds_no_number_is_not_written(tmp_path: Path) -> None:
    make_answer().save(tmp_path / "map.npz")
    before = (tmp_path / "map.npz").read_bytes()
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_map(tmp_path / "map.npz", {}, {"bad": np.nan}, SOURCE, TARGET)
    assert (tmp_path / "map.npz").read_bytes() == before


@pytest.mark.parametrize("member", ["meta", "face"])
def test_members_packed_otherwise_or_with_more_than_they_say_are_refused(tmp_path: Path, member: str) -> None:
    make_answer().save(tmp_path / "map.npz")
    for name, method, more, says in (
        ("lzma.npz", zipfile.ZIP_LZMA, b"", "another method"),
        ("long.npz", zipfile.ZIP_DEFLATED, b"\0", "where the header declares"),
    ):
        with zipfile.ZipFile(tmp_path / "map.npz") as old, zipfile.ZipFile(tmp_path / name, "w") as new:
            for part in old.namelist():
                here = part == f"{member}.npy"
                new.writestr(part, old.read(part) + (more if here else b""), method if here else zipfile.ZIP_DEFLATED)
        with pytest.raises(MapArray, match=f"E211: .*member {member}: .*{says}"):
            load(tmp_path / name)
