"""Which arc lengths of sec. 2 survive another size, and which survive bending? Only sqrt|K| ds survives both."""

import numpy as np

from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded
from geodesics.metrics import arc_lengths


def vase(bend: float, size: float = 1.0, n: int = 60) -> Mesh:
    """Half a vase of radius r(s), bent around its axis: radius * bend, angle / bend; an exact isometry."""
    s, angle = (a.ravel() for a in np.meshgrid(np.linspace(0, 3, n), np.linspace(0, np.pi, n), indexing="ij"))
    radius, slope = 1 + 0.35 * np.sin(2 * s), 0.7 * np.cos(2 * np.linspace(0, 3, 4000))
    height = np.append(0, np.cumsum(np.sqrt(1 - (bend * slope) ** 2) * 3 / 4000))  # so that s stays arc length
    z = np.interp(s, np.linspace(0, 3, 4001), height)
    x, y = bend * radius * np.cos(angle / bend), bend * radius * np.sin(angle / bend)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + n, i + 1], 1), np.stack([i + 1, i + n, i + n + 1], 1)])
    return Mesh(size * np.stack([x, y, z], axis=1), faces)


surfaces = {"itself": vase(1.0), "twice as big": vase(1.0, 2.0), "bent": vase(0.6)}
names = "first_curvature", "second_curvature", "curvature_ratio", "gaussian_curvature"
lengths = {"ds": embedded, **{name: getattr(arc_lengths, f"{name}_length") for name in names}}
inside = np.flatnonzero((np.indices((60, 60)) % 10 == 5).all(axis=0).ravel())
print(f"{'':20}{'twice as big':>14}{'bent':>14}   change of geodesic distances")
for name, length in lengths.items():
    field = {}
    for which, mesh in surfaces.items():
        points = SurfacePoints.at_vertices(mesh, inside)
        field[which] = GeodesicDistance(length(mesh)).field(points)[:, inside]
    change = [np.abs(field[k] - field["itself"]).mean() / field["itself"].mean() for k in ("twice as big", "bent")]
    print(f"{name:20}{100 * change[0]:12.1f} %{100 * change[1]:12.1f} %")
