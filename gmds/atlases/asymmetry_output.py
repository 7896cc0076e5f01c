"""The files of a study of left and right."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geodesics import write_mesh
from gmds.files.table import write_table
from gmds.morphometrics.asymmetry import Asymmetry


def write_asymmetry(found: Asymmetry, names: Sequence[str], folder: Path) -> None:
    """Write asymmetry.csv, specimens.csv, mean.ply and asymmetry.png, each atomically.

    Raises `MissingExtra` (E602) without the extra `viz`, `OSError`.
    """
    from gmds.pictures.values import write_values

    folder.mkdir(parents=True, exist_ok=True)
    known = [None if not np.isfinite(x) else float(x) for x in found.signed.T.ravel()]
    columns = [known[i : i + len(names)] for i in range(0, len(known), len(names))]
    rows = (
        [i, *(None if not np.isfinite(x) else float(x) for x in (found.directional[i], found.fluctuating[i])), *row]
        for i, row in enumerate(columns)
    )
    write_table(folder / "asymmetry.csv", ["vertex", "directional", "fluctuating", *names], rows)
    root = np.sqrt(found.symmetric.area)
    size = np.where(found.valid, np.linalg.norm(found.vectors, axis=2), np.nan) / root
    table = (
        [name, float(np.sqrt(np.nanmean(row**2))), float(np.nanmax(row))] for name, row in zip(names, size, strict=True)
    )
    write_table(folder / "specimens.csv", ["name", "root_mean_square", "largest"], table)
    write_mesh(found.symmetric, folder / "mean.ply")
    shown = [("directional", found.symmetric, found.directional)]
    if np.isfinite(found.fluctuating).any():
        shown.append(("fluctuating (s.d.)", found.symmetric, found.fluctuating))
    signed = [True, False][: len(shown)]  # a standard deviation has no sign
    path, label = folder / "asymmetry.png", "outward / √area"
    write_values(path, shown, signed=signed, label=label, pixels=460, title="Asymmetry")
