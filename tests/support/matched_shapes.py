"""Shapes that the tests of matching share, made and measured once, and meshes that differ only in how they are told."""

from __future__ import annotations

import functools

import generated_shapes as shapes
import numpy as np
from numpy.typing import NDArray

import gmds
from geodesics import Mesh
from gmds.shapes.figure import Figure
from gmds.surface.measured import Surface, measure


@functools.cache
def bumpy() -> Mesh:
    """A sphere with bumps and no symmetry, 162 vertices: a match takes under a second."""
    return shapes.bumpy_sphere(2)


@functools.cache
def animal(pose: str = "stand", seed: int = 0, n_vertices: int = 600) -> Figure:
    """The built-in animal with few vertices."""
    return gmds.shapes.quadruped(pose, seed=seed, n_vertices=n_vertices)


@functools.cache
def surface(mesh: Mesh) -> Surface:
    """The mesh measured for matching."""
    return measure(mesh)


@functools.cache
def permuted(mesh: Mesh, seed: int = 0) -> tuple[Mesh, NDArray[np.int64]]:
    """The mesh with its vertices in another order, and the new index (n,) of each vertex."""
    order = np.random.default_rng(seed).permutation(mesh.n_vertices)
    place = np.argsort(order)
    return Mesh(mesh.vertices[order], place[mesh.faces]), place


def shuffled(mesh: Mesh, seed: int = 0) -> Mesh:
    """The mesh with its faces in another order, each beginning at another corner."""
    rng = np.random.default_rng(seed)
    faces = mesh.faces[rng.permutation(mesh.n_faces)]
    turn = (np.arange(3) + rng.integers(0, 3, (len(faces), 1))) % 3
    return Mesh(mesh.vertices, np.take_along_axis(faces, turn, axis=1))


def reflected(mesh: Mesh, axis: int = 1) -> Mesh:
    """The mirror image in space; faces keep their order of corners and so face inwards."""
    return Mesh(mesh.vertices * np.where(np.arange(3) == axis, -1, 1), mesh.faces)


def mirror_vertices(mesh: Mesh, axis: int = 1) -> NDArray[np.int64]:
    """For each vertex (n,) of an exactly symmetric mesh the vertex that is its reflection."""
    keys = np.rint(mesh.vertices / np.ptp(mesh.vertices) * 1e6).astype(np.int64)
    place = {tuple(key): i for i, key in enumerate(keys)}
    return np.array([place[tuple(key)] for key in keys * np.where(np.arange(3) == axis, -1, 1)])
