"""Mesh and its promises: frozen, picklable, errors that survive a process boundary."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from generated_shapes import icosphere

from geodesics import Mesh
from geodesics.errors import FormatError, IndexOutOfRange, MeshError


def test_arrays_are_frozen_c_ordered_and_of_one_type() -> None:
    mesh = icosphere(1)
    for array, kind in ((mesh.vertices, np.float64), (mesh.faces, np.int64)):
        assert array.dtype == kind and array.flags.c_contiguous and not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(AttributeError):
        mesh.vertices = mesh.vertices  # type: ignore[misc]


def test_counts_and_representation() -> None:
    mesh = icosphere(0)
    assert (mesh.n_vertices, mesh.n_faces) == (12, 20)
    assert repr(mesh) == "Mesh(12 vertices, 20 faces)"


def test_a_pickled_mesh_is_the_same_and_frozen_again() -> None:
    mesh = icosphere(1)
    copy = pickle.loads(pickle.dumps(mesh))
    assert copy.vertices.tobytes() == mesh.vertices.tobytes() and copy.faces.tobytes() == mesh.faces.tobytes()
    assert not copy.vertices.flags.writeable and not copy.faces.flags.writeable


def test_errors_are_value_errors_and_survive_pickling() -> None:
    assert issubclass(MeshError, ValueError) and issubclass(FormatError, ValueError)
    with pytest.raises(IndexOutOfRange) as caught:
        Mesh(np.eye(3), [[0, 1, 5]])
    copy = pickle.loads(pickle.dumps(caught.value))
    assert type(copy) is IndexOutOfRange and str(copy) == str(caught.value)


def test_every_error_has_its_own_code() -> None:
    def family(base: type) -> list[type]:
        return [c for direct in base.__subclasses__() for c in (direct, *family(direct))]

    for base in (MeshError, FormatError):
        ours = [c for c in family(base) if c.__module__.startswith("geodesics")]
        codes = [c.code for c in (base, *ours)]  # type: ignore[attr-defined]
        assert len(ours) >= 10 and len(set(codes)) == len(codes)
