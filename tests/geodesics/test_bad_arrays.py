"""Arrays given by callers, by row of the reliability table (V01-V16): an error naming the culprit, or the mesh."""

from __future__ import annotations

import pathlib
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from broken_arrays import REFUSED, F, V
from generated_shapes import bumpy_sphere
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from geodesics import Mesh, MeshError, triangulate

BIG = bumpy_sphere(2)


@pytest.mark.parametrize(("row", "code", "vertices", "faces", "says"), REFUSED)
def test_refused_with_code_and_culprit(row: str, code: str, vertices: Any, faces: Any, says: str) -> None:
    with pytest.raises(MeshError) as caught:
        Mesh(vertices, faces)
    assert caught.value.code == code
    assert str(caught.value).startswith(f"{code}: ")
    assert says in str(caught.value)


@pytest.mark.parametrize("given", ["dog.ply", pathlib.Path("dog.ply"), b"dog.ply", {"vertices": V}, object(), open])
def test_v16_wrong_types_get_an_example(given: Any) -> None:
    with pytest.raises(TypeError, match=r"read_mesh\(path\)|Mesh\("):
        Mesh(given, F)
    with pytest.raises(TypeError, match=r"read_mesh\(path\)|Mesh\("):
        Mesh.from_object(given)


def flat_faces() -> np.ndarray:
    return np.insert(F, 0, 3, axis=1).ravel()


OBJECTS = {
    "trimesh or ours": SimpleNamespace(vertices=V, faces=F),
    "open3d": SimpleNamespace(vertices=V, triangles=F.astype(np.int32)),
    "pyvista PolyData": SimpleNamespace(points=V, faces=flat_faces()),
    "faces as rows beside points": SimpleNamespace(points=V, faces=F),
    "pyvista UnstructuredGrid": SimpleNamespace(points=V, cells=flat_faces(), cells_dict={5: F, 3: F[:, :2], 1: F[:1]}),
    "meshio": SimpleNamespace(points=V, cells=[], cells_dict={"triangle": F, "line": F[:, :2]}),
}


@pytest.mark.parametrize("name", OBJECTS)
def test_v16_mesh_objects_of_other_libraries(name: str) -> None:
    for mesh in (Mesh(OBJECTS[name]), Mesh.from_object(OBJECTS[name])):
        assert np.array_equal(mesh.vertices, V)
        assert np.array_equal(mesh.faces, F)


def test_v16_a_real_trimesh_and_our_own() -> None:
    import trimesh

    mesh = Mesh(trimesh.Trimesh(V, F, process=False))
    assert np.array_equal(mesh.faces, F)
    assert Mesh.from_object(mesh) is mesh


def test_v16_objects_with_other_cells_are_refused() -> None:
    for other in (
        SimpleNamespace(points=V, cells_dict={"tetra": [[0, 1, 2, 3]]}),
        SimpleNamespace(points=V, faces=np.array([4, 0, 1, 2, 3])),
        SimpleNamespace(points=V, faces=np.array([4, 0, 1, 2, 3, 2, 0, 1])),  # a quad and a line
        SimpleNamespace(points=V, faces=np.array([3, 0, 1, 2, 4, 0, 1, 2, 3])),
    ):
        with pytest.raises(MeshError, match="E109"):
            Mesh(other)


class Frame:
    """Stands for a pandas frame: an object that only knows how to become an array."""

    def __init__(self, values: np.ndarray) -> None:
        self.values = values

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return self.values if dtype is None else self.values.astype(dtype)


def layouts(a: np.ndarray, folder: pathlib.Path) -> dict[str, Any]:
    padded = np.zeros((2 * len(a), 7), dtype=a.dtype)
    padded[::2, 1::2] = a
    mapped = np.memmap(folder / f"{a.dtype}.bin", dtype=a.dtype, mode="w+", shape=a.shape)
    mapped[:] = a
    read_only = a.copy()
    read_only.setflags(write=False)
    return {
        "C": a,
        "Fortran": np.asfortranarray(a),
        "strided": padded[::2, 1::2],
        "reversed": a[::-1].copy()[::-1],
        "big-endian": a.astype(a.dtype.newbyteorder(">")),
        "list": a.tolist(),
        "tuple": tuple(map(tuple, a.tolist())),
        "memmap": mapped,
        "read-only": read_only,
        "frame": Frame(a),
        "masked array without masked entries": np.ma.array(a),
        "matrix subclass": a.view(type("Sub", (np.ndarray,), {})),
    }


def test_v15_any_layout_gives_the_same_bits_and_stays_untouched(tmp_path: pathlib.Path) -> None:
    for v, f in zip(layouts(BIG.vertices, tmp_path).items(), layouts(BIG.faces, tmp_path).items(), strict=True):
        before = np.array(v[1]).copy(), np.array(f[1]).copy()
        mesh = Mesh(v[1], f[1])
        assert mesh.vertices.tobytes() == BIG.vertices.tobytes(), v[0]
        assert mesh.faces.tobytes() == BIG.faces.tobytes(), f[0]
        assert type(mesh.vertices) is np.ndarray and mesh.vertices.flags.c_contiguous
        assert np.array_equal(np.array(v[1]), before[0]) and np.array_equal(np.array(f[1]), before[1])


@pytest.mark.parametrize("kind", ["i1", "i2", "i4", "u1", "u2", "u4", "u8", ">i4", "f4", "f8"])
def test_v15_v09_any_number_type_of_faces(kind: str) -> None:
    small = bumpy_sphere(1)
    assert np.array_equal(Mesh(small.vertices, small.faces.astype(kind)).faces, small.faces)


@pytest.mark.parametrize("kind", ["f4", "f2", "g", "i4", "u1"])
def test_v15_other_precisions_are_the_upcast_values(kind: str) -> None:
    v = (BIG.vertices * 100 + 127).astype(kind)
    assert np.array_equal(Mesh(v, BIG.faces).vertices, v.astype(np.float64))


def test_v15_the_mesh_does_not_follow_later_changes_of_the_input() -> None:
    v, f = BIG.vertices.copy(), BIG.faces.copy()
    mesh = Mesh(v, f)
    v[:], f[:] = 0, 0
    assert np.array_equal(mesh.vertices, BIG.vertices) and np.array_equal(mesh.faces, BIG.faces)


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1e6, 1e12, 1e60, 1e-60])
def test_any_unit_is_accepted(scale: float) -> None:
    assert np.array_equal(Mesh(V * scale, F).vertices, V * scale)


def test_far_from_the_origin_is_accepted_while_areas_survive() -> None:
    assert Mesh(V + 1e8, F).n_faces == 4
    with pytest.raises(MeshError, match="E114"):
        Mesh(V + 1e17, F)


def test_v12_the_hint_works() -> None:
    quads = np.array([[0, 1, 2, 3], [4, 5, 6, 7]])
    assert triangulate(quads).tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]
    assert np.array_equal(triangulate(F), F)
    for wrong in ([[0, 1]], [[0, 1, -2]], [[0, 1, 0.5]], [0, 1, 2]):
        with pytest.raises(MeshError):
            triangulate(wrong)


anything = st.one_of(
    hnp.arrays(
        st.sampled_from(["f8", "f4", "i8", "u8", "i1", "?", "c16", "U3", "O"]),
        hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5),
        fill=st.nothing(),
    ),
    st.none(),
    st.integers(),
    st.text(max_size=3),
    st.lists(st.one_of(st.integers(), st.floats(), st.lists(st.integers(-5, 5), max_size=4)), max_size=5),
)


@settings(max_examples=300, deadline=None)
@given(vertices=anything, faces=anything)
def test_c1_anything_at_all_is_a_mesh_or_a_typed_error(vertices: Any, faces: Any) -> None:
    for v, f in ((vertices, faces), (V, faces), (vertices, F)):
        try:
            mesh = Mesh(v, f)
        except (MeshError, TypeError):
            continue
        assert np.isfinite(mesh.vertices).all()
        assert mesh.faces.min() >= 0 and mesh.faces.max() < mesh.n_vertices
