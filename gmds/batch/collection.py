"""The shapes of a collection by name, from a folder, a list of files, or meshes in memory."""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from geodesics import Mesh, read_mesh
from geodesics.errors import BadArgument
from gmds.batch.pair_choice import Choice, Pairs, all_pairs
from gmds.batch.pair_list import read_list
from gmds.files.folders import mesh_files, plain_name, shape_names

Given = str | os.PathLike[str] | Mapping[str, Mesh | str | os.PathLike[str]] | Sequence[str | os.PathLike[str]]


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape and where it comes from: a file that is read when it is needed, or a mesh."""

    name: str
    origin: Path | Mesh

    def mesh(self) -> Mesh:
        """The mesh. Raises `FormatError`, `MeshError`, `OSError`."""
        return self.origin if isinstance(self.origin, Mesh) else read_mesh(self.origin)

    @property
    def place(self) -> str:
        """The path, or what stands for it."""
        return "in memory" if isinstance(self.origin, Mesh) else str(self.origin)


@dataclass(frozen=True, eq=False)
class Collection:
    """Shapes, by name, and the pairs (source, target) to be matched, no two alike."""

    shapes: Mapping[str, Shape]
    pairs: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, given: Given, pairs: Choice | Pairs | None = None) -> Collection:
        """From a folder of meshes, a list file (see `read_list`), paths, or a mapping from names to meshes or paths.

        `pairs`: which to match, `all_pairs` unless the list says so. Raises `FormatError` or `ValueError` when there
        is nothing to match or a name is unknown, `OSError` when a folder or list cannot be read.
        """
        listed: Pairs | None = None
        if isinstance(given, Mapping):
            named = {
                _checked(name): origin if isinstance(origin, Mesh) else Path(origin) for name, origin in given.items()
            }
        elif isinstance(given, str | os.PathLike) and not Path(given).is_dir():
            paths, couples = read_list(Path(given))
            named = dict(zip(names(paths), paths, strict=True))
            by_path = {path: name for name, path in named.items()}
            listed = None if couples is None else [(by_path[a], by_path[b]) for a, b in couples]
        else:
            paths = mesh_files(Path(given)) if isinstance(given, str | os.PathLike) else [Path(path) for path in given]
            named = dict(zip(names(paths), paths, strict=True))
        if listed is not None and pairs is not None:
            raise BadArgument("the list says which pairs to match; leave out `pairs`")
        chosen = listed if listed is not None else (pairs or all_pairs)
        found = dict.fromkeys((one, other) for one, other in (chosen(list(named)) if callable(chosen) else chosen))
        unknown = {name for pair in found for name in pair} - named.keys()
        if unknown:
            raise BadArgument(f"there is no shape {min(unknown)!r}; there are {', '.join(list(named)[:10])}")
        if not found:
            alone = f": {next(iter(named))}" if len(named) == 1 else ""
            raise BadArgument(f"there is nothing to match: {len(named)} shapes, no pair{alone}")
        wanted = {name for pair in found for name in pair}
        shapes = {name: Shape(name, _absolute(origin)) for name, origin in named.items() if name in wanted}
        return cls(shapes, tuple(found))


def names(paths: Sequence[Path]) -> list[str]:
    """A name for every file that can stand in the name of another: as `shape_names`, all different.

    Never with two underscores in a row, so that A__B names one pair alone; nor the same but for capital letters.
    """
    plain = [plain_name(name) for name in shape_names(paths)]
    often = Counter(name.casefold() for name in plain)
    if max(often.values()) == 1:
        return plain
    common = os.path.commonpath([path.absolute().parent for path in paths])
    return [
        name if often[name.casefold()] == 1 else f"{name}-{_digest(os.path.relpath(path.absolute(), common))}"
        for name, path in zip(plain, paths, strict=True)
    ]


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:8]


def _checked(name: str) -> str:
    if name != plain_name(name):
        raise BadArgument(f"{name!r} cannot be part of the name of a file A__B.npz; {plain_name(name)!r} could")
    return name


def _absolute(origin: Mesh | Path) -> Mesh | Path:
    return origin if isinstance(origin, Mesh) else origin.absolute()
