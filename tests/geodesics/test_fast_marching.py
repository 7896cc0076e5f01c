"""Geodesic distance against exact answers: planes, cones, spheres, the hyperbolic plane, and exact geodesics."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import (
    bumpy_sphere,
    ellipsoid,
    icosphere,
    jittered,
    joined,
    moved,
    rectangle,
    torus,
    with_isolated,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from geodesics import GeodesicDistance, Mesh, Metric, SurfacePoints, embedded
from geodesics.metric import conformal

Floats = NDArray[np.float64]


def relative_error(found: Floats, true: Floats) -> Floats:
    """|found - true| / true where the truth is not zero."""
    off = true > 1e-9 * true.max()
    return np.abs(found - true)[off] / true[off]


def own_faces(mesh: Mesh) -> Metric:
    """The embedded metric as if it were any other: marched over the mesh's own faces."""
    metric = embedded(mesh)
    return Metric(mesh, metric.l_sq, metric.mass, None)


def at(mesh: Mesh, *vertices: int) -> SurfacePoints:
    return SurfacePoints.at_vertices(mesh, vertices)


def random_points(mesh: Mesh, count: int, seed: int = 0) -> SurfacePoints:
    rng = np.random.default_rng(seed)
    return SurfacePoints(mesh, rng.integers(0, mesh.n_faces, count), rng.dirichlet([1, 1, 1], count))


def planar(n: int = 14, stretch: float = 1.0) -> Mesh:
    """A flat square with random vertices inside, stretched along x."""
    mesh = jittered(rectangle(n, n), 0.12)
    border = (rectangle(n, n).vertices[:, :2] % 1 == 0).any(axis=1)
    flat = np.where(border[:, None], rectangle(n, n).vertices, mesh.vertices)
    return Mesh(flat * [stretch, 1, 0], mesh.faces)


@pytest.mark.parametrize("metric", [embedded, own_faces])
@pytest.mark.parametrize(("stretch", "mean", "worst"), [(1.0, 1e-6, 1e-4), (6.0, 1e-4, 4e-3)])
def test_plane(metric, stretch: float, mean: float, worst: float) -> None:
    """Straight lines, from vertices and from points inside faces; triangles up to 170 degrees when stretched."""
    mesh = planar(stretch=stretch)
    for points in (at(mesh, 0, 100, 112), random_points(mesh, 5)):
        true = np.linalg.norm(mesh.vertices - points.positions[:, None], axis=2)
        error = relative_error(GeodesicDistance(metric(mesh)).field(points), true)
        assert error.mean() < mean and error.max() < worst


def test_obtuse_strip() -> None:
    """A strip cut into triangles of 170 degrees and more, three of them across."""
    x = np.arange(40.0)
    vertices = np.concatenate([np.stack([x + 0.5 * (k % 2), np.full(40, 0.04 * k), 0 * x], axis=1) for k in range(4)])
    i = np.arange(39)
    even = np.concatenate([np.stack([i, i + 1, i + 40], 1), np.stack([i + 1, i + 41, i + 40], 1)])
    odd = np.concatenate([np.stack([i, i + 1, i + 41], 1), np.stack([i, i + 41, i + 40], 1)])
    mesh = Mesh(vertices, np.concatenate([even, odd + 40, even + 80]))
    true = np.stack([exact(mesh, v) for v in (0, 60)])
    assert relative_error(GeodesicDistance(embedded(mesh)).field(at(mesh, 0, 60)), true).max() < 1e-6
    assert relative_error(GeodesicDistance(own_faces(mesh)).field(at(mesh, 60))[0], true[1]).max() < 1e-6


@pytest.mark.parametrize("opening", [0.7 * np.pi, 1.6 * np.pi, 3.0 * np.pi])
def test_cone(opening: float) -> None:
    """Unrolled: straight while the angle at the tip is below pi, else past the tip, also for a saddle (3 pi)."""
    rings, spokes = 24, 48
    r, phi = np.meshgrid(np.arange(1, rings + 1) / rings, np.arange(spokes) * opening / spokes, indexing="ij")
    r, phi = r.ravel(), phi.ravel()
    i, j = (a.ravel() for a in np.meshgrid(np.arange(rings - 1), np.arange(spokes), indexing="ij"))
    a, b, c, d = (
        i * spokes + j,
        i * spokes + (j + 1) % spokes,
        (i + 1) * spokes + j,
        (i + 1) * spokes + (j + 1) % spokes,
    )
    tip = len(r)
    ring = np.arange(spokes)
    fan = np.stack([np.full(spokes, tip), ring, (ring + 1) % spokes], 1)
    faces = np.concatenate([fan, np.stack([a, c, d], 1), np.stack([a, d, b], 1)])
    apart = np.array(
        [np.append(phi, 0)[faces[:, k]] - np.append(phi, 0)[faces[:, m]] for k, m in ((1, 2), (2, 0), (0, 1))]
    ).T
    apart = np.minimum(np.abs(apart) % opening, opening - np.abs(apart) % opening)
    radius = np.append(r, 0.0)[faces]
    p, q = radius[:, [1, 2, 0]], radius[:, [2, 0, 1]]
    l_sq = (p - q) ** 2 + 4 * p * q * np.sin(apart / 2) ** 2
    mesh = Mesh(np.random.default_rng(0).standard_normal((tip + 1, 3)), faces)  # only the lengths matter
    source = 11 * spokes
    found = GeodesicDistance(Metric(mesh, l_sq, np.ones(tip + 1))).field(at(mesh, source))[0, :tip]
    turn = np.minimum(phi, opening - phi)
    straight = np.sqrt(np.maximum(r**2 + r[source] ** 2 - 2 * r * r[source] * np.cos(turn), 0))
    true = np.where(turn < np.pi, straight, r + r[source])
    error = relative_error(found, true)
    assert error.mean() < 1.5e-3 and error.max() < 0.02


@pytest.mark.parametrize(("subdivisions", "mean"), [(2, 1.2e-2), (3, 3.2e-3), (4, 8.5e-4)])
def test_sphere(subdivisions: int, mean: float) -> None:
    """Great circles; the polyhedron itself is off by 1.0, 0.27 and 0.07 %."""
    mesh = icosphere(subdivisions)
    points = at(mesh, 0, 5, 100)
    true = np.arccos(np.clip(points.positions @ mesh.vertices.T, -1, 1))
    assert relative_error(GeodesicDistance(embedded(mesh)).field(points), true).mean() < mean


@pytest.mark.parametrize(("n", "mean", "worst"), [(20, 2.5e-3, 0.03), (40, 6e-4, 0.02)])
def test_hyperbolic_plane(n: int, mean: float, worst: float) -> None:
    """rho = 1 / y^2 on the half plane: cosh d = 1 + |p - q|^2 / (2 y_p y_q)."""
    mesh = planar(n)
    mesh = Mesh(mesh.vertices * [2, 1.5, 0] + [-1, 0.5, 0], mesh.faces)
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    source = int(np.argmin((x + 0.3) ** 2 + (y - 1) ** 2))
    true = np.arccosh(1 + ((x - x[source]) ** 2 + (y - y[source]) ** 2) / (2 * y * y[source]))
    found = GeodesicDistance(conformal(mesh, y**-2.0)).field(at(mesh, source))[0]
    inside = (np.abs(x) < 0.7) & (y > 0.7)  # whose geodesics do not leave the square
    error = relative_error(found[inside], true[inside])
    assert error.mean() < mean and error.max() < worst


def test_metric_that_does_not_agree_across_edges() -> None:
    """G = J^T J of a plane map, sampled once a face, so neighbours differ: distances converge to those of the image."""
    errors = []
    for n in (10, 20, 40):
        mesh = planar(n)
        x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
        image = np.stack([x + 0.3 * x**2, 0.8 * y + 0.2 * x * y], axis=1)
        cx, cy = x[mesh.faces].mean(axis=1), y[mesh.faces].mean(axis=1)
        jacobian = np.stack([np.stack([1 + 0.6 * cx, 0 * cx], 1), np.stack([0.2 * cy, 0.8 + 0.2 * cx], 1)], axis=1)
        edges = mesh.vertices[mesh.faces[:, [2, 0, 1]], :2] - mesh.vertices[mesh.faces[:, [1, 2, 0]], :2]
        l_sq = (np.einsum("fij,fej->fei", jacobian, edges) ** 2).sum(axis=2)
        source = int(np.argmin((x - 0.5) ** 2 + (y - 0.5) ** 2))
        found = GeodesicDistance(Metric(mesh, l_sq, np.ones(mesh.n_vertices))).field(at(mesh, source))[0]
        errors.append(relative_error(found, np.linalg.norm(image - image[source], axis=1)).mean())
    assert errors[2] < errors[0] / 2 and errors[2] < 2e-3


def exact(mesh: Mesh, vertex: int) -> Floats:
    """Exact polyhedral geodesics (Mitchell, Mount, Papadimitriou 1987, by Kirsanov)."""
    geodesic = pytest.importorskip("pygeodesic.geodesic")
    algorithm = geodesic.PyGeodesicAlgorithmExact(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32))
    return algorithm.geodesicDistances(np.array([vertex]), None)[0]


@pytest.mark.parametrize("metric", [embedded, own_faces])
@pytest.mark.parametrize(
    ("mesh", "mean"),
    [(bumpy_sphere(3), 3e-4), (torus(48, 24), 5e-4), (ellipsoid(3, (0.3, 1.0, 2.0)), 2e-3), (torus(60, 9), 2e-3)],
    ids=["bumps", "torus", "flat ellipsoid", "long triangles"],
)
def test_exact_geodesics(metric, mesh: Mesh, mean: float) -> None:
    found = GeodesicDistance(metric(mesh)).field(at(mesh, 0, 77))
    true = np.stack([exact(mesh, v) for v in (0, 77)])
    assert relative_error(found, true).mean() < mean


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="needs GMDS_DATA")
def test_exact_geodesics_on_a_mesh_of_slivers() -> None:
    from geodesics import read_mesh

    mesh = read_mesh(Path(os.environ["GMDS_DATA"]) / "tosca_5k" / "cat0.off")
    found, true = GeodesicDistance(embedded(mesh)).field(at(mesh, 100, 3000)), [exact(mesh, v) for v in (100, 3000)]
    assert relative_error(found, np.stack(true)).mean() < 1e-3


def test_points_inside_faces_equal_new_vertices_there() -> None:
    """A point of a face as source is as good as a vertex put there."""
    mesh = Mesh(bumpy_sphere(3).vertices * [0.3, 1, 1], bumpy_sphere(3).faces)  # most edges are flipped
    points = random_points(mesh, 6)
    found = GeodesicDistance(embedded(mesh)).field(points)
    for i in range(len(points)):
        a, b, c = mesh.faces[points.face[i]]
        v = mesh.n_vertices
        rest = np.delete(mesh.faces, points.face[i], axis=0)
        split = Mesh(
            np.vstack([mesh.vertices, points.positions[i]]), np.vstack([rest, [[a, b, v], [b, c, v], [c, a, v]]])
        )
        error = relative_error(found[i], exact(split, v)[:v])
        assert error.mean() < 2e-3 and error.max() < 0.05


def test_points_on_edges_and_vertices_are_continuous() -> None:
    mesh = bumpy_sphere(2)
    face = mesh.faces[10]
    tiny = 1e-9
    weights = [[1, 0, 0], [1 - 2 * tiny, tiny, tiny], [0.5, 0.5, 0], [0.5 - tiny, 0.5 - tiny, 2 * tiny]]
    found = GeodesicDistance(embedded(mesh)).field(SurfacePoints(mesh, np.full(4, 10), weights))
    np.testing.assert_allclose(found[1], found[0], atol=1e-6)
    np.testing.assert_allclose(found[3], found[2], atol=1e-6)
    assert found[0, face[0]] == 0
    np.testing.assert_allclose(found[2, face[0]], found[2, face[1]])


def test_symmetry_and_triangle_inequality() -> None:
    mesh = bumpy_sphere(3)
    some = np.arange(0, mesh.n_vertices, 23)
    d = GeodesicDistance(embedded(mesh)).field(at(mesh, *some))[:, some]
    np.testing.assert_allclose(d, d.T, atol=4e-3 * d.max())
    assert (d[:, None] <= d[:, :, None] + d[None] + 2e-3 * d.max()).all()
    assert (np.diag(d) == 0).all() and (d + np.eye(len(d)) > 0).all()


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e6])
def test_scale_and_motion(scale: float) -> None:
    mesh = Mesh(bumpy_sphere(2).vertices * [0.3, 1, 1], bumpy_sphere(2).faces)
    here = GeodesicDistance(embedded(mesh)).field(at(mesh, 3, 50))
    there = GeodesicDistance(embedded(moved(mesh, scale))).field(at(moved(mesh, scale), 3, 50))
    np.testing.assert_allclose(there, here * scale, rtol=2e-3)
    assert relative_error(there, here * scale).mean() < 1e-4


def test_constant_conformal_factor_scales_distances() -> None:
    mesh = bumpy_sphere(2)
    plain = GeodesicDistance(embedded(mesh)).field(at(mesh, 3))
    np.testing.assert_allclose(
        GeodesicDistance(conformal(mesh, np.full(mesh.n_vertices, 9.0))).field(at(mesh, 3)), 3 * plain
    )


def test_unreachable_is_infinite() -> None:
    mesh = with_isolated(joined(icosphere(1), icosphere(1)))
    found = GeodesicDistance(embedded(mesh)).field(at(mesh, 1))[0]
    component = mesh.vertices[:, 0] < 2
    used = np.isin(np.arange(mesh.n_vertices), mesh.faces)
    assert np.isfinite(found[component & used]).all() and np.isinf(found[~used]).all()
    assert np.isinf(found[~component]).all()


def test_distance_to_a_set_is_the_least_of_its_fields() -> None:
    mesh = bumpy_sphere(3)
    distance, points, values = GeodesicDistance(embedded(mesh)), random_points(mesh, 5), np.array([0, 0.3, 0, 0.1, 0.2])
    fields = distance.field(points)
    for start in (np.zeros(5), values):
        least = (fields + start[:, None]).min(axis=0)
        error = relative_error(distance.to_set(points, values=start), least)
        assert error.mean() < 1e-3 and error.max() < 0.03  # it is the borders between cells that differ
    np.testing.assert_array_equal(distance.to_set(points), distance.to_set(points, values=np.zeros(5)))
    with pytest.raises(ValueError, match="values must be 5"):
        distance.to_set(points, values=[0.0])
    with pytest.raises(ValueError, match="values must be 5"):
        distance.to_set(points, values=[0.0, 1, 2, 3, np.nan])


def test_early_stop_changes_nothing_before_it() -> None:
    mesh = Mesh(bumpy_sphere(3).vertices * [0.4, 1, 1], bumpy_sphere(3).faces)
    distance, points = GeodesicDistance(embedded(mesh)), at(mesh, 10)
    full = distance.field(points)[0]
    near = full < 0.5
    limited = distance.field(points, limit=0.5)[0]
    np.testing.assert_allclose(limited[near], full[near], rtol=1e-3)
    assert np.isinf(limited[full > 0.51]).all()
    wanted = np.argsort(full)[[50, 60, 70]]
    stopped = distance.to_set(points, stop=wanted)
    np.testing.assert_array_equal(stopped[wanted], full[wanted])
    assert 70 < np.isfinite(stopped).sum() < mesh.n_vertices / 2


@pytest.mark.parametrize("threads", [1, 3, 8])
def test_threads_do_not_change_a_bit(threads: int) -> None:
    mesh = bumpy_sphere(2)
    points = random_points(mesh, 7)
    once = np.concatenate([GeodesicDistance(embedded(mesh), 1).field(points[i]) for i in range(7)])
    np.testing.assert_array_equal(GeodesicDistance(embedded(mesh), threads).field(points), once)


def test_no_points_and_tiny_meshes() -> None:
    triangle = Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    distance = GeodesicDistance(embedded(triangle))
    assert distance.field(random_points(triangle, 0)).shape == (0, 3)
    np.testing.assert_allclose(distance.field(at(triangle, 1)), [[3, 0, 5]])
    middle = SurfacePoints(triangle, [0], [[1 / 3, 1 / 3, 1 / 3]])
    np.testing.assert_allclose(distance.field(middle)[0], np.linalg.norm(triangle.vertices - middle.positions, axis=1))


def test_non_manifold_edges_are_crossed() -> None:
    """Three pages on one spine: from one page to the next is as far as unfolded flat."""
    pages = [[np.cos(a), np.sin(a), 0.5] for a in (0, 2, 4)]
    book = Mesh([[0, 0, 0], [0, 0, 1], *pages], [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    found = GeodesicDistance(embedded(book)).field(at(book, 2))[0]
    np.testing.assert_allclose(found, [1.25**0.5, 1.25**0.5, 0, 2, 2])


def test_repeated_improper_and_turned_faces_change_nothing() -> None:
    mesh = Mesh(bumpy_sphere(2).vertices * [0.4, 1, 1], bumpy_sphere(2).faces)
    faces = np.concatenate([mesh.faces, mesh.faces[:4], [[4, 4, 9]]])
    odd = Mesh(mesh.vertices, np.where(np.arange(len(faces))[:, None] % 5 == 0, faces[:, ::-1], faces))
    points, same = (
        SurfacePoints(mesh, [7, 20], [[0.2, 0.3, 0.5]] * 2),
        SurfacePoints(odd, [7, 20], [[0.2, 0.3, 0.5], [0.5, 0.3, 0.2]]),
    )
    here, there = (GeodesicDistance(embedded(p.mesh)).field(p) for p in (points, same))
    np.testing.assert_allclose(there, here, rtol=1e-2, atol=1e-2 * here.max())
    on_odd = SurfacePoints(odd, [len(faces) - 1, mesh.n_faces], [[0.5, 0.5, 0], [0.2, 0.3, 0.5]])
    found = GeodesicDistance(embedded(odd)).field(on_odd)
    assert np.isfinite(found).all() and found[0, 4] < 1e-9


@settings(max_examples=80, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.integers(3, 14), st.integers(1, 30), st.sampled_from([0.0, 1e-7, 0.3]), st.booleans()
)
def test_any_soup_of_triangles(seed: int, n: int, m: int, spread: float, flipped: bool) -> None:
    """Coincident points, slivers, edges of many faces: ends, reaches what edges reach, and is not far off."""
    rng = np.random.default_rng(seed)
    vertices = rng.integers(0, 3, (n, 3)) + spread * rng.standard_normal((n, 3))
    vertices[:3] = np.eye(3) * 4
    mesh = Mesh(vertices, np.concatenate([[[0, 1, 2]], rng.integers(0, n, (m, 3))]))
    distance = GeodesicDistance(embedded(mesh) if flipped else own_faces(mesh))
    found = distance.field(random_points(mesh, 4, seed))
    assert not np.isnan(found).any() and (found >= 0).all() and np.isfinite(found).any()
    sources = np.unique(mesh.faces[[len(set(face)) == 3 for face in mesh.faces.tolist()]])
    found, edges = distance.field(at(mesh, *sources)), dijkstra(mesh, sources)
    np.testing.assert_array_equal(np.isfinite(found), np.isfinite(edges))
    reached = np.isfinite(edges)
    straight = np.linalg.norm(mesh.vertices - mesh.vertices[sources][:, None], axis=2)
    assert (found >= straight * 0.25 - 1e-6)[reached].all() and (found <= edges * 1.6 + 1e-6)[reached].all()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(8, 60), st.sampled_from([0.05, 0.3, 1.0]), st.sampled_from([0.0, 0.4]))
def test_random_polyhedra(seed: int, n: int, height: float, dents: float) -> None:
    """Hulls of a few random points, flat or not, convex or dented: as coarse as can be, and yet near the exact."""
    rng = np.random.default_rng(seed)
    points = rng.standard_normal((n, 3)) * [1, 1, height]
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    inward = (
        np.einsum(
            "fi,fi->f", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), hull.equations[:, :3]
        )
        < 0
    )
    faces = np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)
    used = np.unique(faces)
    mesh = Mesh(points[used] * (1 + dents * rng.uniform(-1, 1, (len(used), 1))), np.searchsorted(used, faces))
    true = exact(mesh, 0)
    for metric in (embedded, own_faces):
        error = relative_error(GeodesicDistance(metric(mesh)).field(at(mesh, 0))[0], true)
        assert error.mean() < 0.1 and error.max() < 0.6


def dijkstra(mesh: Mesh, sources: NDArray[np.int64]) -> Floats:
    """Shortest paths along edges."""
    length = np.full((mesh.n_vertices, mesh.n_vertices), np.inf)
    np.fill_diagonal(length, 0)
    proper = mesh.faces[[len(set(face)) == 3 for face in mesh.faces.tolist()]]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        i, j = proper[:, a], proper[:, b]
        length[i, j] = length[j, i] = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    for k in range(mesh.n_vertices):
        length = np.minimum(length, length[:, k : k + 1] + length[k : k + 1])
    return length[sources]
