"""How quickly the page of a map is there and answers, in chromium without a graphics card.

    python -m benchmarks.cost.page_speed

Built-in shapes mapped to themselves. Wall seconds until both surfaces are drawn, the start of the browser's process
for the page among them, and what that process computed till then, which a busy machine changes less; milliseconds,
medians of 20, from the pointer to its partner, and for a turn of both surfaces to be drawn. Writes
results/page_speed.md, with the load of the machine.
"""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path

import numpy as np
from generated_shapes import subdivided
from pages import Visit, browser

import gmds
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import SurfacePoints

SIZES = {5_000: 0, 12_500: 1}  # vertices of a built-in shape: how often its faces are split into four
MEDIAN = """async (act) => {
    const times = [], scene = gmdsPage.scenes[0];
    const acts = {
        mark: (i) => gmdsPage.mark({side: 0, vertex: scene.vertexAt(150 + 8 * i, 200) + 1}),
        turn: (i) => scene.look(rotated(scene.camera, i + 1, 0)),
    };
    for (let i = 0; i < 20; i++) {
        const start = performance.now();
        await acts[act](i);
        if (act === 'turn') await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
        times.push(performance.now() - start);
    }
    return times.sort((a, b) => a - b)[10];
}"""


def measured(size: int, splits: int) -> list[object]:
    """The row of a size."""
    mesh = gmds.shapes.quadruped(n_vertices=size)
    for _ in range(splits):
        mesh = subdivided(mesh)
    points = SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices))
    answer = gmds.Correspondence.from_points(mesh, points, distortion=np.linspace(0, 1, mesh.n_vertices))
    with tempfile.TemporaryDirectory() as folder, browser() as running:
        path = Path(folder) / "page.html"
        started = time.perf_counter()
        answer.report(path)
        written, started = time.perf_counter() - started, time.perf_counter()
        visit = Visit(running, path)  # returns when the page says that it is ready
        ready = time.perf_counter() - started
        session = visit.context.new_cdp_session(visit.page)
        session.send("Performance.enable")
        told = {one["name"]: one["value"] for one in session.send("Performance.getMetrics")["metrics"]}
        mark, turn = (visit.page.evaluate(MEDIAN, act) for act in ("mark", "turn"))
        size_mb = path.stat().st_size / 1e6
    return [
        f"{mesh.n_vertices:,}",
        *(f"{value:.1f}" for value in (size_mb, written, ready)),
        f"{told['ProcessTime']:.2f}",
        f"{mark:.1f}",
        f"{turn:.1f}",
    ]


def main() -> None:
    """Measure, write."""
    rows = [measured(*item) for item in SIZES.items()]
    columns = [
        "vertices a side",
        "MB",
        "s to write",
        "s until drawn",
        "CPU s of the page until then",
        "ms to the partner",
        "ms a turn",
    ]
    load = f"Load of the machine meanwhile: {os.getloadavg()[0]:.0f}, on {os.cpu_count()} processors."
    text = ["# Speed of the page", "", "`python -m benchmarks.cost.page_speed`", "", load, "", *table(columns, rows)]
    (RESULTS / "page_speed.md").write_text("\n".join(text), encoding="utf-8")
    print(*text, sep="\n")


if __name__ == "__main__":
    main()
