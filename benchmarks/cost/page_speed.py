"""How quickly the page of a map is there and answers, in chromium without a graphics card.

    python -m benchmarks.cost.page_speed

Built-in shapes mapped to themselves. Medians of `OPENINGS`, the first of which starts the browser's processes: seconds
from the call for the page until the browser painted anything, as it says itself, and until pixels of both surfaces
could be read; and what the page's process computed till then, which a busy machine changes less. Milliseconds, medians
of 20, from the pointer to its partner, and for a turn of both surfaces to be drawn. Writes results/page_speed.md, with
the load of the machine.
"""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from generated_shapes import subdivided
from pages import Visit, browser

import gmds
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import SurfacePoints

OPENINGS = 5  # of each page
SIZES = {5_000: 0, 12_500: 1}  # vertices of a built-in shape: how often its faces are split into four
PIXELS = """() => gmdsPage.scenes.forEach(({painter: {gl}}) => {
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
})"""  # which waits for all that was asked for
FRAMES = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
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


def opened(running: Any, path: Path) -> tuple[Visit, list[float]]:
    """The page, and seconds: to first paint, to pixels of both surfaces, of the page's processor time."""
    started = time.perf_counter()
    visit = Visit(running, path)  # returns when the page says that it is ready
    visit.page.evaluate(PIXELS)
    drawn = time.perf_counter() - started
    session = visit.context.new_cdp_session(visit.page)
    session.send("Performance.enable")
    told = {one["name"]: one["value"] for one in session.send("Performance.getMetrics")["metrics"]}
    visit.page.evaluate(FRAMES)
    painted = visit.page.evaluate("performance.getEntriesByType('paint')[0].startTime") / 1000
    return visit, [painted, drawn, told["ProcessTime"]]


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
        written = time.perf_counter() - started
        times = []
        for _ in range(OPENINGS):
            visit, found = opened(running, path)
            times.append(found)
            mark, turn = (visit.page.evaluate(MEDIAN, act) for act in ("mark", "turn"))
            visit.context.close()
        size_mb = path.stat().st_size / 1e6
    painted, drawn, computed = np.median(times, axis=0)
    return [
        f"{mesh.n_vertices:,}",
        *(f"{value:.1f}" for value in (size_mb, written)),
        *(f"{value:.2f}" for value in (painted, drawn, computed)),
        *(f"{value:.1f}" for value in (mark, turn)),
    ]


def main() -> None:
    """Measure, write."""
    rows = [measured(*item) for item in SIZES.items()]
    columns = [
        "vertices a side",
        "MB",
        "s to write",
        "s to first paint",
        "s to both surfaces",
        "CPU s of the page",
        "ms to the partner",
        "ms a turn",
    ]
    load = f"Load of the machine meanwhile: {os.getloadavg()[0]:.0f}, on {os.cpu_count()} processors."
    text = ["# Speed of the page", "", "`python -m benchmarks.cost.page_speed`", "", load, "", *table(columns, rows)]
    (RESULTS / "page_speed.md").write_text("\n".join(text), encoding="utf-8")
    print(*text, sep="\n")


if __name__ == "__main__":
    main()
