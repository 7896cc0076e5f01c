"""Parts of surfaces: error where there is a counterpart, and how well what has none is marked.

    GMDS_DATA=... python -m benchmarks.accuracy.parts [--groups PFAUST-M,PFAUST-H] [--half reporting] [--workers 2]
    pip install pyfmaps==1.3.1; GMDS_DATA=... python -m benchmarks.accuracy.parts --peer

The pairs of `partial/pairs.json` and the scans of SHREC'20, every mesh turned and resized at random, defaults only.
Mean geodesic error x100 on what has a counterpart (protocol of `gmds benchmark`), overlap IoU, precision and recall
of `valid` by vertices with a known answer; as evidence minus the log-likelihood of the simplified meshes, correlation
of curvature, and stress. Hyper-parameters were chosen on the pairs named in `DEVELOPMENT`; figures are of the others.
Writes results/parts.csv, where what was measured at this version of the code is not measured again, and
results/parts.md.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import gmds
from benchmarks.accuracy.halves import PARTIAL, half_of, pairs_of
from benchmarks.accuracy.part_tables import NAMES, cells_of, statuses
from benchmarks.accuracy.peers import functional_map
from benchmarks.accuracy.runs import ONE_THREAD, code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.arrays import Integers
from gmds.benchmarking.run import Matcher, turned
from gmds.correspondence import Correspondence
from gmds.evaluation import geodesic_error, protocol_subset
from gmds.files.table import read_table, write_table
from gmds.registration.residuals import Residuals
from gmds.shapes import quadruped

DEVELOPMENT = ("003", "008", "013", "023", "H_018", "9_dog", "9_lion", "0_cow", "24_cow")
COLUMNS = (
    "pair",
    "group",
    "version",
    "status",
    "error",
    "iou",
    "precision",
    "recall",
    "cpu_seconds",
    "part",
    "margin",
    "likelihood",
    "curvature",
    "stress",
)
GOALS = {"PFAUST-M": "3.0", "PFAUST-H": "3.5", "PFAUST-M back": "4.0 / 0.90", "PFAUST-H back": "4.0 / 0.90"}
GOALS["PARTIALSMAL"] = "8.0 / 0.80"
SCANS = {
    "shrec20": "SHREC'20 scan",
    "shrec20_reversed": "SHREC'20 scan back",
}  # sets of which the partial test set counts
GOALS |= {SCANS["shrec20"]: "8.0", SCANS["shrec20_reversed"]: "12.0"}
PEER = "pyfmaps 1.3.1"  # the version of what others reach


def is_development(name: str) -> bool:
    """Whether hyper-parameters were chosen on this pair."""
    if any(name in half_of(some, "development") for some in SCANS):
        return True
    return any(part in name for part in DEVELOPMENT)


def scans() -> list[dict[str, str]]:
    """Scans of animals from one side and whole animals of other species, both ways, as entries of `pairs.json` are."""
    return [
        {"name": pair.name, "group": group, "set": name}
        for name, group in SCANS.items()
        for pair in pairs_of(name)
        if pair.group == PARTIAL or name.endswith("_reversed")
    ]


def row(entry: Mapping[str, str], version: str) -> dict[str, Any]:
    """One pair, matched and judged."""
    return judged_row(entry, *meshes_and_truth(entry), version)


def row_of_peer(entry: Mapping[str, str], version: str) -> dict[str, Any]:
    """The same pair, matched by pyFM as in `benchmarks.accuracy.peers`."""
    return judged_row(entry, *meshes_and_truth(entry), version, functional_map)


def meshes_and_truth(entry: Mapping[str, str]) -> tuple[tuple[Mesh, Mesh], Known]:
    """What a pair of `pairs.json`, or of `scans`, names."""
    if "set" in entry:
        pair = next(one for one in pairs_of(entry["set"]) if one.name == entry["name"])
        meshes = read_mesh(pair.source), read_mesh(pair.target)
        there, points, _ = pair.truth(*meshes)
        missing = None if pair.missing is None else pair.missing()
        return meshes, Known(there, points, np.zeros(0, dtype=np.int64) if missing is None else missing)
    data = Path(os.environ["GMDS_DATA"])
    truth = np.load(data / entry["truth"])
    known = Known(truth["src"], truth["gt"], truth["missing"])
    return (read_mesh(data / entry["source"]), read_mesh(data / entry["target"])), known


class Known(NamedTuple):
    """What is known of a pair: source vertices (k,), their vertices or points on the target, and vertices without."""

    there: Integers
    points: Integers | SurfacePoints
    missing: Integers


def judged_row(
    names: Mapping[str, str], meshes: tuple[Mesh, Mesh], known: Known, version: str, matcher: Matcher = gmds.match
) -> dict[str, Any]:
    """Two meshes turned and resized at random by the `name` of the pair, matched and judged."""
    rng = np.random.default_rng([0, *names["name"].encode()])
    source, target = (turned(mesh, rng) for mesh in meshes)
    truth = known.points
    if isinstance(truth, SurfacePoints):
        truth = SurfacePoints(target, truth.face, truth.barycentric)
    gmds.match(quadruped(n_vertices=600), quadruped(n_vertices=600))  # so that no pair pays for imports
    started = time.process_time()
    answer = matcher(source, target)
    seconds = time.process_time() - started
    judged = protocol_subset(len(known.there))
    error = 100 * float(geodesic_error(answer, truth[judged], known.there[judged]).mean())
    there, gone = np.unique(known.there), np.setdiff1d(known.missing, known.there)
    kept, wrong = int(answer.valid[there].sum()), int(answer.valid[gone].sum())
    return {
        "pair": names["name"],
        "group": names["group"],
        "version": version,
        "status": answer.status.name,
        "error": f"{error:.3f}",
        "iou": f"{kept / max(len(there) + wrong, 1):.4f}",
        "precision": f"{kept / max(kept + wrong, 1):.4f}",
        "recall": f"{kept / max(len(there), 1):.4f}",
        "cpu_seconds": f"{seconds:.2f}",
        "part": answer.meta.get("part", "-"),
        **evidence_of(answer),
    }


def evidence_of(answer: Correspondence) -> dict[str, str]:
    """What our matcher says for a map; nothing of that of others."""
    evidence = answer.meta.get("evidence")
    if evidence is None:
        return dict.fromkeys(("margin", "likelihood", "curvature", "stress"), "-")
    likelihood = sum(Residuals(**evidence[way]).neg_log_likelihood for way in ("outline", "outline_back"))
    figures = (evidence.get("margin", 0), likelihood, evidence["whole"]["curvature"], evidence["stress"])
    return {
        name: f"{value:.2f}"
        for name, value in zip(("margin", "likelihood", "curvature", "stress"), figures, strict=True)
    }


def read_rows(path: Path, version: str) -> dict[str, dict[str, str]]:
    """The rows of this version of the code, by pair."""
    if not path.is_file():
        return {}
    return {line["pair"]: line for line in read_table(path) if line["version"] == version}


def run(
    judge: Callable[..., dict[str, Any]], todo: Iterable[Any], path: Path, version: str, workers: int
) -> dict[str, dict[str, Any]]:
    """All rows of this version, those of `judge` of what is still to do among them; each written as it comes."""
    rows: dict[str, dict[str, Any]] = {**read_rows(path, version)}
    with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(judge, one, version) for one in todo]
        for done in as_completed(futures):
            found = done.result()
            rows[found["pair"]] = found
            write_rows(path, rows)
            print(*found.values(), file=sys.stderr)
    return rows


def write_rows(path: Path, rows: Mapping[str, Mapping[str, Any]]) -> None:
    """All rows, ordered by group and pair."""
    ordered = sorted(rows.values(), key=lambda one: (one["group"], one["pair"]))
    write_table(path, COLUMNS, [[one[column] for column in COLUMNS] for one in ordered])


def page(rows: Sequence[Mapping[str, str]], version: str) -> str:
    """The table of both halves."""
    command = f"python -m benchmarks.accuracy.parts{' --peer' if version == PEER else ''}"
    lines = ["# Parts", "", f"`{command}` at {version}; see the script for the protocol.", ""]
    halves = {
        title: [one for one in rows if is_development(one["pair"]) == half]
        for title, half in (("Reporting half", False), ("Development half", True))
    }
    for title, known in halves.items():
        groups = {group: [one for one in known if one["group"] == group] for group in GOALS}
        cells = [cells_of(group, some, GOALS[group]) for group, some in groups.items() if some]
        lines += [f"## {title}", "", *table(NAMES, cells), ""]
    if version != PEER:  # others say nothing of how far to trust a map
        lines += ["## Status", "", *statuses({**halves, "all": rows})]
    return "\n".join(lines)


def main() -> None:
    """Match what is not in the table, write both files."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--groups", type=lambda text: text.split(","), help="names, separated by commas")
    parser.add_argument("--half", choices=("development", "reporting"))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--peer", action="store_true", help="pyFM on the same pairs")
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    os.environ.update(ONE_THREAD)
    entries = json.loads((Path(os.environ["GMDS_DATA"]) / "partial" / "pairs.json").read_text(encoding="utf-8"))
    entries += scans()
    entries = [one for one in entries if options.groups is None or one["group"] in options.groups]
    if options.half is not None:
        entries = [one for one in entries if is_development(one["name"]) == (options.half == "development")]
    name, version = ("peers_parts", PEER) if options.peer else ("parts", code_version())
    path = options.output / f"{name}.csv"
    todo = [one for one in entries if one["name"] not in read_rows(path, version)]
    rows = run(row_of_peer if options.peer else row, todo, path, version, options.workers)
    text = page(list(rows.values()), version)
    (options.output / f"{name}.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
