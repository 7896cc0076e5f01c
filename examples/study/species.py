"""Animals of two species: ears and legs of known sizes, other sizes and poses, one without a leg, one mirrored."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from geodesics import Mesh
from gmds.deformations import cut
from gmds.shapes import Figure, quadruped

Array = NDArray[np.float64]

POSES = ("stand", "walk", "graze", "turn")
EARS, LEGS = {"short": 0.85, "long": 1.4}, {"short": 1.15, "long": 0.9}  # of each species; set by hand
SPREAD = 0.05  # standard deviation of the logarithm of either within a species; set by hand
LEG = 0.035  # share of the area that is cut off around a paw


class Specimen(NamedTuple):
    """An animal, the mesh that was found of it, and how it grew."""

    name: str
    species: str
    figure: Figure
    mesh: Mesh
    ear: float
    leg: float
    mirrored: bool

    def places(self, vertices: Array) -> Array:
        """Where points of its mesh (n, 3) are on the undeformed body that all share."""
        return np.asarray(self.figure.rest[cKDTree(self.mesh.vertices).query(vertices)[1]], dtype=np.float64)


def specimens(count: int = 12, n_vertices: int = 1500) -> list[Specimen]:
    """Half of each species; the second has lost a leg, and the third is mirrored."""
    rng = np.random.default_rng(7)
    found = []
    for i in range(count):
        species = ("short", "long")[i % 2]
        ear, leg = (size[species] * float(np.exp(SPREAD * rng.standard_normal())) for size in (EARS, LEGS))
        pose = POSES[i // 2 % len(POSES)]
        figure = quadruped(pose, ear_scale=ear, leg_scale=leg, n_vertices=n_vertices + 7 * i, seed=i)
        mesh: Mesh = figure
        if i == 1:
            mesh = cut(figure, LEG, centre=int((figure.rest @ [0.3, 1.0, -1.0]).argmax())).mesh
            figure = Figure(mesh.vertices, mesh.faces, figure.rest[cKDTree(figure.vertices).query(mesh.vertices)[1]])
        place = rng.uniform(0.5, 2.0) * Rotation.from_euler("z", 40 * i, degrees=True).apply(
            mesh.vertices.copy()
        ) + rng.normal(size=3)
        if i == 2:
            place, mesh = place * [-1, 1, 1], Mesh(mesh.vertices, mesh.faces[:, [0, 2, 1]])
        found.append(Specimen(f"{species}{i // 2 + 1}", species, figure, Mesh(place, mesh.faces), ear, leg, i == 2))
    return found


def parts(rest: Array) -> dict[str, NDArray[np.bool_]]:
    """Which places (n, 3) of the undeformed body are on ears and on legs, and which on the trunk."""
    ears = (rest[:, 2] > 1.72) & (np.abs(rest[:, 1]) > 0.1)
    legs = rest[:, 2] < 0.55
    return {"ears": ears, "legs": legs, "trunk": (np.abs(rest[:, 0]) < 0.35) & (rest[:, 2] > 0.75)}
