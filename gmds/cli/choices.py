"""Names that stand for objects; only the command line knows them."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from geodesics.smoothing import WHOLE_MATCH

if TYPE_CHECKING:
    from geodesics import Mesh, Metric, Spectrum

METRICS = ("embedded", "scale-invariant", "min-curvature", "equi-affine", "affine")
DISTANCES = ("biharmonic", "commute-time", "diffusion", "geodesic")
LOSS_CLASSES = {  # in `gmds.mds.losses`, which is imported when one is chosen
    "least-squares": "LeastSquares",
    "huber": "Huber",
    "power": "Power",
    "minimax": "Minimax",
}
LOSSES = tuple(LOSS_CLASSES)
PARTS = ("auto", "neither", "source", "target", "both")  # as `match` has them: importing them costs a second

metric_option = click.option("--metric", type=click.Choice(METRICS), help="Metric in which distances are measured.")
distance_option = click.option("--distance", type=click.Choice(DISTANCES), help="Distance that the map preserves.")


def chosen_metric(name: str) -> Callable[[Mesh], Metric]:
    """The function Mesh -> Metric that a name stands for."""
    import geodesics

    measure: Callable[..., Metric] = getattr(geodesics, name.replace("-", "_"))
    return functools.partial(measure, smoothing=WHOLE_MATCH) if name == "scale-invariant" else measure


def chosen_spectrum(metric: str, mesh: Mesh) -> Spectrum:
    """As many eigenpairs of a mesh in the metric of that name as match uses, or as it has."""
    from geodesics import eigenpairs
    from gmds.surface.measured import EIGENFUNCTIONS

    return eigenpairs(chosen_metric(metric)(mesh), min(EIGENFUNCTIONS, mesh.n_vertices - 1))


@dataclass(frozen=True)
class ChosenDistance:
    """The function Mesh -> Distance that the names of a metric and of a distance stand for."""

    metric: str
    distance: str

    def __call__(self, mesh: Mesh) -> Any:
        import geodesics
        from gmds.matching.candidates import TIME

        if self.distance == "geodesic":
            return geodesics.GeodesicDistance(chosen_metric(self.metric)(mesh))
        spectral: dict[str, Callable[[geodesics.Spectrum], Any]] = {
            "biharmonic": geodesics.BiharmonicDistance,
            "commute-time": geodesics.CommuteTimeDistance,
            "diffusion": lambda spectrum: geodesics.DiffusionDistance(spectrum, TIME),  # the time that match compares
        }
        return spectral[self.distance](chosen_spectrum(self.metric, mesh))


def chosen_distance(metric: str | None, distance: str | None) -> ChosenDistance | None:
    """The distance that two names stand for; None, the default of match, when neither is given."""
    if metric is None and distance is None:
        return None
    return ChosenDistance(metric or "scale-invariant", distance or "diffusion")


def chosen_loss(name: str | None) -> Any:
    """The loss a name stands for; None, the default of match, when no name is given."""
    if name is None:
        return None
    from gmds.mds import losses

    return getattr(losses, LOSS_CLASSES[name])()
