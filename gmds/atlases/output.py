"""The files of an atlas: registered meshes, the mean shape, tables, a picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geodesics import Mesh, write_mesh
from geodesics.arrays import Floats
from gmds.atlases.registered import Atlas
from gmds.files.table import write_table

COLUMNS = ("name", "status", "valid", "gap", "spread", "size", "distance", "mirrored", "code", "reason")
SPECIMENS_SHOWN = 3  # beside the mean: what a picture has room for


def write_atlas(atlas: Atlas, folder: Path) -> None:
    """Write atlas.npz, mean.ply, registered/NAME.ply, summary.csv, variation.csv and atlas.png, each atomically.

    Raises `MissingExtra` (E602) without the extra `viz`, `OSError`.
    """
    (folder / "registered").mkdir(parents=True, exist_ok=True)
    atlas.save(folder / "atlas.npz")
    mean = atlas.mean
    write_mesh(mean, folder / "mean.ply")
    for name, mesh in zip(atlas.names, atlas.registered, strict=True):
        write_mesh(mesh, folder / "registered" / f"{name}.ply")
    laid = atlas.superposition
    rows: list[list[object]] = []
    for i, name in enumerate(atlas.names):
        known = atlas.spread[i][np.isfinite(atlas.spread[i])]
        spread = float(known.mean()) if len(known) else None
        share, mirrored = float(atlas.valid[i].mean()), int(atlas.mirrored[i])
        size, distance = float(laid.sizes[i]), float(laid.distances[i])
        rows.append([name, atlas.status[i], share, float(atlas.gap[i]), spread, size, distance, mirrored, "", ""])
    for name, why in atlas.failures.items():
        rows.append([name, "failed", *[None] * 6, why.code, why.reason])
    write_table(folder / "summary.csv", COLUMNS, rows)
    varying = variation(atlas)
    table = [[i, float(x), int(n)] for i, (x, n) in enumerate(zip(varying, atlas.valid.sum(axis=0), strict=True))]
    write_table(folder / "variation.csv", ["vertex", "variation", "specimens"], table)
    write_atlas_picture(folder / "atlas.png", atlas, mean, varying)


def variation(atlas: Atlas) -> Floats:
    """How much each point (n,) varies: root mean square distance from the mean, over the root of the mean's area."""
    laid = atlas.superposition
    square = ((laid.aligned - laid.mean) ** 2).sum(axis=2) * atlas.valid
    area = Mesh(laid.mean, atlas.faces).area
    return np.asarray(np.sqrt(square.sum(axis=0) / atlas.valid.sum(axis=0) / area), dtype=np.float64)


def write_atlas_picture(path: Path, atlas: Atlas, mean: Mesh, varying: Floats) -> None:
    """The mean shape, coloured by how much each point varies, and some specimens beside it; what one lacks is grey."""
    from gmds.pictures.values import write_values

    far = np.argsort(atlas.superposition.distances)
    some = [int(far[i]) for i in np.linspace(0, len(far) - 1, min(SPECIMENS_SHOWN, len(far))).round().astype(int)]
    shown = [("mean shape: variation", mean, varying)]
    for i in some:
        caption = atlas.names[i] + ("" if atlas.valid[i].all() else " (grey: missing)")
        values = np.where(atlas.valid[i], varying, np.nan)
        shown.append((caption, Mesh(atlas.configurations[i], atlas.faces), values))
    write_values(path, shown, label="standard deviation / √area", pixels=420, columns=2)
