"""map.npz, version 1: a map on disk, readable with numpy alone, never pickled.

Members: `face` int32 (n,), `barycentric` float64 (n, 3), `vertex` int64 (n,), `valid` bool (n,),
`distortion` float32 (n,), `meta` UTF-8 JSON bytes as uint8; of a map that was rated also `confidence` float32 (n,),
which files of older releases lack. A map with candidates has those of `gmds.maps.candidate_rows` too.
"""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from geodesics.errors import FormatError
from geodesics.io import atomic_write
from geodesics.mesh import Mesh
from gmds.errors import MapArray, MapMembers, MapMismatch, MapVersion, PickledMember
from gmds.files.npz import DAMAGED, PickledArray, opened, read_header, read_member
from gmds.maps import candidate_rows

FORMAT, VERSION = "gmds-map", 1
DTYPES = {"face": "<i4", "barycentric": "<f8", "vertex": "<i8", "valid": "|b1", "distortion": "<f4", "meta": "|u1"}
OPTIONAL = {"confidence": "<f4"}
KNOWN = DTYPES | OPTIONAL | candidate_rows.DTYPES
# bounds on memory: what `match` writes has a few thousand bytes, and up to ten candidates
MOST, MOST_TOLD = {"meta": 16_000_000, candidate_rows.COUNTED: 1000}, {"meta": "16 MB", candidate_rows.COUNTED: "1000"}

T = TypeVar("T")
Arrays = dict[str, NDArray[Any]]


def fingerprint(mesh: Mesh) -> dict[str, Any]:
    """Vertex count, face count and the SHA-256 of the vertices then the faces (little-endian, C order)."""
    digest = hashlib.sha256(np.ascontiguousarray(mesh.vertices, dtype="<f8"))
    digest.update(np.ascontiguousarray(mesh.faces, dtype="<i8"))
    return {"vertices": mesh.n_vertices, "faces": mesh.n_faces, "sha256": digest.hexdigest()}


def write_map(
    path: str | os.PathLike[str], arrays: Arrays, meta: Mapping[str, Any], source: Mesh, target: Mesh
) -> None:
    """Write the arrays and the meta data atomically; raises `OSError`, or `TypeError` when meta is not JSON."""
    head = {"format": FORMAT, "version": VERSION, "source": fingerprint(source), "target": fingerprint(target)}
    text = json.dumps({**meta, **head}, sort_keys=True, allow_nan=False, default=_plain).encode("utf-8")
    members = {**arrays, "meta": np.frombuffer(text, dtype=np.uint8)}
    with atomic_write(path) as stream:
        packed: dict[str, Any] = {
            name: np.asarray(members[name]).astype(dtype) for name, dtype in KNOWN.items() if name in members
        }
        np.savez_compressed(stream, **packed)


def read_map(path: str | os.PathLike[str], source: Mesh, target: Mesh) -> tuple[Arrays, dict[str, Any]]:
    """The arrays and the meta data of a map between these two meshes.

    Raises `FormatError` with code E210 (members), E211 (arrays), E212 (other meshes), E213 (version) or
    E220 (pickled); `OSError` when the file cannot be opened.
    """
    return _opened(Path(path), lambda archive: _read_members(Path(path), archive, source, target))


def _opened(path: Path, read: Callable[[zipfile.ZipFile], T]) -> T:
    """What is read from the archive."""
    with opened(path) as stream:
        try:
            with zipfile.ZipFile(stream) as archive:
                return read(archive)
        except FormatError:
            raise
        except DAMAGED as error:
            raise MapMembers(f"{path} is not a readable npz archive ({error}); write it again with save()") from error


def read_meta(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The meta data of a map alone, whatever meshes it belongs to. Raises as `read_map`."""
    return _opened(Path(path), lambda archive: _read_meta(Path(path), archive))


def _read_members(path: Path, archive: zipfile.ZipFile, source: Mesh, target: Mesh) -> tuple[Arrays, dict[str, Any]]:
    if "meta.npy" in archive.namelist():
        _read_meta(path, archive)  # a version that is not read is told before members that are not known
    there = _check_names(path, archive)
    meta = _read_meta(path, archive)
    _check_meshes(path, meta, source, target)
    n, rated = source.n_vertices, [name for name in there if name in OPTIONAL]
    shapes = {"face": (n,), "barycentric": (n, 3)} | dict.fromkeys(("vertex", "valid", "distortion", *rated), (n,))
    if candidate_rows.COUNTED in there:
        count = len(_member(path, archive, candidate_rows.COUNTED, None))
        shapes |= candidate_rows.shapes(count, n)
    return {name: _member(path, archive, name, shape) for name, shape in shapes.items()}, meta


def _plain(value: Any) -> Any:
    """Numpy numbers and arrays as plain ones, for JSON."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    raise TypeError(f"meta holds {value!r}, which JSON cannot carry; use numbers, strings, lists and dicts")


def _check_names(path: Path, archive: zipfile.ZipFile) -> list[str]:
    """The members that are there, of those that a map can have."""
    names = [name.removesuffix(".npy") for name in archive.namelist()]
    missing = [name for name in DTYPES if name not in names]
    if missing:
        raise MapMembers(f"{path} lacks {', '.join(missing)}; a map has the members {', '.join(DTYPES)}")
    extra = sorted({name for name in names if name not in KNOWN or names.count(name) > 1})
    if extra:
        raise MapMembers(
            f"{path} has unknown or repeated members {extra[:5]!r}; a map has {', '.join(KNOWN)} once each"
        )
    lacking = [name for name in candidate_rows.DTYPES if name not in names]
    if 0 < len(lacking) < len(candidate_rows.DTYPES):
        raise MapMembers(f"{path} lacks {', '.join(lacking)} of its candidates")
    return [name for name in KNOWN if name in names]


def _member(path: Path, archive: zipfile.ZipFile, name: str, shape: tuple[int, ...] | None) -> NDArray[Any]:
    """One array, its header checked before any of its bytes are taken: a lying header costs nothing.

    Without a shape it is a row of at most `MOST`.
    """
    with archive.open(f"{name}.npy") as stream:
        try:
            stored, _, dtype = read_header(stream)
        except PickledArray as error:
            raise PickledMember(f"{path}: member {name} holds {error}") from error
        except ValueError as error:
            raise MapArray(f"{path}: member {name} has {error}") from error
    fits = len(stored) == 1 and stored[0] <= MOST[name] if shape is None else stored == shape
    expected = np.dtype(KNOWN[name])
    if dtype != expected or not fits:
        wanted = f"(at most {MOST_TOLD[name]},)" if shape is None else shape
        raise MapArray(f"{path}: member {name} is {dtype} {stored}, expected {expected} {wanted}")
    try:
        return read_member(archive, f"{name}.npy")
    except ValueError as error:
        raise MapArray(f"{path}: member {name}: {error}") from error


def _read_meta(path: Path, archive: zipfile.ZipFile) -> dict[str, Any]:
    raw = _member(path, archive, "meta", None)
    try:
        meta = json.loads(raw.tobytes().decode("utf-8"))
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise MapArray(f"{path}: meta is not UTF-8 JSON ({error})") from error
    if not isinstance(meta, dict) or meta.get("format") != FORMAT:
        raise MapVersion(f"{path} is not a {FORMAT} file")
    if meta.get("version") != VERSION:
        raise MapVersion(f"{path} has version {meta.get('version')!r}; this release reads version {VERSION}")
    return meta


def _check_meshes(path: Path, meta: dict[str, Any], source: Mesh, target: Mesh) -> None:
    for role, mesh in (("source", source), ("target", target)):
        stored, given = meta.get(role), fingerprint(mesh)
        if not isinstance(stored, dict):
            raise MapMismatch(f"{path} does not say which {role} mesh it belongs to")
        for key, value in given.items():
            if stored.get(key) != value:
                raise MapMismatch(
                    f"{path} was made for a {role} with {key} {stored.get(key)!r}; the given one has {value!r}"
                )
