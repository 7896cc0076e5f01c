"""Mutation testing of the door: validators, readers, map algebra. Small faults, one at a time; do the tests notice?

    python -m benchmarks.mutation.mutants --each 25 --seed 0

Faults are drawn at random (`mutant.py` says which kinds there are); only the tests named here run for a module, until
one fails. Writes results/mutants.csv, where what is done already is kept, and results/mutants.md with the survivors.
A fault belongs to the text of its module: when that changes, what was done for it counts no more. Another seed draws
faults that no earlier seed has drawn: tests that were written for the survivors of one seed are judged by the next.
"""

from __future__ import annotations

import argparse
import csv
import importlib
import os
import signal
import sys
import tempfile
import time
import zlib
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.markdown import table
from benchmarks.mutation.mutant import faulty, install, places
from benchmarks.places import RESULTS, ROOT

HERE = Path(__file__).resolve().parent
SECONDS = 120  # of processor time; a fault that makes a loop endless is noticed as well
SHARED = ("pytest", "hypothesis.extra.numpy", "igl", "numba", "scipy.sparse.linalg", "scipy.spatial", "trimesh")
READERS = (
    "test_bad_files",
    "test_file_limits",
    "test_io",
    "test_truncation",
    "test_damage",
    "test_values",
)  # the quickest first
MODULES: dict[str, tuple[str, ...]] = {
    "geodesics._validation": ("test_bad_arrays", "test_points", "test_mesh"),
    "geodesics._duck": ("test_bad_arrays",),
    "geodesics.check": ("test_check", "test_repair"),
    "geodesics.repair.repairing": ("test_repair", "test_remeshing"),
    "geodesics.repair.remeshing": ("test_remeshing", "test_repair"),
    "geodesics.repair.splitting": ("test_splitting",),
    "geodesics.topology.orientation": ("test_check", "test_repair", "test_values"),
    "geodesics.memory": ("test_memory",),
    **{f"geodesics.io.{name}": READERS for name in ("glb", "obj", "off", "opening", "ply", "stl", "text", "tosca")},
    **dict.fromkeys(
        [f"geodesics.io.{name}" for name in ("gltf_accessor", "gltf_container", "gltf_nodes")],
        ("test_scenes", "test_bad_files", "test_characters"),
    ),
    **dict.fromkeys(
        [
            f"geodesics.io.{name}"
            for name in ("vtk", "vtp", "cells", "packed_array", "polygons", "sniffing", "precision")
        ],
        ("test_formats_of_others", "test_polygons", "test_precision", "test_bad_files"),
    ),
    **{
        f"gmds.characters.{name}": ("test_characters",) for name in ("carrying", "scene", "skeleton", "tree", "writing")
    },
    "geodesics.io.truncation": ("test_truncation",),
    "geodesics.io.writing": ("test_io", "test_bad_files", "test_file_limits"),
    "geodesics.io.atomic": ("test_file_limits", "test_bad_files", "test_system"),
    "gmds.suggestions": ("test_landmarks",),
    "gmds.landmarks.checking": ("test_landmarks", "test_values"),
    "gmds.files.table": ("test_table",),
    "gmds.files.npz": ("test_npz_file", "test_map_damage"),
    "gmds.maps.npz_format": ("test_map_file", "test_map_damage"),
    "gmds.maps.images": ("test_images", "test_correspondence"),
    "gmds.correspondence": ("test_correspondence", "test_map_file", "test_images", "test_values"),
    **dict.fromkeys(
        [f"gmds.landmarks.files.{name}" for name in ("named_points", "plain", "reading", "slicer", "table")],
        ("test_bad_landmark_files", "test_landmark_formats", "test_values"),
    ),
}


class Fault(NamedTuple):
    """One fault: what became of it, and the digest of the text of the module that it was put into."""

    module: str
    number: int
    seed: int
    killed: bool
    where: str
    digest: str


Done = dict[tuple[str, int], Fault]


def source(module: str) -> str:
    """The text of a module."""
    return (ROOT / f"{module.replace('.', '/')}.py").read_text(encoding="utf-8")


def digest(module: str) -> str:
    """What the text of a module is known by."""
    return f"{zlib.crc32(source(module).encode()):08x}"


def run_tests(module: str, number: int, hook: Path) -> int:
    """What pytest answers when the module has the fault; its words go to a file."""
    import pytest

    said = os.open(hook / "said.txt", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(said, 1)
    os.dup2(said, 2)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    path = os.pathsep.join((str(hook), str(HERE), os.environ.get("PYTHONPATH", "")))
    os.environ.update(GMDS_MUTANT=f"{module}:{number}", PYTHONPATH=path)
    install()
    os.chdir(ROOT)
    tests = [str(next((ROOT / "tests").rglob(f"{name}.py"))) for name in MODULES[module]]
    early = "ignore::pytest.PytestAssertRewriteWarning"  # hypothesis is there before pytest
    return int(pytest.main(["-x", "-q", "-W", early, "-p", "no:cacheprovider", *tests])) & 127


def killed(module: str, number: int, hook: Path) -> bool:
    """Whether the tests notice the fault; they run in a fork, so that what all have in common is imported once."""
    child = os.fork()
    if child == 0:
        try:
            os._exit(run_tests(module, number, hook))
        finally:
            os._exit(1)
    deadline = time.monotonic() + 20 * SECONDS
    while (status := os.waitpid(child, os.WNOHANG)) == (0, 0):
        if time.monotonic() > deadline:
            os.kill(child, signal.SIGKILL)
        time.sleep(0.05)
    return status[1] != 0


def read(path: Path) -> Done:
    """What was done before, for modules that are as they were then."""
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as stream:
        _, *lines = csv.reader(stream)
    rows = [Fault(name, int(at), int(seed), was == "True", where, text) for name, at, seed, was, where, text in lines]
    return {(row.module, row.number): row for row in rows if row.module in MODULES and row.digest == digest(row.module)}


def write(path: Path, done: Done) -> None:
    """All that is done."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(Fault._fields)
        writer.writerows(sorted(done.values()))


def share(faults: list[Fault]) -> tuple[int, int, str]:
    """Faults, how many of them were noticed, and the share."""
    noticed = sum(fault.killed for fault in faults)
    return len(faults), noticed, f"{100 * noticed / max(1, len(faults)):.1f} %"


def page(done: Done) -> str:
    """The figures by seed and by module, and the survivors."""
    every = sorted(done.values())
    seeds = [(seed, *share([f for f in every if f.seed == seed])) for seed in sorted({f.seed for f in every})]
    modules = [
        (f"`{module}`", places(source(module)), *share([f for f in every if f.module == module]))
        for module in dict.fromkeys(f.module for f in every)
    ]
    lines = [
        "# Mutation testing",
        "",
        "`python -m benchmarks.mutation.mutants`: faults put in at random, and whether the tests",
    ]
    lines += ["notice. Each seed draws faults that no earlier one has drawn: tests were written for the survivors of"]
    lines += ["seed 0, and none for those of seed 1.", ""]
    lines += table(["seed", "faults", "noticed", "share"], [*seeds, ("all", *share(every))])
    lines += table(["module", "places", "faults", "noticed", "share"], modules)
    survivors = [(f"`{fault.module}`", fault.seed, fault.where) for fault in every if not fault.killed]
    return "\n".join([*lines, "Not noticed:", "", *table(["module", "seed", "where"], survivors)])


def main() -> None:
    """Draw, run, write as it goes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=20, help="faults a module (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=list(MODULES), action="append")
    parser.add_argument("--again", action="store_true", help="run those again that were not noticed")
    options = parser.parse_args()
    for shared in SHARED:
        importlib.import_module(shared)
    path = RESULTS / "mutants.csv"
    done = read(path)
    with tempfile.TemporaryDirectory() as hook:
        (Path(hook) / "sitecustomize.py").write_text("import mutant\nmutant.install()\n", encoding="utf-8")
        sound = set()
        for module in options.only or MODULES:
            rng = np.random.default_rng([options.seed, *module.encode()])
            order = [(module, int(number)) for number in rng.permutation(places(source(module)))]
            fresh = [key for key in order if key not in done or done[key].seed == options.seed][: options.each]
            left = [key for key in fresh if key not in done or (options.again and not done[key].killed)]
            if left and MODULES[module] not in sound and killed(module, -1, Path(hook)):
                said = (Path(hook) / "said.txt").read_text(encoding="utf-8", errors="replace")
                sys.exit(f"the tests of {module} fail without any fault:\n{said[-3000:]}")
            sound.add(MODULES[module])
            for key in left:
                was, where = killed(*key, Path(hook)), faulty(source(module), key[1])[1]
                done[key] = Fault(*key, options.seed, was, where, digest(module))
                print(*done[key], file=sys.stderr, flush=True)
                write(path, done)
                (RESULTS / "mutants.md").write_text(page(done), encoding="utf-8")


if __name__ == "__main__":
    main()
