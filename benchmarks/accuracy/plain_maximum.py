"""What plain.md says of Minimax since it takes the map with least squares among those with the same maximum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.accuracy.runs import Rows, read_rows
from benchmarks.markdown import table

LATER = "c3e34bd"  # the version that changed Minimax
OF_LATER = f"""### The maximum, since {LATER}

Of maps with the same maximum `solve_by_ladder` takes about the one with least squares since then. Rows of Minimax
above are of before; measured again so far, error x100 before and since:"""


def of_later(output: Path, found: Mapping[str, Rows], cells: Sequence[str]) -> list[str]:
    """What Minimax makes of the pairs that were measured after it changed, if there are any: before, and after."""
    cells = [one for one in cells if one.endswith("Minimax")]
    lines, gaps = [], []
    for name, before in found.items():
        after = read_rows(output / f"plain_minimax_{name}.csv", LATER)
        for pair in dict.fromkeys(pair for _, pair in after):
            line = [pair]
            for one in cells:
                both = before[one, pair].direct, after[one, pair].direct if (one, pair) in after else None
                line.append("-" if None in both else " -> ".join(f"{error:.1f}" for error in both))
                least = before[one.replace("Minimax", "LeastSquares"), pair].direct
                gaps += [] if None in both else [(*both, least)]
            lines.append(line)
    if not lines:
        return []
    was, now, least = np.array(gaps).T
    told = f"In the mean of these {len(now)} maps {was.mean():.2f} before, {now.mean():.2f} since; least squares"
    far = f"{least.mean():.2f}. Within 1.0 of least squares: {(was - least <= 1).sum()} and {(now - least <= 1).sum()}."
    head = ["pair", *(" ".join(one.split()[:2]) for one in cells)]
    return [OF_LATER, "", *table(head, lines), f"{told} {far}", ""]
