"""One match again and again, over numbers of threads and hash seeds: how many different answers?

    python -m benchmarks.stability.determinism --runs 20

Two poses of the built-in animal, 5,000 and 4,000 vertices, in a new process each time; 1, 2 or 8 threads in turn, for
those of BLAS as well, and a random PYTHONHASHSEED. Writes results/determinism.md; exit code 1 when two differ.
"""

from __future__ import annotations

import argparse
import os
import secrets
import subprocess
import sys
from collections import Counter

from benchmarks.markdown import table
from benchmarks.places import RESULTS

PAGE = RESULTS / "determinism.md"
THREADS = (1, 2, 8)
JOB = """
import hashlib, gmds
a = gmds.shapes.quadruped("stand", n_vertices=5000)
b = gmds.shapes.quadruped("walk", head_scale=2, n_vertices=4000, seed=1)
answer = gmds.match(a, b)
rows = (answer.points.face, answer.points.barycentric, answer.valid, answer.distortion)
print(hashlib.sha256(b"".join(row.tobytes() for row in rows)).hexdigest()[:16])
"""


def answered(threads: int) -> str:
    """The digest of the map, from a new process."""
    names = ("GMDS_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
    own = {**dict.fromkeys(names, str(threads)), "PYTHONHASHSEED": str(secrets.randbelow(2**32))}
    done = subprocess.run([sys.executable, "-c", JOB], env=os.environ | own, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def main() -> int:
    """Run, write, compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20)
    runs = parser.parse_args().runs
    found = Counter((answered(THREADS[i % len(THREADS)]), THREADS[i % len(THREADS)]) for i in range(runs))
    different = len({digest for digest, _ in found})
    rows = [(threads, digest, count) for (digest, threads), count in sorted(found.items(), key=lambda item: item[0][1])]
    text = [
        "# Determinism",
        "",
        f"`python -m benchmarks.stability.determinism --runs {runs}`: {runs} runs,"
        f" {different} answer{'s' * (different > 1)}.",
        "",
        *table(["threads", "digest", "runs"], rows),
    ]
    PAGE.write_text("\n".join(text), encoding="utf-8")
    print(*text, sep="\n")
    return int(different > 1)


if __name__ == "__main__":
    sys.exit(main())
