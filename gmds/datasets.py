"""Published benchmark folders, each in its publisher's own format, as pairs with truth.

Nothing is copied or downloaded: a folder is given by its path, and recognised by what is in it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics.errors import FormatError
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints

Indices = NDArray[np.int64]
Truth = tuple[Indices, SurfacePoints, SurfacePoints | None]
TruthReader = Callable[[Mesh, Mesh], Truth]


class UnknownDataset(FormatError):
    """A folder that is none of the known benchmarks, or lists pairs that are not there."""

    code = "E230"


class BadTruth(FormatError):
    """A truth file that can not be read or does not fit its mesh."""

    code = "E231"


@dataclass(frozen=True)
class Pair:
    """Two mesh files and their truth.

    `truth(source, target)` gives source vertices (p,), p points of the target, and p flipped points, or None for these.
    """

    name: str
    source: Path
    target: Path
    truth: TruthReader
    group: str = ""


def dataset_pairs(folder: Path, listing: Path | None = None) -> list[Pair]:
    """The pairs of a benchmark folder, in the published order, or those named in the file `listing`.

    Known: `corres/*.vts` with `test_pairs.txt` (remeshed FAUST and TOSCA), `pairs.json` (locally scaled pairs),
    `models` + `gts` + `test-sets` (SHREC'20). A listing has two shape names a line; for `pairs.json`, one pair name.
    Raises `UnknownDataset`.
    """
    folder = Path(folder)
    if (folder / "corres").is_dir():
        return [_vts_pair(folder, *names) for names in _listed(listing or folder / "test_pairs.txt", 2)]
    if (folder / "pairs.json").is_file():
        return _scaled_pairs(folder, listing)
    if (folder / "gts").is_dir() and (folder / "models").is_dir():
        listings = [listing] if listing else sorted((folder / "test-sets").glob("*.txt"))
        return [_shrec_pair(folder, file.stem, *names) for file in listings for names in _listed(file, 2)]
    raise UnknownDataset(f"{folder} has neither corres/, pairs.json nor gts/ + models/: not a known benchmark folder")


def read_vts(path: Path) -> Indices:
    """Vertex indices (k,) from a .vts file, one 1-based index a line; returned 0-based. Raises `BadTruth`."""
    try:
        indices = np.array([int(word) for word in path.read_text(encoding="utf-8").split()], dtype=np.int64) - 1
    except (ValueError, OverflowError) as error:
        raise BadTruth(f"{path} must hold one whole number a line ({error})") from error
    if len(indices) == 0 or indices.min() < 0:
        raise BadTruth(f"{path} must hold vertex numbers from 1 on, at least one")
    return indices


def read_truth_npz(path: Path) -> tuple[Indices, Indices, Indices | None]:
    """`src`, `gt` and `gt_sym` (None when absent), each (k,) 0-based, from a truth npz. Raises `BadTruth`."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            wanted = [np.asarray(archive[key], dtype=np.int64) for key in ("src", "gt")]
            flipped = np.asarray(archive["gt_sym"], dtype=np.int64) if "gt_sym" in archive.files else None
    except (KeyError, ValueError, EOFError, OSError) as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise
        raise BadTruth(f"{path} must hold whole-number arrays src and gt ({error})") from error
    if any(
        array.shape != wanted[0].shape or array.ndim != 1
        for array in (*wanted, *([] if flipped is None else [flipped]))
    ):
        raise BadTruth(f"{path}: src, gt and gt_sym must be one-dimensional and equally long")
    return wanted[0], wanted[1], flipped


def read_landmarks_mat(path: Path) -> tuple[Indices, Indices, Indices, NDArray[np.float64]]:
    """SHREC'20 landmarks: ids (k,), vertices (k,), faces (k,), weights (k, 3), all 0-based. Raises `BadTruth`.

    Landmark 12 of camels sits on a hump that other animals lack and is dropped.
    """
    from scipy.io import loadmat

    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist")
    try:
        content = loadmat(path)
        ids, vertices, points = (content[key] for key in ("points", "verts", "baryc"))
        ids, vertices = ids.ravel().astype(np.int64), vertices.ravel().astype(np.int64) - 1
        faces, weights = points[:, 0].astype(np.int64) - 1, np.maximum(points[:, 1:4].astype(np.float64), 0)
    except Exception as error:  # on damaged bytes scipy raises a dozen different types
        raise BadTruth(f"{path} must be a MATLAB file with points, verts and baryc ({error})") from error
    keep = ~((ids == 12) & path.stem.startswith("camel"))
    return ids[keep], vertices[keep], faces[keep], weights[keep] / weights[keep].sum(axis=1, keepdims=True)


def _listed(file: Path, columns: int) -> list[Sequence[str]]:
    """The names on each line of a listing, separated by blanks or commas."""
    rows = [re.split(r"[\s,;]+", line.strip()) for line in file.read_text(encoding="utf-8").splitlines()]
    rows = [row for row in rows if row != [""] and not row[0].startswith("#")]
    for number, row in enumerate(rows, start=1):
        if len(row) != columns:
            raise UnknownDataset(f"{file}, entry {number}: {' '.join(row)!r} should be {columns} names")
    return list(rows)


def _vts_pair(folder: Path, source: str, target: str) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        paths = [folder / "corres" / f"{name}.vts" for name in (source, target, f"{target}.sym")]
        from_, to = read_vts(paths[0]), read_vts(paths[1])
        flipped = read_vts(paths[2]) if paths[2].exists() else None
        if len(from_) != len(to) or (flipped is not None and len(flipped) != len(to)):
            raise BadTruth(
                f"{paths[0]} and {paths[1]} (or its .sym) differ in length: they must share canonical points"
            )
        return from_, SurfacePoints.at_vertices(target_mesh, to), _at(target_mesh, flipped)

    return Pair(f"{source}-{target}", folder / f"{source}.off", folder / f"{target}.off", truth)


def _scaled_pairs(folder: Path, listing: Path | None) -> list[Pair]:
    try:
        entries = {entry["name"]: entry for entry in json.loads((folder / "pairs.json").read_text(encoding="utf-8"))}
    except (json.JSONDecodeError, TypeError, KeyError) as error:
        raise UnknownDataset(f"{folder / 'pairs.json'} is not a list of pairs ({error})") from error
    names = [row[0] for row in _listed(listing, 1)] if listing else list(entries)
    unknown = [name for name in names if name not in entries]
    if unknown:
        raise UnknownDataset(f"{listing} names {unknown[0]!r}, which pairs.json does not have")
    return [_scaled_pair(folder.parent, entries[name]) for name in names]


def _scaled_pair(root: Path, entry: dict[str, str]) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        from_, to, flipped = read_truth_npz(root / entry["truth"])
        return from_, SurfacePoints.at_vertices(target_mesh, to), _at(target_mesh, flipped)

    return Pair(entry["name"], root / entry["source"], root / entry["target"], truth, entry.get("group", ""))


def _shrec_pair(folder: Path, group: str, source: str, target: str) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        ids, vertices, _, _ = read_landmarks_mat(folder / "gts" / f"{source}.mat")
        other, _, faces, weights = read_landmarks_mat(folder / "gts" / f"{target}.mat")
        _, here, there = np.intersect1d(ids, other, return_indices=True)
        return vertices[here], SurfacePoints(target_mesh, faces[there], weights[there]), None

    return Pair(
        f"{source}-{target}", folder / "models" / f"{source}.obj", folder / "models" / f"{target}.obj", truth, group
    )


def _at(mesh: Mesh, indices: Indices | None) -> SurfacePoints | None:
    return None if indices is None else SurfacePoints.at_vertices(mesh, indices)
