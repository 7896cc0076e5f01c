"""Small generated surfaces for the tests; each function returns a `Mesh`."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics import Mesh


def icosphere(subdivisions: int = 3, radius: float = 1.0) -> Mesh:
    """Sphere from an icosahedron: 10 * 4^subdivisions + 2 vertices."""
    golden = (1 + 5**0.5) / 2
    v = np.array([[s, t * golden, 0.0] for s in (-1, 1) for t in (-1, 1)])
    v = np.concatenate([v, v[:, [2, 0, 1]], v[:, [1, 2, 0]]])
    near = np.linalg.norm(v[:, None] - v, axis=2) < 2.1
    triples = [t for t in combinations(range(12), 3) if all(near[i, j] for i, j in combinations(t, 2))]
    f = np.array([t if np.linalg.det(v[list(t)]) > 0 else t[::-1] for t in triples])
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    for _ in range(subdivisions):
        v, f = _subdivided(v, f)
        v /= np.linalg.norm(v, axis=1, keepdims=True)
    return Mesh(radius * v, f)


def _subdivided(v: NDArray, f: NDArray) -> tuple[NDArray, NDArray]:
    """One triangle into four, midpoints shared."""
    edges = np.sort(f[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    m = len(v) + inverse.reshape(-1, 3)
    corners = [[f[:, 0], m[:, 2], m[:, 1]], [f[:, 1], m[:, 0], m[:, 2]], [f[:, 2], m[:, 1], m[:, 0]], m.T]
    return np.concatenate([v, v[unique].mean(axis=1)]), np.concatenate([np.stack(c, axis=1) for c in corners])


def subdivided(mesh: Mesh) -> Mesh:
    """Every triangle cut into four flat ones: the same surface, exactly."""
    return Mesh(*_subdivided(mesh.vertices, mesh.faces))


def bumpy_sphere(subdivisions: int = 3, seed: int = 0, height: float = 0.25) -> Mesh:
    """Sphere with smooth radial bumps and no symmetry."""
    sphere = icosphere(subdivisions)
    rng = np.random.default_rng(seed)
    centres = rng.standard_normal((7, 3))
    centres /= np.linalg.norm(centres, axis=1, keepdims=True)
    weights = rng.uniform(-0.5, 1, 7)
    bumps = (weights * np.exp(6 * (sphere.vertices @ centres.T - 1))).sum(axis=1)
    return Mesh(sphere.vertices * (1 + height * 2 * bumps)[:, None], sphere.faces)


def ellipsoid(subdivisions: int = 3, axes: ArrayLike = (1.0, 1.4, 2.0)) -> Mesh:
    """Ellipsoid with the given half axes."""
    sphere = icosphere(subdivisions)
    return Mesh(sphere.vertices * np.asarray(axes), sphere.faces)


def grid(nx: int, ny: int, wrap_x: bool = False, wrap_y: bool = False) -> tuple[NDArray, NDArray, NDArray]:
    """Parameters u, v in [0, 1] and faces of an nx by ny grid of quads, each cut in two; wrapped sides are glued."""
    cols, rows = nx + (not wrap_x), ny + (not wrap_y)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"))
    a, b = i * rows + j, ((i + 1) % cols) * rows + j
    c, d = ((i + 1) % cols) * rows + (j + 1) % rows, i * rows + (j + 1) % rows
    flip = (i + j) % 2 == 0
    first = np.where(flip[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(flip[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    u, v = np.meshgrid(np.arange(cols) / nx, np.arange(rows) / ny, indexing="ij")
    return u.ravel(), v.ravel(), np.concatenate([first, second])


def rectangle(nx: int = 20, ny: int = 20, width: float = 1.0, height: float = 1.0) -> Mesh:
    """Flat rectangle in the plane z = 0."""
    u, v, f = grid(nx, ny)
    return Mesh(np.stack([width * u, height * v, 0 * u], axis=1), f)


def disc(rings: int = 12, radius: float = 1.0) -> Mesh:
    """Flat disc: a square grid bent so that squares become circles."""
    u, v, f = grid(2 * rings, 2 * rings)
    x, y = 2 * u - 1, 2 * v - 1
    longest, length = np.maximum(abs(x), abs(y)), np.hypot(x, y)
    stretch = radius * np.divide(longest, length, out=np.zeros_like(length), where=length > 0)
    return Mesh(np.stack([x * stretch, y * stretch, 0 * x], axis=1), f)


def torus(nu: int = 48, nv: int = 24, major: float = 1.0, minor: float = 0.4) -> Mesh:
    """Torus around the z axis; normals point outwards."""
    u, v, f = grid(nu, nv, wrap_x=True, wrap_y=True)
    u, v = 2 * np.pi * u, 2 * np.pi * v
    r = major + minor * np.cos(v)
    return Mesh(np.stack([r * np.cos(u), r * np.sin(u), minor * np.sin(v)], axis=1), f)


def cylinder(nu: int = 32, nv: int = 16, radius: float = 1.0, height: float = 2.0) -> Mesh:
    """Open cylinder around the z axis."""
    u, v, f = grid(nu, nv, wrap_x=True)
    return Mesh(np.stack([radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u), height * v], axis=1), f)


def cube(n: int = 6) -> Mesh:
    """Surface of the cube [-1, 1]^3 with n by n quads a side, corners and edges shared, fully symmetric."""
    u, v, f = grid(n, n)
    x, y = np.rint(2 * n * u).astype(int) - n, np.rint(2 * n * v).astype(int) - n
    points, faces = [], []
    for axis in range(3):
        for side in (-n, n):
            p = np.empty((len(x), 3), dtype=int)
            p[:, axis], p[:, (axis + 1) % 3], p[:, (axis + 2) % 3] = side, x, y
            faces.append((f if side > 0 else f[:, ::-1]) + sum(len(q) for q in points))
            points.append(p)
    unique, inverse = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return Mesh(unique / n, inverse.ravel()[np.concatenate(faces)])


def tetrahedron() -> Mesh:
    """Regular tetrahedron."""
    v = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    return Mesh(v, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])


def dumbbell(scale: float = 1.0, neck: float = 0.2, length: float = 1.5) -> Mesh:
    """Two bumpy balls joined by a cone, the upper one `scale` times as large; vertex i stays the same point."""
    sphere = icosphere(4)
    t, around = sphere.vertices[:, 2], np.arctan2(sphere.vertices[:, 1], sphere.vertices[:, 0])
    joint, ball = np.sqrt(1 - neck**2), np.abs(t) >= 0.5
    cos = np.clip(1 - 2 * (1 - np.abs(t)) * (1 + joint), -joint, 1)  # of the angle from the pole of each ball
    size = np.where(t > 0, scale, 1.0)
    r = np.where(ball, size * np.sqrt(1 - cos**2), neck * (1 + (scale - 1) * (t + 0.5)))
    middle = length * (1 + scale) / 2
    z = np.where(ball, np.sign(t) * (middle / 2 + size * (joint + cos)), t * middle)
    r *= 1 + 0.25 * np.exp(-12 * (1 - np.cos(around)) - 20 * (np.abs(t) - 0.75) ** 2)
    return Mesh(np.stack([r * np.cos(around), r * np.sin(around), z], axis=1), sphere.faces)


def joined(*meshes: Mesh, gap: float = 5.0) -> Mesh:
    """Several meshes as the components of one, each moved `gap` further along x."""
    offsets = np.cumsum([0] + [m.n_vertices for m in meshes[:-1]])
    vertices = [m.vertices + np.array([gap * k, 0, 0]) for k, m in enumerate(meshes)]
    return Mesh(np.concatenate(vertices), np.concatenate([m.faces + o for m, o in zip(meshes, offsets, strict=True)]))


def with_isolated(mesh: Mesh) -> Mesh:
    """The mesh with three vertices added that are on no face: first, middle, last."""
    half = mesh.n_vertices // 2
    extra = np.array([[9.0, 9, 9]])
    vertices = np.concatenate([extra, mesh.vertices[:half], -extra, mesh.vertices[half:], 2 * extra])
    return Mesh(vertices, mesh.faces + 1 + (mesh.faces >= half))


def moved(mesh: Mesh, scale: float = 1.0, seed: int | None = 0) -> Mesh:
    """The mesh scaled, then turned and shifted at random (unless seed is None)."""
    if seed is None:
        return Mesh(scale * mesh.vertices, mesh.faces)
    rng = np.random.default_rng(seed)
    rotation = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    return Mesh(scale * (mesh.vertices @ rotation.T + rng.standard_normal(3)), mesh.faces)


def jittered(mesh: Mesh, amount: float, seed: int = 0) -> Mesh:
    """The mesh with normal noise of `amount` times the mean edge length on every vertex."""
    edges = mesh.vertices[mesh.faces[:, 0]] - mesh.vertices[mesh.faces[:, 1]]
    size = amount * np.linalg.norm(edges, axis=1).mean()
    return Mesh(mesh.vertices + size * np.random.default_rng(seed).standard_normal(mesh.vertices.shape), mesh.faces)
