"""Read a mesh from a file and measure it: area, curvature, geodesic distances in two metrics."""

import numpy as np

import geodesics
from gmds.shapes import quadruped

geodesics.write_mesh(quadruped(n_vertices=2000), "animal.ply")
mesh = geodesics.read_mesh("animal.ply")
print(mesh)

# Gauss-Bonnet: the angle defects of a closed surface of genus 0 add up to 4 pi
print("total curvature / 4 pi:", geodesics.angle_defect(mesh).sum() / (4 * np.pi))

nose, tail = mesh.vertices[:, 0].argmax(), mesh.vertices[:, 0].argmin()
start = geodesics.SurfacePoints.at_vertices(mesh, [nose])
for metric in (geodesics.embedded(mesh), geodesics.scale_invariant(mesh)):
    distances = geodesics.GeodesicDistance(metric).field(start)[0]
    print(f"nose to tail {distances[tail]:.3f}, farthest vertex {distances.argmax()}, area {metric.mass.sum():.3f}")
