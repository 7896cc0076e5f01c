"""The files of a shape model: numbers, meshes, tables, a picture, a page."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geodesics import Mesh, vertex_normals, write_mesh
from geodesics.arrays import Floats
from gmds.atlases.model_page import write_model_page
from gmds.files.table import write_table
from gmds.morphometrics.quality import broken_stick, compactness, generalisation, specificity
from gmds.morphometrics.shape_model import ShapeModel

DEVIATIONS = 2.0  # standard deviations either way: a convention


def write_model(model: ShapeModel, folder: Path, shown: int = 3) -> None:
    """Write model.npz, meshes, tables, modes.png and model.html, each atomically; `shown` components are drawn.

    Raises `MissingExtra` (E602) without the extra `viz`, `OSError`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    model.save(folder / "model.npz")
    mean, shown = model.mean, min(shown, model.n_components_)
    write_mesh(mean, folder / "mean.ply")
    write_mesh(mean, folder / "mean.vtp")
    for number in range(shown):
        for word, sign in (("minus", -1.0), ("plus", 1.0)):
            moved = moved_by(model, number, sign * DEVIATIONS)
            write_mesh(moved, folder / f"mode{number + 1}-{word}.ply")
            write_mesh(moved, folder / f"mode{number + 1}-{word}.vtp")
    titles = [f"component_{i + 1}" for i in range(model.n_components_)]
    rows = zip(model.names_, model.centroid_sizes_.tolist(), model.scores_.tolist(), strict=True)
    write_table(folder / "scores.csv", ["name", "centroid_size", *titles], ([a, b, *c] for a, b, c in rows))
    _write_components(model, folder / "components.csv")
    _write_picture(model, folder / "modes.png", shown)
    write_model_page(model, folder / "model.html")


def moved_by(model: ShapeModel, number: int, deviations: float) -> Mesh:
    """The mean moved along one component by so many standard deviations."""
    scores = np.zeros(number + 1)
    scores[number] = deviations * np.sqrt(model.explained_variance_[number])
    return model.reconstruct(scores)


def outward(model: ShapeModel, number: int) -> Floats:
    """How far each point (n,) moves outward by one standard deviation of a component, over the root of the area."""
    mean = model.mean
    moved = moved_by(model, number, 1.0).vertices - mean.vertices
    return np.asarray((moved * vertex_normals(mean)).sum(axis=1) / np.sqrt(mean.area), dtype=np.float64)


def _write_components(model: ShapeModel, path: Path) -> None:
    general, specific = generalisation(model), specificity(model)
    rows: list[list[object]] = []
    for i, (variance, share) in enumerate(zip(model.explained_variance_, model.explained_variance_ratio_, strict=True)):
        known = float(general[i]) if i < len(general) else None
        rows.append([i + 1, float(variance), float(share), float(broken_stick(model)[i])])
        rows[-1] += [float(compactness(model)[i]), known, float(specific[i])]
    head = ["component", "variance", "share", "broken_stick", "compactness", "generalisation", "specificity"]
    write_table(path, head, rows)


def _write_picture(model: ShapeModel, path: Path, shown: int) -> None:
    from gmds.pictures.values import write_values

    panels = []
    for number in range(shown):
        values, share = outward(model, number), model.explained_variance_ratio_[number]
        for sign in (-1, 1):
            caption = f"component {number + 1} ({share:.1%}), {sign * DEVIATIONS:+g} s.d."
            panels.append((caption, moved_by(model, number, sign * DEVIATIONS), sign * values))
    title = "Outward movement by 1 s.d."
    write_values(path, panels, signed=True, label="outward / √area", pixels=420, columns=2, title=title)
