"""Evenly spread points of all specimens, written for other programs and read back as these do."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import gmds
from gmds.landmarks.files import read_specimens
from gmds.morphometrics.pseudolandmarks import even_points
from gmds.morphometrics.specimen_tables import write_points


def write_and_read_back(atlas: gmds.Atlas, out: Path, count: int = 30) -> dict[str, float]:
    """Write points.tps and points.wide.csv; by how much, at the most, what is read back is another place.

    Points that a specimen lacks are left out: `NA` in a .tps file is geomorph's, and ktch refuses it. ktch is asked
    where it is installed (`pip install ktch`).
    """
    some = even_points(atlas.mean, count)
    some = some[atlas.valid[:, some].all(axis=0)]
    places, valid = atlas.configurations[:, some], np.ones((len(atlas.names), len(some)), dtype=bool)
    names = [f"P{i + 1}" for i in range(len(some))]
    found = {}
    for file in ("points.tps", "points.wide.csv"):
        write_points(out / file, atlas.names, names, places, valid)
        read = read_specimens(out / file)
        again = np.stack([read[name].positions for name in atlas.names])
        found[f"{file}, read back: largest difference"] = float(np.abs(again - places).max())
    try:
        from ktch.io import read_tps
    except ImportError:
        return found
    again = np.stack([one.landmarks for one in read_tps(out / "points.tps")])
    return {**found, "points.tps, read back by ktch: largest difference": float(np.abs(again - places).max())}
