"""Names that stand for objects; only the command line knows them."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from geodesics import Mesh

METRICS = ("embedded", "scale-invariant", "min-curvature", "equi-affine", "affine")
DISTANCES = ("biharmonic", "commute-time", "diffusion", "geodesic")
SMOOTHING = 4e-2  # of the curvature: alone, the metric wants large features (chosen on development_pairs.py)
LOSSES = ("least-squares", "huber", "power", "minimax")

metric_option = click.option("--metric", type=click.Choice(METRICS), help="Metric in which distances are measured.")
distance_option = click.option("--distance", type=click.Choice(DISTANCES), help="Distance that the map preserves.")
loss_option = click.option("--loss", type=click.Choice(LOSSES), help="How the misfit of distances is added up.")


def chosen_distance(metric: str | None, distance: str | None) -> Callable[[Mesh], Any] | None:
    """The function Mesh -> Distance that two names stand for; None, the default of match, when neither is given."""
    if metric is None and distance is None:
        return None
    import geodesics
    from gmds.candidates import TIME
    from gmds.surface import EIGENFUNCTIONS

    measure = getattr(geodesics, (metric or "scale-invariant").replace("-", "_"))
    if metric in (None, "scale-invariant"):
        measure = functools.partial(measure, smoothing=SMOOTHING)
    spectral: dict[str, Callable[[geodesics.Spectrum], Any]] = {
        "biharmonic": geodesics.BiharmonicDistance,
        "commute-time": geodesics.CommuteTimeDistance,
        "diffusion": lambda spectrum: geodesics.DiffusionDistance(spectrum, TIME),  # the time that match compares
    }

    def build(mesh: Mesh) -> Any:
        if distance == "geodesic":
            return geodesics.GeodesicDistance(measure(mesh))
        spectrum = geodesics.eigenpairs(measure(mesh), min(EIGENFUNCTIONS, mesh.n_vertices - 1))
        return spectral[distance or "diffusion"](spectrum)

    return build


def chosen_loss(name: str | None) -> Any:
    """The loss a name stands for; None, the default of match, when no name is given."""
    if name is None:
        return None
    import gmds

    losses = {"least-squares": gmds.LeastSquares, "huber": gmds.Huber, "power": gmds.Power, "minimax": gmds.Minimax}
    return losses[name]()
