"""Habits of other programs: the same box comes out of every file, or a typed error."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from odd_exporters import BOX, READ, REFUSED, T

from geodesics import FormatError, MeshError, read_mesh


@pytest.mark.parametrize("name", list(READ))
def test_the_box_is_read(tmp_path: Path, name: str) -> None:
    content = READ[name]
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    mesh = read_mesh(tmp_path / name)
    coarse = 0.05 if name.startswith(("i1", "u1")) else 1e-4 if name.startswith(("i2", "u2")) else 1e-6
    if "stl" in name:  # numbered as they come
        assert mesh.n_vertices == 8
    else:
        assert np.abs(mesh.vertices - BOX.vertices).max() < coarse
        assert np.array_equal(np.sort(mesh.faces, axis=0), np.sort(T, axis=0))
    assert np.abs(mesh.vertices[mesh.faces] - BOX.vertices[BOX.faces]).max() < coarse


@pytest.mark.parametrize(("name", "content", "code", "says"), REFUSED, ids=[case[0] for case in REFUSED])
def test_what_is_no_surface_is_refused(tmp_path: Path, name: str, content: str | bytes, code: str, says: str) -> None:
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises((FormatError, MeshError)) as caught:
        read_mesh(tmp_path / name)
    assert caught.value.code == code and says in str(caught.value) and name in str(caught.value), str(caught.value)
