"""A surface embedded into its locally scaled, remeshed copy: regular metric, invariant metric, and `match` (Fig. 7).

The first two are plain GMDS: starts, samples and embedding know only diffusion distances in that metric. The number is
the mean geodesic error on the copy over the square root of its area, times 100, by the protocol of `gmds benchmark`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from common import Z_UP, copies, grid, options, picture, publish, shapes

import gmds
from geodesics import Mesh
from gmds.cli.choices import chosen_distance
from gmds.evaluation import protocol_subset
from gmds.pictures.matching_colours import matching_colours

WAYS: dict[str, Callable[[Mesh], Any] | None] = {
    "regular": chosen_distance("embedded", "diffusion"),
    "invariant": chosen_distance("scale-invariant", "diffusion"),
    "match": None,
}


def main() -> None:
    settings = options("Fig. 7")
    numbers: dict[str, Any] = {}
    rows: list[tuple[str, list[np.ndarray]]] = []
    ways = list(WAYS)[settings.small :]
    for name, mesh, _ in shapes(settings):
        target, truth = copies(mesh)["remeshed"]
        colours = matching_colours(target)
        some = protocol_subset(len(truth))
        images = [picture(target, colours, Z_UP, like=mesh)]
        numbers[name] = {}
        for way in ways:
            answer = gmds.match(mesh, target, distance=WAYS[way])
            found = gmds.summary(gmds.geodesic_error(answer, truth[some], some))
            numbers[name][way] = {"error_x100": round(found.mean, 3), "within_0.10": round(found.within_010, 1)}
            images.append(picture(mesh, answer.points.interpolate(colours), Z_UP))
        rows.append((name, images))
    title = "Colours of a locally scaled copy, carried to the shape"
    columns = ["copy", *(way if way == "match" else f"{way} metric" for way in ways)]
    publish(settings.output, "fig7_gmds", grid(rows, columns, title), numbers)


if __name__ == "__main__":
    main()
