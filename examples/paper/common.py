"""What the scripts of this folder share: options, the shapes they run on, grids of pictures, and files of figures."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import ArrayLike
from PIL import Image

from geodesics import Mesh, SurfacePoints, embedded, read_mesh, scale_invariant
from gmds.deformations import branch_log_scale, compose, local_scaling, remeshing
from gmds.pictures.camera import broadside
from gmds.pictures.colours import label_colours, value_colours
from gmds.pictures.software import render
from gmds.shapes import quadruped

Picture = np.ndarray
METRICS = {"regular": embedded, "invariant": scale_invariant}
Z_UP = (0, 0, 1)
LARGE = 290_000  # bytes


def options(about: str, *extra: tuple[str, Mapping[str, Any]]) -> argparse.Namespace:
    """--output (folder), --data (folder of published shapes, or None), --small (a setting for tests)."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("-o", "--output", type=Path, default=Path("paper"), help="folder for the picture and the JSON")
    data = os.environ.get("GMDS_DATA")
    parser.add_argument("--data", type=Path, default=Path(data) if data else None, help="published shapes, if any")
    parser.add_argument("--small", action="store_true", help="few vertices and built-in shapes only, for tests")
    for name, settings in extra:
        parser.add_argument(name, **settings)
    found = parser.parse_args()
    found.data = None if found.small else found.data
    return found


def shapes(settings: argparse.Namespace) -> Iterator[tuple[str, Mesh, tuple[int, int, int]]]:
    """(name, mesh, which way is up): the built-in animal, and the centaur and the horse of TOSCA where they are."""
    yield "animal", quadruped(n_vertices=1000 if settings.small else 4000), Z_UP
    for name in () if settings.data is None else ("centaur0", "horse0"):
        yield name, read_mesh(settings.data / "tosca_5k" / f"{name}.off"), Z_UP


def copies(mesh: Mesh) -> dict[str, tuple[Mesh, SurfacePoints]]:
    """The mesh with some limbs up to twice as large and others half as large, and where its vertices went.

    Once with the same triangles, and once with others.
    """
    grown = local_scaling(mesh, branch_log_scale(mesh, 2.0, count=4, rng=1))
    again = compose(lambda _: grown, lambda m: remeshing(m, adaptive=True))(mesh)
    return {"same triangles": grown, "remeshed": again}


def picture(
    mesh: Mesh,
    values: ArrayLike,
    up: tuple[int, int, int],
    limits: tuple[float, float] | None = None,
    *,
    like: Mesh | None = None,
    pixels: int = 300,
) -> Picture:
    """The mesh with values (n,) as colours between limits; with whole numbers and no limits, as labels.

    Values (n, 3) are colours as they stand. Seen as the mesh `like`, if given, would be seen.
    """
    if np.ndim(values) == 2:
        colours, sharp = np.asarray(values), False
    else:
        colours = label_colours(values) if limits is None else value_colours(values, *limits)
        sharp = limits is None
    return render(mesh, colours, rotation=broadside(like or mesh, up), pixels=pixels, sharp=sharp)


def grid(
    rows: Sequence[tuple[str, Sequence[Picture | None]]], columns: Sequence[str], title: str, *, size: float = 1.0
) -> Figure:
    """A figure of pictures in named rows and columns, `size` times as large as 2.6 by 2.2 inches each."""
    inches = 2.6 * size * len(columns) + 0.4, 2.2 * size * len(rows) + 0.6
    figure = Figure(figsize=inches, dpi=110, layout="constrained")
    axes = figure.subplots(len(rows), len(columns), squeeze=False)
    for number, ((name, pictures), line) in enumerate(zip(rows, axes, strict=True)):
        for image, axis in zip(pictures, line, strict=True):
            axis.set_xticks([])
            axis.set_yticks([])
            axis.spines[:].set_visible(False)
            axis.set_anchor("C" if number else "N")  # captions in a row
            if image is not None:
                axis.imshow(image)
        line[0].set_ylabel(name, fontsize=9)
    for caption, axis in zip(columns, axes[0], strict=True):
        axis.set_title(caption, fontsize=9)
    figure.suptitle(title, fontsize=11)
    return figure


def publish(output: Path, name: str, figure: Figure, numbers: Mapping[str, Any]) -> None:
    """Write <name>.png and <name>.json to a folder, and print the numbers."""
    output.mkdir(parents=True, exist_ok=True)
    save(output / f"{name}.png", figure)
    text = json.dumps(numbers, indent=2, default=lambda value: value.item())
    (output / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    print(text)


def save(path: Path, figure: Figure) -> None:
    """Write a figure as a PNG; of 200 colours when it would be large."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    image = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    image.save(path, optimize=True)
    if path.stat().st_size > LARGE:
        image.quantize(200).save(path, optimize=True)
