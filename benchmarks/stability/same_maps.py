"""The bytes of the map of every development pair, and whether they are those of another checkout.

    GMDS_DATA=... python -m benchmarks.accuracy.development_pairs OUT_DIR      # once
    python -m benchmarks.stability.same_maps OUT_DIR -o now.csv                # in each checkout
    python -m benchmarks.stability.same_maps OUT_DIR -o now.csv --against then.csv

A change that only moves code must keep every byte: of the points, their weights, `valid`, `distortion`, `confidence`,
the status and every candidate. Exit code 1 when a map differs. What is in the CSV is not matched again.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import gmds
from geodesics import read_mesh

COLUMNS = ("pair", "digest", "status", "cpu_seconds")


def pairs(folder: Path, data: Path) -> Iterator[tuple[str, Path, Path]]:
    """Name, source and target of every development pair that `development_pairs` wrote or listed."""
    for path in sorted((folder / "scaled").glob("*.npz")):
        yield path.stem, folder / "scaled" / f"source_{path.stem}.off", folder / "scaled" / f"{path.stem}.off"
    for listing in sorted(folder.glob("*.txt")):
        for line in listing.read_text(encoding="utf-8").splitlines():
            one, other = line.split()
            models = data / listing.stem
            yield f"{listing.stem}:{one}-{other}", models / f"{one}.off", models / f"{other}.off"


def digest(answer: gmds.Correspondence) -> str:
    """Sixteen characters that change when any array of the map or of its candidates does."""
    arrays = [answer.points.face, answer.points.barycentric, answer.valid, answer.distortion, answer.confidence]
    for candidate in answer.candidates:
        arrays += [candidate.points.face, candidate.points.barycentric]
    found = hashlib.sha256()
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()[:16]


def read_rows(path: Path | None) -> dict[str, dict[str, str]]:
    """The rows of a CSV by the name of the pair; none where there is no such file."""
    if path is None or not path.is_file():
        return {}
    with path.open(newline="", encoding="utf-8") as stream:
        return {row["pair"]: row for row in csv.DictReader(stream)}


def main() -> int:
    """Match what is not in the table yet, write it, compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="what `development_pairs` wrote")
    parser.add_argument("-o", "--output", type=Path, required=True, help="CSV of this checkout")
    parser.add_argument("--against", type=Path, help="CSV of the other")
    parser.add_argument("--every", type=int, default=1, help="every N-th pair only")
    options = parser.parse_args()
    rows = read_rows(options.output)
    for name, source, target in list(pairs(options.folder, Path(os.environ["GMDS_DATA"])))[:: options.every]:
        if name in rows:
            continue
        meshes = read_mesh(source), read_mesh(target)
        started = time.process_time()
        answer = gmds.match(*meshes)
        spent = time.process_time() - started
        rows[name] = dict(zip(COLUMNS, (name, digest(answer), answer.status.name, f"{spent:.2f}"), strict=True))
        with options.output.open("w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows[key] for key in sorted(rows))
        print(*rows[name].values(), file=sys.stderr)
    other = read_rows(options.against)
    shared = [name for name in rows if name in other]
    differ = [name for name in shared if rows[name]["digest"] != other[name]["digest"]]
    print(f"{len(rows)} maps; of {len(shared)} in both, {len(shared) - len(differ)} are the same byte for byte")
    for name in differ:
        print(f"differs: {name}")
    return int(bool(differ))


if __name__ == "__main__":
    sys.exit(main())
