"""Strain of triangles whose corners move: how much longer one way than across, and which way."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats, Integers

MOST_STRAIN = 2.0  # of half log s1/s2 of one triangle, a bound: more is a triangle that the map all but collapses
THINNEST = 1e-6  # breadth over length of a triangle, below which nothing is known across it: a bound


def frames(vertices: Floats, faces: Integers) -> tuple[Floats, Floats]:
    """Two orthonormal tangents (m, 2, 3) of each face, and two of its edges (m, 2, 3)."""
    run = vertices[faces[:, 1:]] - vertices[faces[:, :1]]
    tiny = np.finfo(float).tiny
    one = run[:, 0] / np.maximum(np.linalg.norm(run[:, 0], axis=1, keepdims=True), tiny)
    other = run[:, 1] - (run[:, 1] * one).sum(axis=1, keepdims=True) * one
    other /= np.maximum(np.linalg.norm(other, axis=1, keepdims=True), tiny)
    return np.stack([one, other], axis=1), run


def log_strain(vertices: Floats, faces: Integers, rise: Floats) -> Floats:
    """The trace-free logarithmic strain (m, 3, 3) of each face, whose edges become `rise` (m, 2, 3)."""
    frame, run = frames(vertices, faces)
    flat = np.einsum("mei,mki->mek", run, frame)  # edges in the frame of their face
    gradient = np.einsum("mke,mei->mki", np.linalg.pinv(flat, rcond=THINNEST), rise)
    metric = np.einsum("mki,mli->mkl", gradient, gradient)
    values, vectors = np.linalg.eigh(metric)
    logs = np.log(np.maximum(values, np.finfo(float).tiny))
    shear = np.clip(0.25 * (logs[:, 1] - logs[:, 0]), 0.0, MOST_STRAIN)
    axes = np.einsum("mkj,mki->mji", vectors, frame)
    outer = axes[:, 1, :, None] * axes[:, 1, None, :] - axes[:, 0, :, None] * axes[:, 0, None, :]
    return np.asarray(shear[:, None, None] * outer, dtype=np.float64)


def square(strain: Floats) -> Floats:
    """The square (m,) of half log s1/s2 of trace-free strains (m, 3, 3)."""
    return np.asarray(0.5 * (strain**2).sum(axis=(1, 2)), dtype=np.float64)


def principal(strain: Floats, normals: Floats) -> tuple[Floats, Floats]:
    """Half of log s1/s2 (n,), and the direction of s1 (n, 3), of trace-free strains (n, 3, 3) of tangent planes."""
    across = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    flat = across @ strain @ across
    values, vectors = np.linalg.eigh((flat + np.swapaxes(flat, 1, 2)) / 2)
    return np.asarray((values[:, 2] - values[:, 0]) / 2, dtype=np.float64), vectors[:, :, 2].copy()
