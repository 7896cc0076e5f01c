"""Comparing the meshes of a folder, pair by pair, so that what is done once is done for good."""

from __future__ import annotations

import contextlib
import csv
import functools
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path

import numpy as np

from geodesics import MeshError, read_mesh
from geodesics.arrays import Floats
from geodesics.errors import EigensolverFailed, FormatError
from geodesics.io import atomic_write
from gmds.comparison import distortion, profiles
from gmds.comparison.clustering import nearest
from gmds.comparison.described import BY_DISTANCES, Described
from gmds.files.folders import shape_names
from gmds.files.table import table_text
from gmds.maps.npz_format import fingerprint
from gmds.surface.view import View

Progress = Callable[[str, float], None]

IN_MEMORY = 40  # surfaces whose eigenfunctions are kept at a time: a bound of memory, 1.3 kB a vertex each
_EMBEDDING = f"{BY_DISTANCES.settings} {distortion.STARTS_PER_METRIC} {distortion.IMPROVED_STARTS} {distortion.SWEEPS}"


@dataclass(frozen=True, eq=False)
class Compared:
    """Shapes by name, with `bounds` and `distortions` (k, k): `least_distortion` and `dissimilarity` of every pair.

    Distortions are NaN where no embedding was computed. `failures`: why a file was left out, by its name. `by`: what
    the bounds are, if they are not those of distances.
    """

    names: tuple[str, ...]
    bounds: Floats
    distortions: Floats
    failures: Mapping[str, str] = field(default_factory=dict)
    by: Described = BY_DISTANCES

    @property
    def matrix(self) -> Floats:
        """The distortions if they are all known, else the bounds: never a mixture, as the two do not compare."""
        return self.bounds if np.isnan(self.distortions).any() else self.distortions

    @property
    def embedded_pairs(self) -> int:
        """How many pairs have a distortion."""
        return int(np.isfinite(np.triu(self.distortions, 1)[np.triu_indices(len(self.names), 1)]).sum())


def compare_files(
    paths: Sequence[Path],
    store: Path,
    *,
    embed: int = 0,
    by: Described = BY_DISTANCES,
    progress: Progress | None = None,
) -> Compared:
    """The shapes in mesh files, compared; `store` is a folder that keeps what was computed, for the next time.

    Every pair gets its bound, or what else two shapes are compared `by`; the pairs of each shape with the `embed`
    others of least bound get a distortion as well. A file that cannot be read or measured is named in `failures`.
    """
    report = progress or (lambda stage, fraction: None)
    store.mkdir(parents=True, exist_ok=True)
    known: dict[str, tuple[Path, str, Floats]] = {}
    failures: dict[str, str] = {}
    for i, (name, path) in enumerate(zip(shape_names(paths), paths, strict=True)):
        report(f"measuring {name}", 0.5 * i / len(paths))
        try:
            known[name] = (path, *_measured(path, store / by.folder / f"{name}.npz", by))
        except (MeshError, FormatError, EigensolverFailed, OSError) as error:
            failures[path.name] = str(error)
    names = tuple(known)
    bounds, distortions = np.zeros((len(names), len(names))), np.full((len(names), len(names)), np.nan)
    np.fill_diagonal(distortions, 0.0)
    for i, j in combinations(range(len(names)), 2):
        bounds[i, j] = bounds[j, i] = by.gap(known[names[i]][2], known[names[j]][2])
    near = nearest(bounds, embed)
    pairs = sorted({(min(i, j), max(i, j)) for i, row in enumerate(near.tolist()) for j in row if i != j})
    done = _Distortions(store / "distortions.csv")
    for number, (i, j) in enumerate(pairs):
        report(f"embedding {names[i]}, {names[j]}", 0.5 + 0.5 * number / len(pairs))
        (here, ours, _), (there, theirs, _) = known[names[i]], known[names[j]]
        found = done.get(ours, theirs, functools.partial(_embedded, here, there))
        distortions[i, j] = distortions[j, i] = found
    report("done", 1.0)
    return Compared(names, bounds, distortions, failures, by)


def _measured(path: Path, kept: Path, by: Described) -> tuple[str, Floats]:
    """What identifies the mesh in a file, and what it is compared by, from the file `kept` if it is there."""
    mesh = read_mesh(path)
    digest = fingerprint(mesh)["sha256"]
    try:
        with kept.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            if str(archive["digest"]) == digest and str(archive["settings"]) == by.settings:
                return digest, archive["profile"]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error):
        pass  # not there, or not whole: made again
    found = by.describe(mesh)
    kept.parent.mkdir(exist_ok=True)
    with atomic_write(kept) as stream:
        np.savez_compressed(stream, profile=found, digest=digest, settings=by.settings)
    return digest, found


@functools.lru_cache(IN_MEMORY)
def _views(path: Path) -> tuple[View, ...]:
    return profiles.views(read_mesh(path))


def _embedded(here: Path, there: Path) -> float:
    return distortion.embedding_distortion(_views(here), _views(there))


def _lines(text: str) -> Iterator[tuple[tuple[str, str, str], float]]:
    """What the lines say; one that was damaged says nothing."""
    for line in text.splitlines():
        with contextlib.suppress(ValueError, csv.Error):
            one, other, settings, value = next(csv.reader([line]))
            if np.isfinite(float(value)):
                yield (one, other, settings), float(value)


class _Distortions:
    """Distortions of embeddings that outlive the process: a CSV file, one pair a line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        text = path.read_bytes().decode("utf-8", "replace") if path.exists() else ""
        whole = text[: text.rfind("\n") + 1]  # a line cut short is computed again
        if whole != text:
            path.write_text(whole, encoding="utf-8")
        self.known = dict(_lines(whole))

    def get(self, one: str, other: str, compute: Callable[[], float]) -> float:
        """The distortion between two meshes, computed unless it is known."""
        key = (min(one, other), max(one, other), _EMBEDDING)
        if key not in self.known:
            self.known[key] = compute()
            with self.path.open("a", newline="", encoding="utf-8") as stream:
                stream.write(table_text([[*key, self.known[key]]]))
        return self.known[key]
