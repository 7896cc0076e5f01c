"""Row G28: a table that does not fit is refused before it is allocated, with its size and what to do instead."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import icosphere

import geodesics
from geodesics import BiharmonicDistance, GeodesicDistance, SurfacePoints, heat_kernel, memory
from geodesics.errors import WouldExceedMemory

MESH = icosphere(4)  # 2,562 vertices: all distances are 52.5 MB
METRIC = geodesics.embedded(MESH)
SPECTRUM = geodesics.eigenpairs(METRIC, 5)
TABLES: dict[str, Callable[[SurfacePoints], object]] = {
    "geodesic": GeodesicDistance(METRIC).field,
    "biharmonic": BiharmonicDistance(SPECTRUM).field,
    "heat kernel": lambda points: heat_kernel(SPECTRUM, 0.1, points),
}


@pytest.mark.parametrize("name", TABLES)
def test_all_distances_of_a_mesh_that_do_not_fit_are_refused(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    points = SurfacePoints.at_vertices(MESH, np.tile(np.arange(MESH.n_vertices), 2))
    monkeypatch.setattr(memory, "available", lambda: 1.1e8)
    with pytest.raises(
        WouldExceedMemory, match=r"E501: .*5124 x 2562 numbers, need 0\.1 GB, and 0\.1 GB are free; .*few"
    ):
        TABLES[name](points)
    few = TABLES[name](points[:3])
    assert isinstance(few, np.ndarray) and few.shape == (3, MESH.n_vertices)


def test_a_hundred_gigabytes_are_refused_here_and_now() -> None:
    with pytest.raises(MemoryError, match=r"E501: distances, 1100000 x 1100000 numbers, need 9680\.0 GB"):
        memory.table(1_100_000, 1_100_000, "distances", "take fewer")


def test_what_is_free_is_what_the_system_and_the_group_leave(tmp_path: Path) -> None:
    assert 1e7 < memory.available() < 1e15
    for limit, used, left in (("max", "5", np.inf), ("1000", "400", 600.0), ("1000", "1400", 0.0)):
        (tmp_path / "memory.max").write_text(limit)
        (tmp_path / "memory.current").write_text(used)
        assert memory._of_the_group(tmp_path) == left
    assert memory._of_the_group(tmp_path / "none") == np.inf


def test_what_the_system_says_is_free_is_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: "MemTotal:  9000000 kB\nMemAvailable:    3000000 kB\n")
    assert memory._of_the_system() == 3_000_000 * 1024


def test_without_its_word_half_of_what_there_is_counts_as_free(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not even that is known everywhere: then nothing is refused."""
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: "no such line")
    sizes = {"SC_PHYS_PAGES": 1_000_000, "SC_PAGE_SIZE": 4096}
    monkeypatch.setattr(memory.os, "sysconf", sizes.__getitem__, raising=False)
    assert memory._of_the_system() == 2_048_000_000
    monkeypatch.delattr(memory.os, "sysconf")
    assert memory._of_the_system() == np.inf
