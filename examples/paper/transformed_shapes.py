"""The collection of table1_retrieval.py: shapes as they are, and queries changed in seven ways and five strengths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from geodesics import Mesh, read_mesh
from gmds.deformations import KINDS, STRENGTHS, deformed
from gmds.retrieval.mending import largest_piece
from gmds.shapes import humanoid, quadruped
from gmds.shapes.humanoid import POSES as PEOPLE
from gmds.shapes.quadruped import POSES as ANIMALS


@dataclass(frozen=True, eq=False)
class Item:
    """A shape of the collection: `kind` is "null", "distractor" or what was done to it; strength 0 is nothing.

    `genuine`: another pose of the class as it was published, not made here.
    """

    label: str
    kind: str
    strength: int
    mesh: Mesh | None
    genuine: bool = False

    def without_mesh(self) -> Item:
        """The same, for keeping."""
        return replace(self, mesh=None)


def collection(
    classes: dict[str, Sequence[Mesh]], distractors: dict[str, Mesh], *, strengths: Sequence[int] = STRENGTHS
) -> Iterator[Item]:
    """All shapes: the first of each class as it is, its other poses, the first one changed, and the distractors.

    The other poses of a class are its isometries: sorted by `pose_change`, the first fifth has strength 1 and so on.
    """
    for seed, (label, meshes) in enumerate(classes.items()):
        null = largest_piece(meshes[0])
        yield Item(label, "null", 0, null)
        poses = sorted(map(largest_piece, meshes[1:]), key=lambda mesh: pose_change(null, mesh))
        for rank, mesh in enumerate(poses):
            yield Item(label, "isometry", 1 + 5 * rank // len(poses), mesh, genuine=True)
        for kind in KINDS:
            for strength in () if poses and kind == "isometry" else strengths:
                mesh = largest_piece(deformed(null, kind, strength, rng=seed)[0])
                yield Item(label, kind, strength, mesh)
    for name, mesh in distractors.items():
        yield Item(f"not in a class: {name}", "distractor", 0, largest_piece(mesh))


def pose_change(one: Mesh, other: Mesh) -> float:
    """How far the vertices are from the middle, in units of sqrt(area): the mean difference of the quantiles."""
    return float(np.abs(_reach(one) - _reach(other)).mean())


def _reach(mesh: Mesh) -> NDArray[np.float64]:
    from_middle = np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1)
    return np.quantile(from_middle / np.sqrt(mesh.area), np.linspace(0, 1, 101))


def published(data: Path) -> tuple[dict[str, Sequence[Mesh]], dict[str, Mesh]]:
    """The twelve classes of tosca_nonrigid_3k; ten people and nine animals of other collections to tell them from."""
    names: dict[str, list[Path]] = {}
    for path in sorted((data / "tosca_nonrigid_3k").glob("*.vert"), key=lambda p: (len(p.stem), p.stem)):
        names.setdefault(path.stem.rstrip("0123456789"), []).append(path)
    classes = {label: [read_mesh(path) for path in names[label]] for label in sorted(names)}
    others = [*sorted((data / "faust_5k").glob("*.off"))[::5], *sorted((data / "shrec20" / "models").glob("*.obj"))]
    return classes, {path.stem: read_mesh(path) for path in others}


def built_in(small: bool) -> tuple[dict[str, Sequence[Mesh]], dict[str, Mesh]]:
    """Four classes: the animal and the person in a few poses, stars of three and six arms; other stars to tell from.

    Small: two classes of fewer vertices.
    """
    n = 400 if small else 2000
    classes: dict[str, Sequence[Mesh]] = {
        "animal": [quadruped(pose, seed=seed, n_vertices=n) for seed, pose in enumerate(ANIMALS)],
        "person": [humanoid(pose, seed=seed, n_vertices=n) for seed, pose in enumerate(PEOPLE)],
    }
    if not small:
        classes |= {f"star{arms}": [star(arms, n)] for arms in (3, 6)}
    return classes, {f"star{arms}": star(arms, n) for arms in (2, 4, 5)}


def star(arms: int, n_vertices: int) -> Mesh:
    """A ball with arms around its equator, the first one longer than the rest."""
    turns = np.pi * (3 - np.sqrt(5)) * np.arange(n_vertices)  # evenly on the sphere (Fibonacci)
    z = 1 - (2 * np.arange(n_vertices) + 1) / n_vertices
    ring = np.sqrt(1 - z**2)
    sphere = np.column_stack([ring * np.cos(turns), ring * np.sin(turns), z])
    faces = ConvexHull(sphere).simplices
    corner = sphere[faces]
    inward = np.einsum("fi,fi->f", np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), corner[:, 0]) < 0
    faces[inward] = faces[inward][:, ::-1]
    bump = np.exp(6 * (np.cos(arms * turns) - 1)) * ring**8 * (1 + 0.3 * np.cos(turns))
    return Mesh((0.5 + 1.2 * bump)[:, None] * sphere, faces)
