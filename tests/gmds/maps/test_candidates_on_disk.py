"""map.npz with candidates: they come back, as near as looking needs, and nothing wrong gets in."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from known_maps import SOURCE, load, make_answer, members, with_candidates

from gmds.errors import MapArray, MapMembers, MapVersion
from gmds.maps.candidate_rows import DTYPES, STEPS


@pytest.fixture
def parts(tmp_path: Path) -> dict[str, Any]:
    with_candidates().save(tmp_path / "map.npz")
    return members(tmp_path / "map.npz")


def test_candidates_come_back_to_a_step_of_their_weights(tmp_path: Path) -> None:
    answer = with_candidates()
    answer.save(tmp_path / "map.npz")
    again = load(tmp_path / "map.npz")
    assert len(again.candidates) == len(answer.candidates) == 3
    for mine, theirs in zip(again.candidates, answer.candidates, strict=True):
        assert (mine.points.face == theirs.points.face).all()
        assert np.abs(mine.points.barycentric - theirs.points.barycentric).max() <= 1.01 / STEPS
        assert (mine.stress, mine.orientation) == (theirs.stress, theirs.orientation)
    corner = again.candidates[2].points
    assert (corner.barycentric == [0, 0, 1]).all(), "what is at a vertex stays there"
    assert (again.points.barycentric == answer.points.barycentric).all(), "the map itself is exact"


def test_what_was_read_is_written_again_byte_for_byte(tmp_path: Path) -> None:
    with_candidates().save(tmp_path / "map.npz")
    load(tmp_path / "map.npz").save(tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == (tmp_path / "map.npz").read_bytes()


def test_numpy_alone_reads_the_documented_members(parts: dict[str, Any]) -> None:
    n = SOURCE.n_vertices
    assert json.loads(parts["meta"].tobytes())["version"] == 1
    assert {name: parts[name].dtype.str for name in DTYPES} == DTYPES
    assert [parts[name].shape for name in DTYPES] == [(3, n), (3, n, 2), (3,), (3,)]


def test_a_map_without_candidates_is_as_it_was(tmp_path: Path) -> None:
    make_answer().save(tmp_path / "map.npz")
    assert json.loads(members(tmp_path / "map.npz")["meta"].tobytes())["version"] == 1
    assert load(tmp_path / "map.npz").candidates == ()


@pytest.mark.parametrize("name", DTYPES)
def test_a_missing_member_is_named(tmp_path: Path, parts: dict[str, Any], name: str) -> None:
    del parts[name]
    np.savez(tmp_path / "bad.npz", **parts)
    with pytest.raises(MapMembers, match=f"E210.*lacks {name} of its candidates"):
        load(tmp_path / "bad.npz")


WRONG = {
    "another number of faces": ("candidate_face", lambda a: a[:-1]),
    "rows of another mesh": ("candidate_face", lambda a: a[:, :-1]),
    "face out of range": ("candidate_face", lambda a: a + np.int32(10**6)),
    "weights beyond one": ("candidate_weights", lambda a: np.full_like(a, STEPS)),
    "three weights": ("candidate_weights", lambda a: np.repeat(a, 2, axis=2)[:, :, :3]),
    "float weights": ("candidate_weights", lambda a: a.astype(np.float32)),
    "stress in two rows": ("candidate_stress", lambda a: a[None]),
    "more than there may be": ("candidate_stress", lambda a: np.zeros(1001)),
    "fewer orientations": ("candidate_orientation", lambda a: a[1:]),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_arrays_are_refused(tmp_path: Path, parts: dict[str, Any], case: str) -> None:
    name, spoil = WRONG[case]
    parts[name] = spoil(parts[name])
    np.savez(tmp_path / "bad.npz", **parts)
    with pytest.raises(MapArray, match="E211"):
        load(tmp_path / "bad.npz")


def test_a_newer_version_is_told_before_members_that_are_not_known(tmp_path: Path, parts: dict[str, Any]) -> None:
    meta = {**json.loads(parts["meta"].tobytes()), "version": 3}
    parts["meta"] = np.frombuffer(json.dumps(meta).encode(), np.uint8)
    np.savez(tmp_path / "bad.npz", **parts, invention=np.zeros(3))
    with pytest.raises(MapVersion, match=r"E213.*version 3; this release reads version 1"):
        load(tmp_path / "bad.npz")
