"""Cutting meshes apart where they are no surface: there and nowhere else, and what goes on flat stays together."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured import warnings
from odd_shapes import Odd, bow_tie, fin
from rare_shapes import strip
from shapes import icosphere, joined, rectangle, torus

from geodesics import Mesh
from geodesics.edges import face_components
from geodesics.repair import repair
from geodesics.splitting import split


@pytest.mark.parametrize("make", [fin, bow_tie])
def test_a_mesh_is_cut_where_it_is_no_surface_and_nowhere_else(make: Callable[[], Odd]) -> None:
    mesh = make().mesh
    apart, vertex = split(mesh)
    assert apart.n_vertices == mesh.n_vertices + (2 if make is fin else 1)
    assert np.array_equal(apart.vertices, mesh.vertices[vertex])
    assert np.array_equal(vertex[apart.faces], mesh.faces)
    assert np.array_equal(vertex[: mesh.n_vertices], np.arange(mesh.n_vertices))
    assert not warnings(apart) & {"W213", "W214"}
    sizes = np.bincount(face_components(apart))
    assert sorted(sizes) == ([1, 320] if make is fin else [320, 320])


def test_sound_meshes_are_not_cut() -> None:
    for mesh in (icosphere(1), torus(), rectangle(4, 4), strip(), joined(icosphere(0), icosphere(0))):
        assert split(mesh)[0] is mesh


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**31), n=st.integers(4, 9), m=st.integers(2, 30))
def test_any_soup_of_triangles_is_cut_into_surfaces(seed: int, n: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    soup = repair(Mesh(rng.standard_normal((n, 3)), [rng.choice(n, 3, replace=False) for _ in range(m)]))
    apart, vertex = split(soup.mesh)
    assert not warnings(apart) & {"W213", "W214"}
    assert np.array_equal(vertex[apart.faces], soup.mesh.faces)
    again = repair(apart, cut=True)
    assert np.array_equal(again.vertex, np.arange(apart.n_vertices))
