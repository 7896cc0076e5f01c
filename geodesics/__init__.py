"""Distances on one surface."""

from geodesics.curvature import angle_defect, gaussian_curvature
from geodesics.delaunay import intrinsic_delaunay
from geodesics.errors import FormatError, MeshError
from geodesics.io import read_mesh, write_mesh
from geodesics.laplacian import lumped_mass, stiffness
from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal
from geodesics.metrics.embedded import embedded
from geodesics.metrics.scale_invariant import scale_invariant
from geodesics.points import SurfacePoints
from geodesics.spectrum import Spectrum, eigenpairs
