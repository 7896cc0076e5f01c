"""SHREC'20: `models/*.obj`, landmarks in `gts/*.mat`, and a file of pairs for each of `test-sets`."""

from __future__ import annotations

import functools
from pathlib import Path

from geodesics.mesh import Mesh
from gmds.benchmarking.pairs import Pair, Truth, listed
from gmds.benchmarking.truth_files import missing_landmarks, shared_landmarks


def shrec20(folder: Path, listing: Path | None = None) -> list[Pair] | None:
    """The pairs of a folder with `gts/` and `models/`, of every test set or of the `listing`; None for another."""
    if not ((folder / "gts").is_dir() and (folder / "models").is_dir()):
        return None
    listings = [listing] if listing else sorted((folder / "test-sets").glob("*.txt"))
    return [_pair(folder, file.stem, *names) for file in listings for names in listed(file, 2)]


def _pair(folder: Path, group: str, source: str, target: str) -> Pair:
    here, there = (folder / "gts" / f"{name}.mat" for name in (source, target))

    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        return *shared_landmarks(here, there, target_mesh), None

    source_file, target_file = (folder / "models" / f"{name}.obj" for name in (source, target))
    missing = functools.partial(missing_landmarks, here, there)
    return Pair(f"{source}-{target}", source_file, target_file, truth, group, missing)
