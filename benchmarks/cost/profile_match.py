"""Where the time of a match goes: CPU seconds by function, own and with what it calls.

    GMDS_DATA=... python -m benchmarks.cost.profile_match

One TOSCA pair of 5,000 vertices a side on one thread, warm, by cProfile, which adds a tenth. Writes results/profile.md.
"""

from __future__ import annotations

import cProfile
import os
import pstats
import time
from pathlib import Path

from benchmarks.places import RESULTS

PAGE = RESULTS / "profile.md"
PACKAGES = ("gmds", "geodesics")
MOST, LEAST = 40, 0.1  # rows of a table, and seconds that a row must have


def main() -> None:
    """Profile and write the page."""
    os.environ["GMDS_THREADS"] = "1"
    import gmds
    from geodesics import read_mesh

    folder = Path(os.environ["GMDS_DATA"]) / "tosca_5k"
    source, target = (read_mesh(folder / f"{name}.off") for name in ("cat0", "cat2"))
    gmds.match(source, target)
    profile = cProfile.Profile(time.process_time)
    profile.runcall(gmds.match, source, target)
    stats = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    total = max(row[3] for row in stats.values())
    rows = []
    for (file, _, name), (_, calls, own, cumulative, _) in stats.items():
        path = Path(file)
        package = next((part for part in PACKAGES if part in path.parts), None)
        where = "/".join(path.parts[path.parts.index(package) :]) if package else path.name
        if max(own, cumulative if package else own) >= LEAST and "<" not in name.replace("<built-in", ""):
            rows.append((cumulative, own, calls, f"{where} {name}" if where != "~" else name))
    lines = ["# Where the time of a match goes", ""]
    lines += [f"`GMDS_DATA=... python -m benchmarks.cost.profile_match`: {total:.1f} CPU seconds.", ""]
    for title, place in (("With what it calls", 0), ("Own time, the compiled code that it calls included", 1)):
        lines += [f"## {title}", "", "| CPU s | share | calls | function |", "|---|---|---|---|"]
        for row in sorted(rows, key=lambda row: -row[place])[:MOST]:
            if row[place] >= LEAST:
                lines.append(f"| {row[place]:.2f} | {row[place] / total:.0%} | {row[2]} | `{row[3]}` |")
        lines.append("")
    PAGE.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
