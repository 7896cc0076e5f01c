"""Why plain GMDS misses 2.5 on TOSCA: where samples end that start at their true places.

    GMDS_DATA=... python -m benchmarks.accuracy.plain_tosca

Reporting pairs and distances of plain.md; 300 farthest points of space are placed by `gmds.solve` (least squares, the
weights of `match`), from where they truly belong. By what they are off in the end, the least of the stress next to the
truth is off it: no start and no solver of this stress does better. Writes plain_tosca.csv to benchmarks/results/, of
which plain.md has means.
"""

from __future__ import annotations

import numpy as np

import geodesics
import gmds
from benchmarks.accuracy.asymmetric import of_unit_area
from benchmarks.accuracy.plain import CELLS, EVERY, distance, spread
from benchmarks.accuracy.plain_tosca_page import COLUMNS, NAME
from benchmarks.accuracy.runs import chosen_pairs
from benchmarks.places import RESULTS
from gmds.files.table import write_table
from gmds.matching.given_distances import relative_weights

SAMPLES = 300  # as many as `match` has
PAIRS = 4  # of plain.md


def main() -> None:
    """Measure, and write the rows."""
    rows = []
    for pair in spread(chosen_pairs("tosca_5k", "reporting", EVERY["tosca_5k"]))[:PAIRS]:
        source, target = of_unit_area(pair.source), of_unit_area(pair.target)
        vertices, truth, _ = pair.truth(source, target)
        among = geodesics.farthest_point_sampling(geodesics.GeodesicDistance(source), SAMPLES)
        known = among[np.isin(among, vertices)]
        true = truth[np.array([np.flatnonzero(vertices == one)[0] for one in known])]
        for cell in (one for one in CELLS if one.endswith("LeastSquares")):
            kind, *settings, _ = cell.split()
            ours, theirs = (distance(mesh, kind, *map(float, settings)) for mesh in (source, target))
            problem = gmds.Problem(ours, known, theirs, weights=relative_weights)
            start = geodesics.SurfacePoints(theirs.mesh, true.face, true.barycentric)
            found = gmds.solve(problem, start)
            roots = (float(np.sqrt(np.mean(one**2))) for one in (problem.at(start).residuals, found.residuals))
            rows.append((cell, pair.name, float(100 * gmds.geodesic_error(found.points, start).mean()), *roots))
            print(*rows[-1], flush=True)
        write_table(RESULTS / NAME, COLUMNS, rows, digits=4)


if __name__ == "__main__":
    main()
