"""Heat kernel signatures of shapes and of their locally scaled copies, in two metrics (Fig. 4, Fig. 5).

The number is the mean relative difference |b - a| / a between the signature a of the shape and b of its copy, over the
area of the shape and 20 times: `scaled` of the scaled signature of Fig. 5, `plain` of HKS (5.1) times the area, which
makes it free of the unit. Times are in units of the area of each surface in the metric. The curves are those of three
tips of limbs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import METRICS, copies, grid, options, picture, publish, save, shapes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geodesics import eigenpairs, embedded, heat_kernel_signature, scaled_heat_kernel_signature
from gmds.deformations.limbs import extremities

Array = NDArray[np.float64]
TIMES, SHOWN = np.geomspace(3e-3, 0.3, 20), np.array([3e-3, 1e-2, 3e-2, 1e-1])
COLOURS = "#0072B2", "#D55E00", "#009E73"  # Okabe and Ito


def curves(drawn: dict[tuple[str, str], tuple[Array, Array]]) -> Figure:
    """Scaled signatures at three points: circles on the shape, plus signs on its copy."""
    names = list(dict.fromkeys(name for name, _ in drawn))
    figure = Figure(figsize=(8, 2.6 * len(names) + 0.4), dpi=110, layout="constrained")
    axes = figure.subplots(len(names), 2, squeeze=False, sharex=True, sharey="row")
    for (name, metric), (old, new) in drawn.items():
        axis = axes[names.index(name), list(METRICS).index(metric)]
        for a, b, colour in zip(old, new, COLOURS, strict=True):
            axis.loglog(TIMES, a, "o", color=colour, mfc="none", ms=6)
            axis.loglog(TIMES, b, "+", color=colour, ms=7)
        axis.set_title(f"{name}, {metric} metric", fontsize=9)
        axis.tick_params(labelsize=7, which="both")
    for axis in axes[-1]:
        axis.set_xlabel("time / area", fontsize=9)
    figure.suptitle("Scaled HKS at three tips: o shape, + locally scaled, remeshed copy", fontsize=10)
    return figure


def main() -> None:
    settings = options("Figs. 4 and 5")
    numbers: dict[str, Any] = {}
    rows: list[tuple[str, list[np.ndarray]]] = []
    drawn = {}
    for name, mesh, up in shapes(settings):
        weight, tips = embedded(mesh).mass / mesh.area, extremities(mesh)[0][:3]
        images: dict[str, list[np.ndarray]] = {"": [], "copy": []}
        numbers[name] = {}
        made = copies(mesh)
        for metric, measure in METRICS.items():
            old = eigenpairs(measure(mesh), 100)
            for copy, (other, truth) in made.items():
                new = eigenpairs(measure(other), 100)
                found = {}
                for kind, signature in (("plain", heat_kernel_signature), ("scaled", scaled_heat_kernel_signature)):
                    a = signature(old, TIMES) * old.mass.sum()
                    b = truth.interpolate(signature(new, TIMES)) * new.mass.sum()
                    found[kind] = (weight @ np.abs(b / a - 1)).mean().round(4)
                numbers[name].setdefault(copy, {})[metric] = found
            drawn[name, metric] = a[tips], b[tips]
            for time in SHOWN:
                a, b = (scaled_heat_kernel_signature(s, time)[:, 0] * s.mass.sum() for s in (old, new))
                limits = 0.0, float(np.quantile(a, 0.98))
                images[""].append(picture(mesh, a, up, limits, like=mesh))
                images["copy"].append(picture(other, b, up, limits, like=mesh))
        for found in numbers[name].values():
            found["ratio"] = {
                kind: (found["invariant"][kind] / found["regular"][kind]).round(3) for kind in found["regular"]
            }
        rows += [(f"{name} {panel}".strip(), line) for panel, line in images.items()]
    columns = [f"{metric}, t = {time:g}" for metric in METRICS for time in SHOWN]
    title = (
        "Scaled HKS of shapes and of their locally scaled, remeshed copies (colours of a pair from 0 to the same value)"
    )
    publish(settings.output, "fig4_signatures", grid(rows, columns, title, size=0.62), numbers)
    save(settings.output / "fig5_signatures.png", curves(drawn))


if __name__ == "__main__":
    main()
