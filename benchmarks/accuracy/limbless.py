"""Shapes without limbs, and classes of them: teeth, skulls, faces, brains, bones, hands; beside rigid and smooth peers.

    pip install pyfmaps==1.3.1 trimesh biocpd==1.3.0 meshmonk==0.3.0
    GMDS_DATA=... python -m benchmarks.accuracy.limbless [--methods gmds,ICP] [--only teeth] [--half reporting]

The pairs of `benchmarks.trust.cases` of these kinds, every mesh turned and resized at random, defaults only, but for
`orientation` where a user would not know which sides specimens are of ("any") or does ("reverse"); peers are told as
much (`benchmarks.accuracy.extrinsic_peers`), and pyFM is given the mirror image of the target where ICP prefers that.
Mean geodesic error x100 at all known points of a pair. Right is a mean below 4, wrong one above 10. CPU seconds are of
one thread. Rows of results/limbless.csv that are of this version are not done again. Writes limbless.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as release
from pathlib import Path

import numpy as np

from benchmarks.accuracy import extrinsic_peers
from benchmarks.accuracy.limbless_page import ALL_SEEN, COLUMNS, page
from benchmarks.accuracy.peers import functional_map
from benchmarks.accuracy.runs import ONE_THREAD, code_version, warm_up
from benchmarks.places import RESULTS
from benchmarks.trust.cases import Case, cases
from geodesics import Mesh, SurfacePoints
from gmds import match
from gmds.benchmarking.run import turned
from gmds.correspondence import Correspondence
from gmds.evaluation import geodesic_error
from gmds.files.table import read_table, write_table

KINDS = (
    "teeth",
    "skulls",
    "faces",
    "endocasts",
    "brain parts",
    "left-right",
    "hand",
    "armadillo",
    "fish",
    "teddy",
    "human",
)
NOT_KNOWN = "by default"  # pairs of teeth that are matched as if both were of one side


def by_default(source: Mesh, target: Mesh, orientation: str) -> Correspondence:
    """Ours."""
    return match(source, target, orientation=orientation)  # type: ignore[arg-type]


def pyfm(source: Mesh, target: Mesh, orientation: str) -> Correspondence:
    """pyFM's, to the mirror image where ICP prefers it."""
    side = extrinsic_peers.aligned(source, target, orientation).side if orientation == "any" else 1
    if orientation == "reverse" or side < 0:
        image = Mesh(target.vertices * extrinsic_peers.MIRROR, target.faces[:, ::-1])
        images = functional_map(source, image).points.nearest_vertices()
        return Correspondence.from_points(source, SurfacePoints.at_vertices(target, images))
    return functional_map(source, target)


METHODS: dict[str, tuple[Callable[..., Correspondence], str | None]] = {
    "gmds": (by_default, None),
    "ICP": (extrinsic_peers.rigid_icp, "trimesh"),
    "biocpd": (extrinsic_peers.biocpd, "biocpd"),
    "meshmonk": (extrinsic_peers.meshmonk, "meshmonk"),
    "pyFM": (pyfm, "pyfmaps"),
}


def matcher(name: str) -> Callable[..., Correspondence]:
    """A method by its name."""
    return METHODS[name][0]


def versions() -> dict[str, str]:
    """Of every method: the commit of ours, the release of those that are there."""
    found = {"gmds": code_version()}
    for name, (_, package) in METHODS.items():
        try:
            if package is not None:
                found[name] = f"{package} {release(package)}"
        except PackageNotFoundError:
            continue
    return found


def chosen() -> list[Case]:
    """The cases of these kinds."""
    return [case for case in cases() if case.kind in KINDS and not case.name.endswith(NOT_KNOWN)]


def row(name: str, method: str, version: str) -> dict[str, str]:
    """One pair, matched and judged."""
    case = next(one for one in chosen() if one.name == name)
    known, rng = case.load(), np.random.default_rng([0, *name.encode()])
    source, target = turned(known.source, rng), turned(known.target, rng)
    warm_up(_on_any, method)
    told = {"pair": name, "kind": case.kind, "half": case.half, "method": method, "version": version}
    started = time.process_time()
    try:
        answer = matcher(method)(source, target, case.options.get("orientation", "preserve"))
    except Exception as error:  # whatever a peer raises is its answer
        return {**told, "error": "none", "status": f"{type(error).__name__}: {error}"[:60], "cpu_seconds": "none"}
    seconds = time.process_time() - started
    truth = SurfacePoints(target, known.truth.face, known.truth.barycentric)
    errors = geodesic_error(answer, truth, known.vertices)
    return {
        **told,
        "error": f"{100 * float(errors.mean()):.3f}",
        "status": answer.status.name if method == "gmds" else "-",
        "cpu_seconds": f"{seconds:.2f}",
    }


def _on_any(method: str) -> Callable[[Mesh, Mesh], Correspondence]:
    return lambda source, target: matcher(method)(source, target, "preserve")


def selected(options: argparse.Namespace, done: Sequence[dict[str, str]]) -> list[tuple[str, str, str]]:
    """Pairs, methods and versions that are to be run."""
    known = {(one["pair"], one["method"], one["version"]) for one in done}
    found = versions()
    methods = list(found) if options.methods is None else options.methods.split(",")
    wanted = [case for case in chosen() if options.only in f"{case.kind} {case.name}"]
    wanted = [case for case in wanted if options.half in (None, case.half)]
    todo = [(case.name, method, found[method]) for case in wanted for method in methods]
    return [one for one in todo if one not in known]


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--methods", help="names, separated by commas (default: all that are installed)")
    parser.add_argument("--only", default="", help="pairs with this in their kind or name")
    parser.add_argument("--half", choices=("development", "reporting"))
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    path = options.output / "limbless.csv"
    rows = read_table(path) if path.is_file() else []
    todo = selected(options, rows)
    order = {case.name: number for number, case in enumerate(chosen())}
    with ProcessPoolExecutor(options.workers, multiprocessing.get_context("spawn")) as pool:
        for future in as_completed([pool.submit(row, *one) for one in todo]):
            new = future.result()
            rows = [one for one in rows if (one["pair"], one["method"]) != (new["pair"], new["method"])] + [new]
            print(*new.values(), file=sys.stderr)
            rows.sort(key=lambda one: (order[one["pair"]], list(METHODS).index(one["method"])))
            write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in rows])
    text = "\n".join(page(rows, KINDS, list(METHODS), ALL_SEEN, len(order)))
    (options.output / "limbless.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
