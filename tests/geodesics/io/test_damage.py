"""Files damaged at random: a typed error or a sound mesh, whatever the bytes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from file_cases import OFF, PLY, READ, STL, STL_BINARY, binary_ply, glb
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from geodesics import FormatError, MeshError, read_mesh

SEEDS = {
    "off": OFF.encode(),
    "obj": next(str(content) for _, name, content in READ if name == "texture.obj").encode(),
    "ply": PLY.encode(),
    "binary ply": binary_ply(extra=True),
    "big-endian ply": binary_ply(">"),
    "stl": STL.encode(),
    "binary stl": STL_BINARY,
    "glb": glb(),
}
PIECES = [b"-1", b"1e999", b"nan", b"9" * 9, b"9" * 20, b",", b"\0", b"\xff", b"#", b"\n", b" ", b"{", b"3 0 1 2\n"]

# one damage: where, how many bytes go, what comes instead
damage = st.tuples(
    st.floats(0, 1), st.integers(0, 12), st.one_of(st.binary(max_size=4), st.sampled_from(PIECES), st.just(b""))
)


@pytest.mark.parametrize("kind", SEEDS)
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(damages=st.lists(damage, min_size=1, max_size=4))
def test_damaged_files(tmp_path: Path, kind: str, damages: list[tuple[float, int, bytes]]) -> None:
    content = bytearray(SEEDS[kind])
    for where, gone, instead in damages:
        at = int(where * len(content))
        content[at : at + gone] = instead
    (tmp_path / "mesh").write_bytes(content)
    try:
        mesh = read_mesh(tmp_path / "mesh")
    except (MeshError, FormatError) as error:
        assert "mesh" in str(error)
        return
    assert np.isfinite(mesh.vertices).all()
    assert mesh.faces.min() >= 0 and mesh.faces.max() < mesh.n_vertices
