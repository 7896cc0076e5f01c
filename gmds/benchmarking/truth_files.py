"""Where points should go, in the formats in which publishers say so; indices come out 0-based."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.errors import FormatError
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.correspondence import Correspondence
from gmds.files.mat import read_mat
from gmds.files.npz import DAMAGED, opened, read_npz

HUMP = 12  # the number of the landmark that camels of SHREC'20 have on a hump, where other animals have nothing


class BadTruth(FormatError):
    """A truth file that cannot be read or does not fit its mesh."""

    code = "E231"


def read_truth(
    path: Path, source: Mesh, target: Mesh, *, source_path: Path | None = None, flipped: bool = False
) -> tuple[Integers, SurfacePoints] | None:
    """Source vertices (p,) and their true points on the target, from a file of any of the known kinds.

    .npz: `src` and `gt` (or `gt_sym` when `flipped`; None when it is absent), or a map.npz. .vts: with the source's
    own file as `source_path`, else one line per source vertex. .mat: SHREC'20 landmarks, with `source_path`.
    Raises `FormatError` or `MeshError` when the file does not fit the meshes.
    """
    kind = path.suffix.lower()
    if kind == ".npz" and _is_map(path):
        answer = Correspondence.load(path, source, target)
        rows = np.flatnonzero(answer.valid)
        return None if flipped else (rows, answer.points[rows])
    if kind == ".npz":
        indices, direct, mirrored = read_truth_npz(path)
        true = mirrored if flipped else direct
        return None if true is None else (indices, SurfacePoints.at_vertices(target, true))
    if kind == ".mat":
        if source_path is None:
            raise BadTruth(f"{path} holds landmarks of one mesh; name the source's .mat file too")
        return shared_landmarks(source_path, path, target)
    to = read_vts(path)
    from_ = np.arange(source.n_vertices) if source_path is None else read_vts(source_path)
    if len(from_) != len(to):
        raise BadTruth(f"{path} has {len(to)} lines for {len(from_)} source points; is the source's .vts file missing?")
    return from_, SurfacePoints.at_vertices(target, to)


def shared_landmarks(source_path: Path, target_path: Path, target: Mesh) -> tuple[Integers, SurfacePoints]:
    """Source vertices and target points of the SHREC'20 landmarks that two .mat files share."""
    ids, vertices, _, _ = read_landmarks_mat(source_path)
    target_ids, _, faces, weights = read_landmarks_mat(target_path)
    _, here, there = np.intersect1d(ids, target_ids, return_indices=True)
    return vertices[here], SurfacePoints(target, faces[there], weights[there])


def missing_landmarks(source_path: Path, target_path: Path) -> Integers:
    """Source vertices of the SHREC'20 landmarks that the target's .mat file does not have."""
    ids, vertices, _, _ = read_landmarks_mat(source_path)
    known = read_landmarks_mat(target_path)[0]
    if _is_camel(target_path):  # where the others have this landmark camels have a place too, but it was not marked
        known = np.append(known, HUMP)
    return vertices[~np.isin(ids, known)]


def read_vts(path: Path) -> Integers:
    """Vertex indices (k,) from a .vts file, one 1-based index a line; returned 0-based. Raises `BadTruth`."""
    try:
        with opened(path) as stream:
            words = stream.read().decode("utf-8").split()
        indices = np.array([int(word) for word in words], dtype=np.int64) - 1
    except (ValueError, OverflowError) as error:
        raise BadTruth(f"{path} must hold one whole number a line ({error})") from error
    if len(indices) == 0 or indices.min() < 0:
        raise BadTruth(f"{path} must hold vertex numbers from 1 on, at least one")
    return indices


def read_truth_npz(path: Path) -> tuple[Integers, Integers, Integers | None]:
    """`src`, `gt` and `gt_sym` (None when absent), each (k,) 0-based, from a truth npz. Raises `BadTruth`."""
    try:
        arrays = read_npz(path)
        wanted = [whole_numbers(arrays[key]) for key in ("src", "gt")]
        flipped = whole_numbers(arrays["gt_sym"]) if "gt_sym" in arrays else None
    except (KeyError, ValueError) as error:
        raise BadTruth(f"{path} must hold whole-number arrays src and gt ({error})") from error
    if any(
        array.shape != wanted[0].shape or array.ndim != 1
        for array in (*wanted, *([] if flipped is None else [flipped]))
    ):
        raise BadTruth(f"{path}: src, gt and gt_sym must be one-dimensional and equally long")
    return wanted[0], wanted[1], flipped


def read_missing_npz(path: Path) -> Integers | None:
    """Source vertices (q,) that have no counterpart, 0-based: `missing` of a truth npz, what is not valid in a map.

    None where the file does not say. Raises `FormatError`.
    """
    arrays = read_npz(path)
    if "barycentric" in arrays and "valid" in arrays:
        return np.flatnonzero(~arrays["valid"].astype(np.bool_))
    if "missing" not in arrays:
        return None
    try:
        return whole_numbers(arrays["missing"].reshape(-1))
    except ValueError as error:
        raise BadTruth(f"{path}: missing must be whole numbers ({error})") from error


def whole_numbers(array: NDArray[Any]) -> Integers:
    """Indices from 0 as int64. Raises `ValueError` for fractions, negative numbers and anything that is no number."""
    if array.dtype.kind not in "iuf" or not (np.isfinite(array) & (array >= 0) & (array < 2**62)).all():
        raise ValueError(f"indices must be numbers from 0 on, not {array.dtype} with others")
    if (array != np.floor(array)).any():
        raise ValueError("indices must be whole numbers")
    return np.asarray(array, dtype=np.int64)


def read_landmarks_mat(path: Path) -> tuple[Integers, Integers, Integers, Floats]:
    """SHREC'20 landmarks: ids (k,), vertices (k,), faces (k,), weights (k, 3), all 0-based. Raises `BadTruth`.

    Landmark 12 of camels sits on a hump that other animals lack and is dropped.
    """
    try:
        content = read_mat(path, "points", "verts", "baryc")
        points = content["baryc"]
        ids, vertices, faces = (
            whole_numbers(column.ravel()) for column in (content["points"], content["verts"], points[:, 0])
        )
        weights = np.maximum(points[:, 1:4].astype(np.float64), 0)
        total = weights.sum(axis=1, keepdims=True)
        if not (len(ids) == len(vertices) == len(faces) and (total > 0).all() and np.isfinite(total).all()):
            raise ValueError("they have other lengths, or weights that do not add up to anything")
        if not ((vertices > 0).all() and (faces > 0).all()):
            raise ValueError("vertices and faces are counted from 1")
    except (ValueError, IndexError) as error:
        raise BadTruth(f"{path} must be a MATLAB file with points, verts and baryc ({error})") from error
    keep = ~((ids == HUMP) & _is_camel(path))
    return ids[keep], vertices[keep] - 1, faces[keep] - 1, weights[keep] / total[keep]


def points_at(mesh: Mesh, indices: Integers | None) -> SurfacePoints | None:
    """The points at vertices `indices`, None for None."""
    return None if indices is None else SurfacePoints.at_vertices(mesh, indices)


def _is_camel(path: Path) -> bool:
    return path.stem.startswith("camel")


def _is_map(path: Path) -> bool:
    with opened(path) as stream:
        try:
            with zipfile.ZipFile(stream) as archive:
                return "barycentric.npy" in archive.namelist()
        except DAMAGED:
            return False
