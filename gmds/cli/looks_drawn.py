"""Pictures of what was carried; the target is seen from the same side as the source."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.output import tell_written

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from geodesics.arrays import Floats
    from gmds import Correspondence
    from gmds.appearance import Look
    from gmds.pictures.camera import Direction

GIVEN = ("target, as given", "source, carried")


def draw_looks(picture: Path | None, answer: Correspondence, up: Direction, given: Look, carried: Look) -> None:
    """The picture that was asked for of what is on the target and what was carried; `up` of the source."""
    if picture is None:
        return
    from gmds.pictures.values import write_coloured

    looks: list[Any] = []
    for look in (given, carried):
        if look.uv is not None and look.image is not None:
            looks.append((look.uv, look.image))
        elif look.colours is not None:
            looks.append(look.colours[:, :3] / 255)
        else:
            raise click.UsageError("there is nothing to draw: neither colours nor an image; give it with --texture")
    panels = list(zip(GIVEN, (answer.target, answer.source), looks, strict=True))
    tell_written(picture, write_coloured(picture, panels, views=_views(answer, up)))


def draw_values(
    picture: Path | None, answer: Correspondence, up: Direction, kind: str, tables: tuple[NDArray[Any], NDArray[Any]]
) -> None:
    """The picture that was asked for of values (n, columns) of the target and of those carried.

    Colours are shown as they are, all bones by a colour each, mixed as their weights are, of others the first column.
    """
    if picture is None:
        return
    from gmds.pictures.values import write_coloured, write_values

    views, meshes = _views(answer, up), (answer.target, answer.source)
    if kind in ("weights", "colours"):
        looks = [table[:, :3] / 255 if kind == "colours" else _mixed(table) for table in tables]
        told = write_coloured(picture, list(zip(GIVEN, meshes, looks, strict=True)), views=views)
    else:
        labels = kind == "labels"
        shown = _first(tables[0][:, 0], tables[1][:, 0], labels=labels)
        panels = list(zip(GIVEN, meshes, shown, strict=True))
        told = write_values(picture, panels, labels=labels, label="value", views=views)
    tell_written(picture, told)


def _views(answer: Correspondence, up: Direction) -> list[Floats]:
    """The cameras of target and source."""
    from gmds.pictures.camera import alignment, broadside

    view = broadside(answer.source, up)
    return [view @ alignment(answer), view]


def _mixed(weights: NDArray[Any]) -> Floats:
    """Colours (n, 3) of weights of bones (n, bones); grey where no bone has any."""
    import numpy as np

    from gmds.pictures.colours import MISSING, label_colours

    total = weights.sum(axis=1, keepdims=True)
    mixed = weights / np.where(total > 0, total, 1) @ label_colours(np.arange(weights.shape[1]))
    return np.where(total > 0, mixed, MISSING)


def _first(given: NDArray[Any], carried: NDArray[Any], *, labels: bool) -> tuple[NDArray[np.generic], ...]:
    """What the picture shows of both: numbers (the real part), or for every label its place among all labels."""
    import numpy as np

    if not labels:
        return given.real, carried.real
    place = np.unique(np.concatenate([given, carried]), return_inverse=True)[1].reshape(-1)
    return place[: len(given)], place[len(given) :]
