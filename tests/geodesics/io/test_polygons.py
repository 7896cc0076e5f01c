"""Polygons are split without overlap, whatever their shape: areas add up, and no triangle is turned round."""

from __future__ import annotations

import struct
from itertools import chain
from pathlib import Path

import numpy as np
import pytest
from file_cases import PLY_HEAD
from hypothesis import given, settings
from hypothesis import strategies as st

from geodesics import FormatError, read_mesh, read_with_notes
from geodesics.io.polygons import LARGEST_CLIPPED, clip_ears, split

L_SHAPE = np.array([(1, 2), (0, 2), (0, 0), (2, 0), (2, 1), (1, 1)], dtype=float)
ARROW = np.array([(0, 0), (2, 1), (0, 2), (0.5, 1)], dtype=float)
KEYHOLE = np.array(  # a square with a square hole, joined by a slit
    [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)], dtype=float
)


def area_of(points: np.ndarray) -> float:
    x, y = points.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def star(n: int, rng: np.random.Generator) -> np.ndarray:
    angle = np.sort(rng.uniform(0, 2 * np.pi, n))
    return rng.uniform(0.1, 1, n)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])


def signed(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    return np.array([area_of(points[triangle]) for triangle in triangles])


def in_space(points: np.ndarray, seed: int) -> np.ndarray:
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return np.column_stack([points, np.zeros(len(points))]) @ turn.T * 10.0 ** (seed % 7 - 3) + seed % 5


@pytest.mark.parametrize("points", [L_SHAPE, ARROW, KEYHOLE])
@pytest.mark.parametrize("first", range(4))
@pytest.mark.parametrize("seed", range(3))
def test_concave_polygons_in_any_position(points: np.ndarray, first: int, seed: int) -> None:
    points = np.roll(points, first, axis=0)
    triangles, slots, notes = split([len(points)], range(len(points)), in_space(points, seed))
    assert len(triangles) == len(points) - 2 and np.array_equal(triangles, slots)
    assert signed(points, triangles).min() >= -1e-12
    assert signed(points, triangles).sum() == pytest.approx(area_of(points))
    assert [note.code for note in notes] == ["W210"]


@settings(max_examples=60, deadline=None)
@given(n=st.integers(4, 40), seed=st.integers(0, 10**6))
def test_polygons_around_a_point_are_covered_once(n: int, seed: int) -> None:
    points = star(n, np.random.default_rng(seed))
    if np.diff(np.sort(np.arctan2(*points.T)), append=[np.inf]).max() > np.pi and area_of(points) <= 0:
        return
    triangles = clip_ears(points)
    assert sorted({*triangles.ravel().tolist()}) == list(range(n)) and len(triangles) == n - 2
    if np.diff(np.arctan2(points[:, 1], points[:, 0])).max(initial=0) < np.pi:
        assert signed(points, triangles).sum() == pytest.approx(area_of(points))


def test_convex_polygons_are_split_about_their_first_corner() -> None:
    angle = np.arange(7) * 2 * np.pi / 7
    points = in_space(np.column_stack([np.cos(angle), np.sin(angle)]), 1)
    triangles, _, _ = split([3, 7, 4], [0, 1, 2, *range(7), 3, 4, 5, 6], points)
    assert triangles.tolist() == [[0, 1, 2], *([0, i, i + 1] for i in range(1, 6)), [3, 4, 5], [3, 5, 6]]


def test_slots_say_which_corner_of_the_file_each_is() -> None:
    corners = [5, 4, 3, 2, 1, 0, 7, 8, 9]
    points = in_space(np.vstack([L_SHAPE[::-1], star(4, np.random.default_rng(0))]), 2)
    triangles, slots, _ = split([6, 3], corners, points)
    assert np.array_equal(triangles, np.array(corners)[slots]) and slots[-1].tolist() == [6, 7, 8]


def test_sides_that_cross_or_coincide_end_too() -> None:
    rng = np.random.default_rng(0)
    for points in (rng.normal(size=(60, 2)), np.zeros((9, 2)), np.repeat(L_SHAPE, 2, axis=0)):
        assert len(clip_ears(points)) == len(points) - 2
        assert len(split([len(points)], range(len(points)), in_space(points, 0))[0]) == len(points) - 2
    unknown = np.full((5, 3), np.nan)
    assert len(split([5], range(5), unknown)[0]) == 3


def test_a_polygon_too_large_to_clip_is_named(tmp_path: Path) -> None:
    for n in (LARGEST_CLIPPED, LARGEST_CLIPPED + 2):
        angle = np.arange(n) * 2 * np.pi / n
        ring = np.where(np.arange(n) % 2, 1, 0.5)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        lines = [f"v {x!r} {y!r} 0" for x, y in ring.tolist()] + ["f " + " ".join(map(str, range(1, n + 1)))]
        (tmp_path / "a.obj").write_text("\n".join(lines) + "\n")
        if n == LARGEST_CLIPPED:
            assert read_mesh(tmp_path / "a.obj").area == pytest.approx(area_of(ring))
        else:
            with pytest.raises(FormatError, match=r"E206: .*a\.obj: face 0 has 1002 corners"):
                read_mesh(tmp_path / "a.obj")


def test_every_format_with_polygons_splits_them_alike(tmp_path: Path) -> None:
    points = in_space(np.vstack([L_SHAPE, [(3, 3), (4, 3), (3, 4)]]), 0)
    faces = [[0, 1, 2, 3, 4, 5], [6, 7, 8], [6, 7, 4, 5]]
    text = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
    listed = "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
    head = PLY_HEAD.replace("float", "double").replace("vertex 4", "vertex 9").replace("face 4", "face 3")
    binary = b"".join(struct.pack(f"<B{len(face)}i", len(face), *face) for face in faces)
    obj = "".join(f"v {line}\n" for line in text.splitlines())
    obj += "".join(f"f {' '.join(str(i + 1) for i in face)}\n" for face in faces)
    size = sum(map(len, faces)) + 3
    files = {
        "a.off": f"OFF\n9 3 0\n{text}{listed}".encode(),
        "a.obj": obj.encode(),
        "a.ply": (head + text + listed).encode(),
        "b.ply": head.replace("ascii", "binary_little_endian").encode() + points.astype("<f8").tobytes() + binary,
        "a.vtk": f"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 9 double\n{text}"
        f"POLYGONS 3 {size}\n{listed}".encode(),
    }
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
        mesh, notes = read_with_notes(tmp_path / name)
        assert np.array_equal(mesh.faces, split([6, 3, 4], [*chain(*faces)], points)[0]), name
        assert [(note.code, note.count, note.indices) for note in notes] == [("W210", 2, (0, 2))]
