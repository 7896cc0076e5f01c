"""Intrinsic symmetries where size is insignificant: plain, and with one ear, arm or leg twice as big (abstract)."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from common import Z_UP, Picture, grid, options, picture, publish

import gmds
from geodesics import Mesh, SurfacePoints, read_mesh
from gmds.deformations.local_scaling import branch_log_scale, local_scaling
from gmds.evaluation import protocol_subset
from gmds.pictures.camera import broadside
from gmds.pictures.matching_colours import matching_colours
from gmds.pictures.software import render
from gmds.shapes import quadruped

COLUMNS = ("a colour for each point", "the colour of its\nmirror image", "how far that is\n(dark: on the axis)")
GROWN = ("one part twice as big", "the colour of its\nmirror image")
FACTOR = 2.0


@dataclass(frozen=True)
class Case:
    """A surface and, for every vertex in `rows`, the point of it that is its mirror image."""

    name: str
    mesh: Mesh
    up: tuple[int, int, int]
    rows: np.ndarray
    truth: SurfacePoints

    def rescaled(self) -> Case:
        """The same with one of two ears, arms or legs grown; faces stay, and so does the truth."""
        for rng in range(20):  # a nose or a tail is its own mirror image
            field = branch_log_scale(self.mesh, FACTOR, count=1, rng=rng)
            if np.abs(field[self.rows] - self.truth.interpolate(field)).max() > 0.9 * np.log(FACTOR):
                break
        mesh, _ = local_scaling(self.mesh, field)
        truth = SurfacePoints(mesh, self.truth.face, self.truth.barycentric)
        return Case(self.name, mesh, self.up, self.rows, truth)


def cases(settings: argparse.Namespace) -> Iterator[Case]:
    """The built-in animal, and cat, horse and centaur of TOSCA where they are."""
    animal = quadruped(n_vertices=600 if settings.small else 4000)
    truth = SurfacePoints.closest(animal, animal.vertices * (1, -1, 1))
    yield Case("animal", animal, Z_UP, np.arange(animal.n_vertices), truth)
    for name in () if settings.data is None else ("cat", "horse", "centaur"):
        mesh = read_mesh(settings.data / "tosca_hires" / f"{name}0.off")
        goals = np.loadtxt(settings.data / "tosca_hires" / f"{name}.sym", dtype=np.int64) - 1
        yield Case(name, mesh, Z_UP, np.arange(len(goals)), SurfacePoints.at_vertices(mesh, goals))


def pictures(case: Case, found: gmds.Correspondence) -> list[Picture]:
    """Colours, colours pulled back by the symmetry, and the distance between a point and its image."""
    view, colours = broadside(case.mesh, case.up, 55.0, 25.0), matching_colours(case.mesh)
    moved = np.linalg.norm(found.points.positions - case.mesh.vertices, axis=1)
    images = [render(case.mesh, c, rotation=view, pixels=300) for c in (colours, found.points.interpolate(colours))]
    return [*images, picture(case.mesh, moved, case.up, (0.0, float(np.quantile(moved, 0.98))))]


def solved(case: Case) -> tuple[list[Picture], dict[str, object]]:
    """Pictures and numbers of the best symmetry."""
    found = gmds.self_symmetry(case.mesh)
    chosen = protocol_subset(len(case.rows))
    errors = gmds.geodesic_error(found[0], case.truth[chosen], case.rows[chosen])
    told = {"error_x100": 100 * errors.mean(), "status": found[0].status.name, "found": len(found)}
    return pictures(case, found[0]), {**told, **found[0].meta["symmetry"]}


def main() -> None:
    """Find the symmetries, and show them."""
    settings = options(__doc__ or "")
    rows, numbers = [], {}
    for case in cases(settings):
        plain, told = solved(case)
        grown, told_grown = solved(case.rescaled())
        rows.append((case.name, [*plain, *grown[: len(GROWN)]]))
        numbers[case.name] = {"plain": told, "rescaled": told_grown}
    figure = grid(rows, (*COLUMNS, *GROWN), "Intrinsic symmetry, found without landmarks", size=0.65)
    publish(settings.output, "symmetry", figure, numbers)


if __name__ == "__main__":
    main()
