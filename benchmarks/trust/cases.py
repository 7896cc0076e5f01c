"""The pairs that confidence is fitted to and judged on: every kind there is, good maps and bad ones."""

from __future__ import annotations

import itertools
import json
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.accuracy import cuts
from benchmarks.accuracy.halves import pairs_of
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.arrays import Integers
from gmds import shapes
from gmds.benchmarking.pairs import Pair
from gmds.benchmarking.truth_files import shared_landmarks

# Of large sets every so many pairs, or fitting would take a day: kinds count alike, however many pairs they have.
EVERY = {"faust_5k": 9, "tosca_5k": 9, "tosca_cross_5k": 3, "shrec20": 1, "shrec20_reversed": 1, "scaled": 1}
KINDS = {"faust_5k": "FAUST", "tosca_5k": "TOSCA", "tosca_cross_5k": "gorilla - human", "scaled": "scaled"}
SPECIES = ("bear", "bison", "camel_a", "cow", "dog", "hippo", "leopard", "pig", "rhino")  # of SHREC'20, whole
TEETH = (  # pairs that pairs.json has not; both kinds of sides
    ("w10", "J09"),
    ("w10", "Q10"),
    ("D09", "Q10"),
    ("J09", "u19"),
    ("D09", "i17"),
    ("w10", "V02"),
    ("u19", "V02"),
    ("Q10", "S09"),
    ("J09", "j18"),
    ("i17", "S09"),
    ("u19", "j18"),
    ("V02", "j18"),
)
EVERY_PART, EVERY_CUT = 3, 3
COARSE = (300, 450, 600)
POSES = ((shapes.quadruped, "walk"), (shapes.quadruped, "graze"), (shapes.humanoid, "walk"), (shapes.humanoid, "kick"))
GROWN = (
    (shapes.quadruped, "turn", "ear_scale", 0.6),
    (shapes.quadruped, "graze", "ear_scale", 0.6),
    (shapes.quadruped, "walk", "tail_scale", 1.5),
    (shapes.quadruped, "graze", "leg_scale", 1.3),
    (shapes.quadruped, "walk", "ear_scale", 2.0),
    (shapes.quadruped, "turn", "tail_scale", 0.6),
    (shapes.humanoid, "walk", "head_scale", 1.4),
    (shapes.humanoid, "kick", "hand_scale", 1.3),
    (shapes.humanoid, "wave", "leg_scale", 0.7),
    (shapes.humanoid, "walk", "hand_scale", 1.6),
)
HALVES = ("development", "reporting")


class Known(NamedTuple):
    """Two meshes, and for vertices of the source where they belong."""

    source: Mesh
    target: Mesh
    vertices: Integers
    truth: SurfacePoints


class Case(NamedTuple):
    """A pair of some kind, how it is loaded, what `match` is told, and which half it belongs to."""

    name: str
    kind: str
    load: Callable[[], Known]
    options: dict[str, Any]
    half: str


def cases() -> list[Case]:
    """All of them, the kinds in turn, half of each kind for development.

    A pair and its way back are next to another: of four in turn the outer two are for development.
    """
    kinds: dict[str, list[Case]] = {}
    for name, kind, load, options in itertools.chain(
        _published(), _anatomy(), _species(), _parts(), _coarse(), _grown()
    ):
        of_kind = kinds.setdefault(kind, [])
        of_kind.append(Case(name, kind, load, options, HALVES[len(of_kind) % 4 in (1, 2)]))
    return [case for row in itertools.zip_longest(*kinds.values()) for case in row if case is not None]


Row = tuple[str, str, Callable[[], Known], dict[str, Any]]


def _published() -> Iterator[Row]:
    for name, every in EVERY.items():
        pairs = pairs_of(name)
        for pair in pairs[1::every] if every > 1 else pairs:
            yield f"{name} {pair.name}", KINDS.get(name, "SHREC'20"), _pair(pair), {}


def _anatomy() -> Iterator[Row]:
    folder = Path(os.environ["GMDS_DATA"])
    entries = json.loads((folder / "anatomy" / "pairs.json").read_text(encoding="utf-8"))
    for entry in entries:
        kind = entry["name"].split("_")[1] if entry["group"] == "classes" else entry["group"]
        options = {} if entry.get("orientation") is None else {"orientation": entry["orientation"]}
        yield entry["name"], kind, _files(entry), options
        if kind == "teeth":
            yield f"{entry['name']} by default", kind, _files(entry), {}
        elif kind not in ("skulls", "faces"):
            yield f"{entry['name']} back", kind, _files(entry, back=True), options
    teeth = [entry for entry in entries if entry["group"] == "teeth"]
    first = {entry["name"].split("_")[-1].split("-")[0]: entry for entry in teeth}
    second = {entry["name"].split("-")[-1]: entry for entry in teeth}
    for a, b in TEETH:
        yield f"tooth {a}-{b}", "teeth", _files(first[a], other=second[b]), {"orientation": "any"}


def _species() -> Iterator[Row]:
    folder = Path(os.environ["GMDS_DATA"]) / "shrec20"
    published = {pair.name.replace("-", ",") for pair in pairs_of("shrec20")}
    rest = [(a, b) for a in SPECIES for b in SPECIES if a != b and f"{a},{b}" not in published]
    for a, b in np.random.default_rng(3).permutation(rest)[:24]:

        def load(a: str = str(a), b: str = str(b)) -> Known:
            source, target = (read_mesh(folder / "models" / f"{name}.obj") for name in (a, b))
            vertices, truth = shared_landmarks(folder / "gts" / f"{a}.mat", folder / "gts" / f"{b}.mat", target)
            return _known(source, target, vertices, truth)

        yield f"species {a}-{b}", "other species", load, {}


def _parts() -> Iterator[Row]:
    entries = json.loads((Path(os.environ["GMDS_DATA"]) / "partial" / "pairs.json").read_text(encoding="utf-8"))
    persons = [entry for entry in entries if entry["group"].startswith("PFAUST")]
    for entry in persons[::EVERY_PART]:
        yield entry["name"], "PFAUST", _files(entry), {}
    for entry in entries:
        if entry["group"] == "PARTIALSMAL":
            yield entry["name"], "PARTIALSMAL", _files(entry), {}
    tasks = [(cutting, back) for cutting in cuts.CUTTINGS for back in (False, True)]
    for cutting, back in tasks[::EVERY_CUT]:

        def load(cutting: cuts.Cutting = cutting, back: bool = back) -> Known:
            make = cuts.built_in if cutting.group == "built-in" else cuts.published
            part, whole, known = make(cutting, back)
            source, target = (whole, part.mesh) if back else (part.mesh, whole)
            return _known(source, target, known.there, known.points)

        yield f"cut {cuts.named(cutting, back)}", "cuts", load, {}


def _coarse() -> Iterator[Row]:
    """Built-in shapes with so few vertices that an ear is a handful, each with itself in another pose."""
    for n_vertices, (make, pose) in itertools.product(COARSE, POSES):

        def load(n_vertices: int = n_vertices, make: Callable[..., Any] = make, pose: str = pose) -> Known:
            source, target = make(n_vertices=n_vertices), make(pose, n_vertices=n_vertices, seed=2)
            return _known(source, target, range(source.n_vertices), shapes.truth(source, target))

        yield f"coarse {make.__name__} {pose} {n_vertices}", "coarse", load, {}


def _grown() -> Iterator[Row]:
    """Built-in shapes and others of which a part is larger or smaller, in other poses."""
    for number, (make, pose, part, size) in enumerate(GROWN):

        def load(
            make: Callable[..., Any] = make, pose: str = pose, part: str = part, size: float = size, seed: int = number
        ) -> Known:
            source, target = make(n_vertices=1500), make(pose, n_vertices=1500, seed=seed + 3, **{part: size})
            return _known(source, target, range(source.n_vertices), shapes.truth(source, target))

        yield f"grown {make.__name__} {pose} {part} {size}", "grown", load, {}


def _pair(pair: Pair) -> Callable[[], Known]:
    def load() -> Known:
        source, target = read_mesh(pair.source), read_mesh(pair.target)
        vertices, truth, _ = pair.truth(source, target)
        return _known(source, target, vertices, truth)

    return load


def _files(entry: dict[str, str], *, other: dict[str, str] | None = None, back: bool = False) -> Callable[[], Known]:
    """Of an entry of pairs.json; with the target of another one; or from target to source."""

    def load() -> Known:
        folder, last = Path(os.environ["GMDS_DATA"]), other or entry
        source, target = read_mesh(folder / entry["source"]), read_mesh(folder / last["target"])
        ours = np.load(folder / entry["truth"])["src"].astype(np.int64)
        theirs = np.load(folder / last["truth"])["gt"].astype(np.int64)
        if not back:
            return _known(source, target, ours, theirs)
        theirs, first = np.unique(theirs, return_index=True)
        there = np.isin(ours[first], source.faces)  # what is on no face is no point of the surface
        return _known(target, source, theirs[there], ours[first][there])

    return load


def _known(source: Mesh, target: Mesh, vertices: Iterable[int], truth: SurfacePoints | Integers) -> Known:
    points = truth if isinstance(truth, SurfacePoints) else SurfacePoints.at_vertices(target, truth)
    return Known(source, target, np.asarray(vertices, dtype=np.int64), points)
