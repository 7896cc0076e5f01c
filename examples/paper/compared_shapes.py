"""The animals of the question of the abstract: dogs whose ears and sizes differ, and cats, built-in and published."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from geodesics import Mesh, read_mesh
from geodesics.topology.edge_paths import edge_distances
from gmds.deformations import local_scaling
from gmds.shapes import humanoid, quadruped
from gmds.shapes.figure import figure
from gmds.shapes.implicit import Cone, Ellipsoid
from gmds.shapes.quadruped import BODY, POSES
from gmds.surface.measured import measure


def built_in(small: bool) -> dict[str, Mesh]:
    """Two dogs whose ears and sizes differ, and a cat; unless `small`, the cat in another pose, and a person."""
    n_vertices = 800 if small else 3000
    little = quadruped("graze", ear_scale=1.7, n_vertices=n_vertices, seed=1)
    large = quadruped("walk", ear_scale=0.6, n_vertices=n_vertices, seed=2)
    shapes = {
        "small dog, large ears": Mesh(0.5 * little.vertices, little.faces),
        "large dog, small ears": Mesh(2.0 * large.vertices, large.faces),
        "cat 1": built_in_cat("stand", n_vertices, 3),
    }
    if small:
        return shapes
    return {**shapes, "cat 2": built_in_cat("turn", n_vertices, 4), "person": humanoid(n_vertices=n_vertices)}


def built_in_cat(pose: str, n_vertices: int, seed: int) -> Mesh:
    """Another animal on the built-in skeleton: a round head without a muzzle, thin legs, a long even tail."""
    parts: list[Any] = []
    for part in BODY.parts:
        if part.joint == "head" or part.joint.startswith("ear_") or not isinstance(part, Cone):
            continue
        if part.joint.startswith("tail"):
            end = (-2.1, 0.0, 1.5) if part.joint == "tail_tip" else part.end
            parts.append(replace(part, end=end, r0=0.055, r1=0.05))
        else:
            thin = 0.8 if part.joint in ("hind", "chest", "neck") else 0.7
            parts.append(replace(part, r0=thin * part.r0, r1=thin * part.r1))
    parts.append(Ellipsoid("head", (1.0, 0, 1.52), (0.19, 0.18, 0.17)))
    for side, s in (("left", 1), ("right", -1)):
        parts.append(Cone(f"ear_{side}", (0.97, 0.10 * s, 1.62), (0.95, 0.14 * s, 1.78), 0.08, 0.03))
    return figure(replace(BODY, parts=tuple(parts)), POSES[pose], spacing=0.025, n_vertices=n_vertices, seed=seed)


def published_animals(folder: Path) -> dict[str, Mesh]:
    """Dogs of TOSCA with changed ears and sizes, and cats as they are."""
    found = {
        name: measure(read_mesh(folder / f"{name}.vert")).mesh for name in ("dog0", "dog3", "dog6", "cat0", "cat3")
    }
    return {
        "small dog0, large ears": with_ears(found["dog0"], 1.7, 0.5),
        "large dog3, small ears": with_ears(found["dog3"], 0.6, 2.0),
        "small dog6, large ears": with_ears(found["dog6"], 1.7, 0.5),
        "cat0": found["cat0"],
        "cat3": found["cat3"],
    }


def with_ears(mesh: Mesh, factor: float, size: float) -> Mesh:
    """A standing animal whose ears, the two highest places, are grown by a factor, and then all of it by `size`."""
    height, unit = mesh.vertices[:, 2], np.sqrt(mesh.area)
    first = int(height.argmax())
    along = edge_distances(mesh, np.array([first]))[0]
    second = int(np.where(along > 0.1 * unit, height, -np.inf).argmax())
    near = edge_distances(mesh, np.array([first, second])).min(axis=0)
    t = (near / (0.12 * unit) - 0.5).clip(0, 1)
    grown = local_scaling(mesh, np.log(factor) * (1 - t * t * (3 - 2 * t)))[0]
    return Mesh(size * grown.vertices, grown.faces)
