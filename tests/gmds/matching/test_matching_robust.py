"""Surfaces that are hard to match, or damaged: every row must be finite, and nothing may warn."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import bumpy

import gmds
from geodesics import Mesh, read_mesh
from gmds import Correspondence
from gmds.maps.point_map import MatchStatus


def checked(source: Mesh, target: Mesh) -> Correspondence:
    """The map, with what every map must have."""
    n = source.n_vertices
    answer = gmds.match(source, target, n_samples=min(50, len(np.unique(source.faces))))
    assert answer.points.face.shape == answer.valid.shape == answer.distortion.shape == (n,)
    assert np.isfinite(answer.points.positions).all()
    assert np.isfinite(answer.distortion).all() and (answer.distortion >= 0).all()
    assert np.isfinite(list(numbers(answer.meta["evidence"]))).all()
    for candidate in answer.candidates:
        assert np.isfinite([candidate.stress, candidate.orientation]).all()
    return answer


def numbers(told: Any) -> Iterator[float]:
    """All numbers in a nest of dictionaries."""
    for value in told.values():
        yield from numbers(value) if isinstance(value, dict) else [value]


def off(answer: Correspondence, positions: np.ndarray) -> np.ndarray:
    """Distances (n,) of the images from positions, over the extent of the target."""
    return np.linalg.norm(answer.points.positions - positions, axis=1) / np.ptp(answer.target.vertices)


def disc_with_holes() -> Mesh:
    disc = shapes.disc(8)
    x, y, _ = disc.vertices[disc.faces].mean(axis=1).T
    faces = disc.faces[(np.hypot(x - 0.4, y) > 0.2) & (np.hypot(x + 0.3, y - 0.3) > 0.15)]
    used, compact = np.unique(faces, return_inverse=True)
    return Mesh(disc.vertices[used], compact.reshape(-1, 3))


def moebius(n: int = 30) -> Mesh:
    u, v, faces = shapes.grid(n, 4, wrap_x=True)
    i, j = faces // 5, faces % 5
    seam = (i.max(axis=1) == n - 1) & (i.min(axis=1) == 0)
    j = np.where(seam[:, None] & (i == 0), 4 - j, j)
    angle, width = 2 * np.pi * u, v - 0.5
    r = 1 + width * np.cos(angle / 2)
    return Mesh(np.stack([r * np.cos(angle), r * np.sin(angle), width * np.sin(angle / 2)], axis=1), 5 * i + j)


SURFACES = {
    "disc": lambda: shapes.disc(6),
    "disc with holes": disc_with_holes,
    "rectangle": lambda: shapes.rectangle(12, 10, 1.0, 1.7),
    "rectangle in general position": lambda: shapes.moved(shapes.rectangle(12, 10, 1.0, 1.7), 1e3, seed=1),
    "square": lambda: shapes.rectangle(10, 10),
    "cylinder": lambda: shapes.cylinder(16, 8),
    "torus": lambda: shapes.torus(20, 10),
    "sphere": lambda: shapes.icosphere(2),
    "cube": lambda: shapes.cube(4),
    "moebius strip": moebius,
    "coarse": lambda: shapes.ellipsoid(1, (1, 1.5, 2)),
    "icosahedron": lambda: shapes.icosphere(0),
}


FLAT = ("disc", "disc with holes", "rectangle", "rectangle in general position", "square")


@pytest.mark.parametrize("name", SURFACES)
def test_special_surfaces_are_mapped_to_themselves_without_stress(name: str) -> None:
    mesh = SURFACES[name]()
    answer = checked(mesh, mesh)
    assert answer.valid.all()
    assert answer.meta["evidence"]["stress"] < 0.05  # an isometry, if not the identity
    assert answer.status is not MatchStatus.POOR or name == "icosahedron"  # too few vertices to turn freely
    if name in FLAT and name != "square":
        assert off(answer, mesh.vertices).max() < 1e-9 or answer.meta["evidence"]["stress"] < 1e-3


def test_surfaces_of_different_kinds_are_matched_poorly_but_finitely() -> None:
    assert checked(bumpy(), shapes.torus(20, 10)).status is MatchStatus.POOR
    checked(bumpy(), shapes.icosphere(0))
    checked(shapes.icosphere(0), bumpy())


def test_isolated_vertices_are_kept_and_have_no_counterpart() -> None:
    source = shapes.with_isolated(bumpy())
    answer = checked(source, source)
    used = np.bincount(source.faces.ravel(), minlength=source.n_vertices) > 0
    assert np.array_equal(answer.valid, used)
    assert off(answer, source.vertices)[used].max() < 1e-9


def test_a_small_second_component_has_no_counterpart() -> None:
    both = shapes.joined(bumpy(), shapes.icosphere(1, 0.3))
    n = bumpy().n_vertices
    answer = checked(both, bumpy())
    assert answer.valid[:n].all() and not answer.valid[n:].any()
    assert off(answer, np.concatenate([bumpy().vertices, np.zeros((42, 3))]))[:n].max() < 1e-9
    onto = checked(bumpy(), both)
    assert onto.valid.all()
    assert (onto.vertex_map() < n).all()


def test_duplicate_vertices_and_degenerate_faces_change_little() -> None:
    n = bumpy().n_vertices
    vertices = np.concatenate([bumpy().vertices, bumpy().vertices[:3]])
    extra = [[4, 4, 9], [0, n, 1], [5, 6, 6], [7, 7, 7], *bumpy().faces[:2]]
    damaged = Mesh(vertices, np.concatenate([bumpy().faces, extra]))
    for source, target in ((damaged, bumpy()), (bumpy(), damaged)):
        answer = checked(source, target)
        assert answer.valid[:n].all()
        assert off(answer, source.vertices)[:n].mean() < 0.01


def test_an_edge_of_three_faces_is_no_obstacle() -> None:
    a, b, _ = bumpy().faces[10]
    fin = np.concatenate([bumpy().vertices, 1.3 * bumpy().vertices[[a]]])
    mesh = Mesh(fin, np.concatenate([bumpy().faces, [[a, b, bumpy().n_vertices]]]))
    answer = checked(mesh, mesh)
    assert answer.valid.all()
    assert off(answer, mesh.vertices).mean() < 1e-3


def test_two_surfaces_that_meet_in_a_vertex_are_one() -> None:
    n = bumpy().n_vertices
    other = np.where(bumpy().faces == 0, 0, bumpy().faces + n)[:, ::-1]
    vertices = np.concatenate([bumpy().vertices, 2 * bumpy().vertices[0] - bumpy().vertices])
    mesh = Mesh(vertices, np.concatenate([bumpy().faces, other]))
    answer = checked(mesh, mesh)
    assert answer.valid.sum() == 2 * n - 1


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="GMDS_DATA is not set")
def test_a_real_mesh_with_edges_of_many_faces_is_matched() -> None:
    from geodesics.topology.edges import edges

    folder = Path(os.environ["GMDS_DATA"]) / "tosca_nonrigid_3k"
    for path in sorted(folder.glob("*.vert")):
        mesh = read_mesh(path)
        if (edges(mesh).n_faces > 2).any():
            break
    else:
        pytest.skip("all meshes are manifold")
    answer = checked(mesh, mesh)
    assert off(answer, mesh.vertices)[answer.valid].mean() < 0.02
